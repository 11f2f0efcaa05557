//! Observers: read-only output of a run.
//!
//! The time loop passes a [`Snapshot`] to every [`Observer`] whose [`Schedule`] contains the step. Fields that need
//! an evaluation are computed on first use, once per snapshot.
//!
//! All processes evaluate observers, because values of the whole body need communication; tables and files are
//! written by the first process, where [`Snapshot::is_written`] is true. It has one field of the whole body at a
//! time, and its files equal the files of a run on a single process, byte for byte. It collects points and sets of the
//! whole body only for output that needs them: fields, pictures, profiles, crack tips, impactors.

mod crack;
mod energies;
mod field;
mod fragments;
mod probe;
mod schedule;
mod shared;
mod snapshot;
mod tensors;

pub use crack::{CrackTip, CrackTracker, TrackedCrack};
pub use energies::{Energies, StartEnergy};
pub use field::{Field, FieldKind, FieldNeed};
pub use fragments::{FragmentCount, Fragments};
pub use probe::{Probe, ProbeReading};
pub use schedule::Schedule;
pub use snapshot::Snapshot;

use crate::archive::Checkpointed;

/// Error of an observer; boxed, because the engine has no file access.
pub type ObserveError = Box<dyn std::error::Error + Send + Sync>;

/// Reads the states of a run. Its saved state lets it continue after a resume without gap or repetition.
pub trait Observer: Checkpointed + Send {
    /// Receives a state.
    ///
    /// # Errors
    /// Any failure of the observer; the run then stops.
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ObserveError>;

    /// Receives the unbalanced state of a load step without a static state, after which the run stops. Observers of fields
    /// show it; the numbers of tables would not belong to a static state.
    ///
    /// # Errors
    /// Any failure of the observer; it is not reported, because the failed load step is.
    fn observe_failed(&mut self, _snapshot: &Snapshot<'_>) -> Result<(), ObserveError> {
        Ok(())
    }

    /// Waits until all output so far is written; called before a checkpoint, for observers that write in a separate
    /// thread.
    ///
    /// # Errors
    /// Any failure of the observer.
    fn settle(&self) -> Result<(), ObserveError> {
        Ok(())
    }

    /// Called at the end of the run; not when the run is stopped, because it may be resumed.
    ///
    /// # Errors
    /// Any failure of the observer.
    fn finish(&mut self) -> Result<(), ObserveError> {
        Ok(())
    }
}
