//! Checkpoints of a run: when they are due, and what they hold besides the state.
//!
//! One is written before the first step, so that a run that dies at any time can be resumed, then at the deck's schedule (by default every ten minutes
//! of wall time; static runs also between load steps, as far as that takes no more than a twentieth of the time), and when a signal stops the run. A run that becomes unstable leaves its failing state as `failed.chk`, which is for looking
//! at only: `resume` goes on from the last regular one.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use pericles::observe::Schedule;
use pericles::{Archive, Saved, Simulation};
use pericles_deck::Checkpoint;
use pericles_io::{CheckpointFolder, Container, IoError, OutputFolder};
use serde::{Deserialize, Serialize};

use crate::error::RunError;
use crate::source::SourceRecord;

/// The state of a run that became unstable.
pub const FAILED: &str = "failed.chk";
/// Between load steps checkpoints are as many times rarer than they take to write.
const SHARE: u32 = 20;

/// What a checkpoint says besides the state: enough to build the same run again.
#[derive(Debug, Clone, Serialize, Deserialize, PartialEq)]
pub struct Metadata {
    /// The version that wrote it.
    pub version: String,
    /// The instruction set it ran with.
    pub instruction_set: String,
    /// Steps taken.
    pub step: u64,
    /// The deck or the model.
    #[serde(flatten)]
    pub source: SourceRecord,
}

/// The checkpoints of one run.
pub struct Checkpoints {
    folder: CheckpointFolder,
    schedule: Checkpoint,
    source: SourceRecord,
    last: Instant,
    /// How long the last one took to write.
    cost: Duration,
}

impl Checkpoints {
    /// The checkpoints of a run in its output folder.
    pub fn new(folder: &OutputFolder, schedule: Checkpoint, source: SourceRecord) -> Self {
        Self {
            folder: CheckpointFolder::new(folder.file("checkpoints")),
            schedule,
            source,
            last: Instant::now(),
            cost: Duration::ZERO,
        }
    }

    /// How long the last one took to write; zero before the first.
    pub fn cost(&self) -> Duration {
        self.cost
    }

    /// Whether one is due after the present step.
    pub fn is_due(&self, simulation: &Simulation) -> bool {
        let step = simulation.state().step;
        let due = |schedule: Schedule| schedule.is_due(step, simulation.dt(), simulation.steps());
        match self.schedule {
            Checkpoint::Wall(seconds) => {
                // A deck may ask for more seconds than a clock can count.
                let wait = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
                // A load step may take as long as a whole dynamic run, and the next one may have no static state.
                let affordable = SHARE * self.cost;
                let is_static = simulation.integrator().is_static();
                let elapsed = self.last.elapsed();
                elapsed >= wait || is_static && elapsed >= affordable
            }
            Checkpoint::Every(steps) => due(Schedule::Every(steps)),
            Checkpoint::Interval(time) => due(Schedule::Interval(time)),
        }
    }

    /// Writes the present state.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&mut self, simulation: &Simulation) -> Result<PathBuf, RunError> {
        let began = Instant::now();
        let container = self.container(simulation)?;
        let path = self.folder.write(simulation.state().step, &container)?;
        self.last = Instant::now();
        self.cost = self.last - began;
        Ok(path)
    }

    /// Writes a state that cannot be gone on from.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write_failed(&self, simulation: &Simulation) -> Result<PathBuf, RunError> {
        let path = self.folder.path().join(FAILED);
        self.container(simulation)?.write(&path)?;
        Ok(path)
    }

    /// Removes what an earlier failure left.
    pub fn forget_failed(&self) {
        // It is overwritten by the next failure, and of no use to a success.
        let _ = std::fs::remove_file(self.folder.path().join(FAILED));
    }

    /// The step from which `resume` would go on.
    pub fn last_step(&self) -> Option<u64> {
        self.folder.steps().ok()?.last().copied()
    }

    fn container(&self, simulation: &Simulation) -> Result<Container, RunError> {
        simulation
            .settle()
            .map_err(|error| RunError::of_run(error, String::new))?;
        let operator = simulation.system().operator();
        let metadata = Metadata {
            version: env!("CARGO_PKG_VERSION").into(),
            instruction_set: operator.instruction_set().name().into(),
            step: simulation.state().step,
            source: self.source.clone(),
        };
        let mut archive = Archive::default();
        simulation.save(&mut archive);
        Ok(Container::from_archive(
            serde_json::to_value(metadata)?,
            archive,
        ))
    }
}

/// A checkpoint read back.
pub struct Stored {
    /// The file.
    pub path: PathBuf,
    /// What it says.
    pub metadata: Metadata,
    /// The state.
    pub archive: Archive,
    /// Why newer ones were refused.
    pub refused: Vec<IoError>,
}

impl Stored {
    /// The newest usable checkpoint of a run; its content may take so many bytes of memory.
    ///
    /// # Errors
    /// No checkpoint that is whole, one of another program, one that needs more memory.
    pub fn latest(folder: &OutputFolder, memory: u64) -> Result<Self, RunError> {
        let latest = CheckpointFolder::new(folder.file("checkpoints")).latest_valid(memory)?;
        let unusable = |reason: String| RunError::Checkpoint {
            path: latest.path.clone(),
            reason,
        };
        let (metadata, archive) = latest.container.into_archive().map_err(unusable)?;
        let metadata =
            serde_json::from_value(metadata).map_err(|error| unusable(error.to_string()))?;
        Ok(Self {
            path: latest.path,
            metadata,
            archive,
            refused: latest.refused,
        })
    }
}
