//! Whether a checkpoint holds all that a run needs: for tests of integrators, forces, boundaries and observers.

use crate::archive::{Archive, Saved};
use crate::error::PericlesError;
use crate::simulation::{Control, Outcome, Simulation, SimulationError};

/// What is wrong with a checkpoint.
#[derive(Debug, thiserror::Error)]
pub enum Incomplete {
    /// A run that was restored stores something else than it was restored from.
    #[error("a run restored from a checkpoint stores other values in {}", .arrays.join(", "))]
    Restored {
        /// The arrays that differ.
        arrays: Vec<String>,
    },
    /// A new run that was restored ends differently from the run that went on.
    #[error("a run resumed from a checkpoint ends with other values in {}", .arrays.join(", "))]
    Resumed {
        /// The arrays that differ.
        arrays: Vec<String>,
    },
    /// A run that was taken back to a checkpoint ends differently from the first time.
    #[error("a run taken back to a checkpoint ends with other values in {}", .arrays.join(", "))]
    TakenBack {
        /// The arrays that differ.
        arrays: Vec<String>,
    },
    /// The run ended before the checkpoint.
    #[error("the run ends at step {step}, before the checkpoint")]
    Ended {
        /// Its last step.
        step: u64,
    },
    /// The run fails.
    #[error(transparent)]
    Run(#[from] SimulationError),
    /// The checkpoint is refused.
    #[error(transparent)]
    Archive(#[from] PericlesError),
}

/// Checks that a run resumed from a checkpoint after one of the steps `pauses`, in ascending order, goes on as if it had never stopped, bit for bit in everything that runs save. Returns what
/// is stored at its end.
///
/// `make` makes the run, each time the same one. It is run to its end with the checkpoints on the way. Each of them is restored into a new run, which must store the same again, and must end
/// with the same; and into the run that has ended, which must end with the same once more: what a new run happens to have right is then wrong.
///
/// # Errors
/// [`Incomplete`] with the arrays that differ; errors of the run itself.
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
