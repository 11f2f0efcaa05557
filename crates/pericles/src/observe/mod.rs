//! Observers: what looks at a run without touching it.
//!
//! The loop hands a [`Snapshot`] to every [`Observer`] whose [`Schedule`] names the step. Fields that cost an evaluation are computed when first
//! asked for, once per snapshot.

mod crack;
mod fragments;
mod probe;
mod schedule;
mod shared;
mod snapshot;
mod tensors;

pub use crack::{CrackTip, CrackTracker, TrackedCrack};
pub use fragments::{FragmentCount, Fragments};
pub use probe::{Probe, ProbeReading};
pub use schedule::Schedule;
pub use snapshot::{Energies, Field, Snapshot, StartEnergy};

use crate::archive::Saved;

/// What an observer failed of; the library does not know files.
pub type ObserveError = Box<dyn std::error::Error + Send + Sync>;

/// Someone who looks at a run. What is saved lets an observer continue where it was, without gap or repetition.
pub trait Observer: Saved + Send {
    /// Sees a state.
    ///
    /// # Errors
    /// Whatever keeps the observer from doing its work; the run then stops.
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ObserveError>;

    /// Waits until everything seen so far is kept: asked before the run's state is saved. For observers that work beside the run.
    ///
    /// # Errors
    /// Whatever kept the observer from doing its work.
    fn settle(&self) -> Result<(), ObserveError> {
        Ok(())
    }

    /// Hears that the run has come to its end; not of a run that is stopped, which may go on.
    ///
    /// # Errors
    /// Whatever keeps the observer from doing its work.
    fn finish(&mut self) -> Result<(), ObserveError> {
        Ok(())
    }
}
