//! Tests that a checkpoint contains everything a run needs, for integrators, forces, boundaries and observers.

use crate::archive::{Archive, Checkpointed};
use crate::error::PericlesError;
use crate::simulation::{Control, Outcome, Simulation, SimulationError};

/// A defect of a checkpoint.
#[derive(Debug, thiserror::Error)]
pub enum Incomplete {
    /// A run restored from a checkpoint stores different values.
    #[error("a run restored from a checkpoint stores other values in {}", .arrays.join(", "))]
    Restored {
        /// The arrays that differ.
        arrays: Vec<String>,
    },
    /// A run resumed from a checkpoint ends differently from the uninterrupted run.
    #[error("a run resumed from a checkpoint ends with other values in {}", .arrays.join(", "))]
    Resumed {
        /// The arrays that differ.
        arrays: Vec<String>,
    },
    /// A finished run that is reset to a checkpoint ends differently the second time.
    #[error("a run reset to a checkpoint ends with other values in {}", .arrays.join(", "))]
    TakenBack {
        /// The arrays that differ.
        arrays: Vec<String>,
    },
    /// The run ended before the checkpoint.
    #[error("the run ends at step {step}, before the checkpoint")]
    Ended {
        /// Last step of the run.
        step: u64,
    },
    /// The run failed.
    #[error(transparent)]
    Run(#[from] SimulationError),
    /// The checkpoint does not match the run.
    #[error(transparent)]
    Archive(#[from] PericlesError),
}

/// Checks that a run resumed from checkpoints after the steps `pauses` (in ascending order) equals the
/// uninterrupted run bit for bit in everything that runs save. Returns the final checkpoint.
///
/// `make` constructs the run and must construct the same one each time. The run is executed to its end, with
/// checkpoints on the way. Each checkpoint is restored into a new run, which must save the same arrays again and
/// reach the same end. It is also restored into the finished run, which must reach the same end again; this detects
/// state that a new run has right by chance.
///
/// # Errors
/// [`Incomplete`] with the differing arrays; errors of the run.
pub fn check_resume(
    make: impl Fn() -> Simulation,
    pauses: impl IntoIterator<Item = u64>,
) -> Result<Archive, Incomplete> {
    let mut whole = make();
    let mut checkpoints = Vec::new();
    for pause in pauses {
        let paused = whole.run(|run| match run.state().step {
            step if step == pause => Control::Stop,
            _ => Control::Continue,
        })?;
        if paused == Outcome::Finished {
            let step = whole.state().step;
            return Err(Incomplete::Ended { step });
        }
        checkpoints.push(stored(&whole)?);
    }
    whole.run(|_| Control::Continue)?;
    let end = stored(&whole)?;
    for checkpoint in &checkpoints {
        let mut resumed = make();
        resumed.restore(checkpoint)?;
        equal(checkpoint, &stored(&resumed)?, |arrays| {
            Incomplete::Restored { arrays }
        })?;
        resumed.run(|_| Control::Continue)?;
        equal(&end, &stored(&resumed)?, |arrays| Incomplete::Resumed {
            arrays,
        })?;
        whole.restore(checkpoint)?;
        whole.run(|_| Control::Continue)?;
        equal(&end, &stored(&whole)?, |arrays| Incomplete::TakenBack {
            arrays,
        })?;
    }
    Ok(end)
}

fn stored(run: &Simulation) -> Result<Archive, Incomplete> {
    run.settle()?;
    let mut archive = Archive::default();
    run.save(&mut archive);
    Ok(archive)
}

fn equal(
    expected: &Archive,
    found: &Archive,
    wrong: impl FnOnce(Vec<String>) -> Incomplete,
) -> Result<(), Incomplete> {
    let arrays = expected.differences(found);
    match arrays.is_empty() {
        true => Ok(()),
        false => Err(wrong(arrays)),
    }
}
