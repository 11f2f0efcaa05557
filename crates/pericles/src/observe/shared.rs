//! Observers that a program keeps a hand on.

use std::sync::{Arc, Mutex, PoisonError};

use super::{ObserveError, Observer, Snapshot};
use crate::archive::{Archive, Saved};
use crate::error::Result;

/// The run has one clone, the program another, with which it reads what was observed.
impl<O: Observer> Observer for Arc<Mutex<O>> {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        // What another thread left behind when it panicked is still what was observed.
        let mut observer = self.lock().unwrap_or_else(PoisonError::into_inner);
        observer.observe(snapshot)
    }

    fn settle(&self) -> std::result::Result<(), ObserveError> {
        self.lock().unwrap_or_else(PoisonError::into_inner).settle()
    }

    fn finish(&mut self) -> std::result::Result<(), ObserveError> {
        self.lock().unwrap_or_else(PoisonError::into_inner).finish()
    }
}

impl<O: Observer> Saved for Arc<Mutex<O>> {
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
