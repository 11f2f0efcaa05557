//! Writing beside the run.

use std::sync::{Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use crate::error::IoError;

/// A thread that writes an output while the run goes on; a second output waits for the first, so that no more than one is held in memory.
///
/// What goes wrong is told by the next [`start`](Self::start) or [`settle`](Self::settle).
#[derive(Default)]
pub(super) struct Background(Mutex<Option<JoinHandle<Result<(), IoError>>>>);

impl Background {
    /// Lets a thread do some work, once the work before is done.
    pub(super) fn start(
        &mut self,
        work: impl FnOnce() -> Result<(), IoError> + Send + 'static,
    ) -> Result<(), IoError> {
        self.settle()?;
        let thread = thread::spawn(work);
        *self.0.get_mut().unwrap_or_else(PoisonError::into_inner) = Some(thread);
        Ok(())
    }

    /// Waits until the work is done.
    pub(super) fn settle(&self) -> Result<(), IoError> {
        let thread = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        match thread.map(JoinHandle::join) {
            None => Ok(()),
            Some(Ok(done)) => done,
            Some(Err(panic)) => std::panic::resume_unwind(panic),
        }
    }
}

impl Drop for Background {
    /// A run that ends with an error leaves no thread behind that still writes.
    fn drop(&mut self) {
        if let Some(thread) = self.0.get_mut().ok().and_then(Option::take) {
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    #[test]
    fn one_output_is_under_way_and_its_error_is_told_later() {
        let mut background = Background::default();
        let (go, wait) = channel::<()>();
        background
            .start(move || {
                // Still under way while the run goes on.
                wait.recv().expect("told to go on");
                Err(IoError::damaged("file".as_ref(), "a reason"))
            })
            .expect("nothing was under way");
        go.send(()).expect("the thread waits");
        let error = background.start(|| Ok(())).expect_err("of the one before");
        assert!(matches!(error, IoError::Damaged { .. }), "{error}");
        assert!(background.settle().is_ok(), "an error is told once");
    }
}
