//! Asking a run to stop from outside.

use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Whether a run has been asked to stop, and for what reason. Copies share the answer, so that one can be kept by another thread or a signal handler.
///
/// A run asks after every step, and between the iterations of steps that iterate; it then stops with a checkpoint.
#[derive(Debug, Clone, Default)]
pub struct Cancel {
    /// Zero as long as nobody has asked.
    reason: Arc<AtomicUsize>,
}

impl Cancel {
    /// A token that nobody has used yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks to stop.
    pub fn cancel(&self) {
        self.cancel_for(NonZeroUsize::MIN);
    }

    /// Asks to stop for a reason that the caller numbers, such as a signal. The last reason counts.
    pub fn cancel_for(&self, reason: NonZeroUsize) {
        self.reason.store(reason.get(), Ordering::Relaxed);
    }

    /// The reason to stop; none as long as nobody has asked.
    pub fn reason(&self) -> Option<NonZeroUsize> {
        NonZeroUsize::new(self.reason.load(Ordering::Relaxed))
    }

    /// Whether somebody has asked.
    pub fn is_cancelled(&self) -> bool {
        self.reason().is_some()
    }

    /// The number behind the token, for signal handlers, which may do nothing but store one: zero goes on, any other number stops the run.
    pub fn flag(&self) -> Arc<AtomicUsize> {
        Arc::clone(&self.reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_share_the_reason() {
        let cancel = Cancel::new();
        let copy = cancel.clone();
        assert_eq!(copy.reason(), None);
        cancel.flag().store(15, Ordering::Relaxed);
        assert_eq!(copy.reason().map(NonZeroUsize::get), Some(15));
        copy.cancel();
        assert!(cancel.is_cancelled());
    }
}
