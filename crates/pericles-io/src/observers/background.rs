//! Writing of output in a background thread.
//!
//! Observers settle before a checkpoint, so that a checkpoint never refers to missing files.

use std::sync::{Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use crate::error::IoError;

/// Writes output in a background thread while the run continues; the next output waits for the previous one,
/// so that at most one is held in memory.
///
/// Errors are returned by the next call of [`start`](Self::start) or [`settle`](Self::settle).
#[derive(Default)]
pub(super) struct Background(Mutex<Option<JoinHandle<Result<(), IoError>>>>);

impl Background {
    /// Starts a task in the thread after the previous one has finished.
    pub(super) fn start(
        &mut self,
        work: impl FnOnce() -> Result<(), IoError> + Send + 'static,
    ) -> Result<(), IoError> {
        self.settle()?;
        let thread = thread::spawn(work);
        *self.0.get_mut().unwrap_or_else(PoisonError::into_inner) = Some(thread);
        Ok(())
    }

    /// Waits until the task has finished.
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
    /// Waits for the thread, so that a run that ends with an error leaves no writer behind.
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
    fn one_output_is_in_progress_and_its_error_is_reported_later() {
        let mut background = Background::default();
        let (go, wait) = channel::<()>();
        background
            .start(move || {
                // Still in progress while the run continues.
                wait.recv().expect("the sender is alive");
                Err(IoError::damaged("file".as_ref(), "a reason"))
            })
            .expect("no output was in progress");
        go.send(()).expect("the thread waits");
        let error = background
            .start(|| Ok(()))
            .expect_err("the error of the previous output");
        assert!(matches!(error, IoError::Damaged { .. }), "{error}");
        assert!(background.settle().is_ok(), "an error is reported once");
    }
}
