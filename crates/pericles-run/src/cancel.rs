//! Cancellation of runs.

use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A token that stops a run, with a reason. Copies share their state, so that another thread or a signal handler can
/// keep one.
///
/// A run checks the token after every step and between iterations within a step; it then stops with a checkpoint.
#[derive(Debug, Clone, Default)]
pub struct Cancel {
    /// Zero if not cancelled.
    reason: Arc<AtomicUsize>,
}

impl Cancel {
    /// Creates a token.
    pub fn new() -> Self {
        Self::default()
    }

    /// Requests the run to stop.
    pub fn cancel(&self) {
        self.cancel_for(NonZeroUsize::MIN);
    }

    /// Requests the run to stop for a reason numbered by the caller, such as a signal. The last reason counts.
    pub fn cancel_for(&self, reason: NonZeroUsize) {
        self.reason.store(reason.get(), Ordering::Relaxed);
    }

    /// Returns the reason, or `None` if not cancelled.
    pub fn reason(&self) -> Option<NonZeroUsize> {
        NonZeroUsize::new(self.reason.load(Ordering::Relaxed))
    }

    /// Returns whether a stop was requested.
    pub fn is_cancelled(&self) -> bool {
        self.reason().is_some()
    }

    /// Returns the number behind the token for signal handlers, which may only store one: zero continues, any other
    /// number stops the run.
    pub fn flag(&self) -> Arc<AtomicUsize> {
        Arc::clone(&self.reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_of_a_token_share_the_reason() {
        let cancel = Cancel::new();
        let copy = cancel.clone();
        assert_eq!(copy.reason(), None);
        cancel.flag().store(15, Ordering::Relaxed);
        assert_eq!(copy.reason().map(NonZeroUsize::get), Some(15));
        copy.cancel();
        assert!(cancel.is_cancelled());
    }
}
