//! Observers shared between a run and the program.

use std::sync::{Arc, Mutex, PoisonError};

use super::{ObserveError, Observer, Snapshot};
use crate::archive::{Archive, Checkpointed};
use crate::error::Result;

/// The run owns one clone; the program reads the results through another.
impl<O: Observer> Observer for Arc<Mutex<O>> {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        // A panic in another thread does not invalidate what was observed.
        let mut observer = self.lock().unwrap_or_else(PoisonError::into_inner);
        observer.observe(snapshot)
    }

    fn observe_failed(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        let mut observer = self.lock().unwrap_or_else(PoisonError::into_inner);
        observer.observe_failed(snapshot)
    }

    fn settle(&self) -> std::result::Result<(), ObserveError> {
        self.lock().unwrap_or_else(PoisonError::into_inner).settle()
    }

    fn finish(&mut self) -> std::result::Result<(), ObserveError> {
        self.lock().unwrap_or_else(PoisonError::into_inner).finish()
    }
}

impl<O: Observer> Checkpointed for Arc<Mutex<O>> {
    fn save(&self, archive: &mut Archive) {
        self.lock()
            .unwrap_or_else(PoisonError::into_inner)
            .save(archive);
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        self.lock()
            .unwrap_or_else(PoisonError::into_inner)
            .restore(archive)
    }
}
