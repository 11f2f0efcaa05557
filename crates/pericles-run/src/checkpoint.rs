//! Checkpoints of a run: schedule and metadata.
//!
//! A checkpoint is written before the first step, so that a run that is killed at any time can be resumed, then by
//! the schedule of the deck (by default every ten minutes of wall-clock time; static runs also between load steps, as
//! long as this takes at most a twentieth of the time), and when a signal stops the run. If a run becomes unstable,
//! its state is written to `failed.chk` for inspection; `resume` continues from the last regular checkpoint.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use pericles::observe::Schedule;
use pericles::{Archive, Checkpointed, Simulation};
use pericles_deck::Checkpoint;
use pericles_io::{CheckpointFolder, Container, IoError, OutputFolder};
use serde::{Deserialize, Serialize};

use crate::error::RunError;
use crate::processes::agreed;
use crate::source::SourceRecord;

/// File of the state of a run that became unstable.
pub const FAILED: &str = "failed.chk";
/// Between load steps, the interval between checkpoints is at least this multiple of the time to write one.
const SHARE: u32 = 20;

/// Metadata of a checkpoint, sufficient to build the same run again.
#[derive(Debug, Clone, Serialize, Deserialize, PartialEq)]
pub struct Metadata {
    /// The version of Pericles.
    pub version: String,
    /// The instruction set of the run.
    pub instruction_set: String,
    /// Number of completed steps.
    pub step: u64,
    /// The deck or the model.
    #[serde(flatten)]
    pub source: SourceRecord,
}

/// The checkpoints of a run.
pub struct Checkpoints {
    folder: CheckpointFolder,
    schedule: Checkpoint,
    source: SourceRecord,
    last: Instant,
    /// Time to write the last checkpoint.
    cost: Duration,
}

impl Checkpoints {
    /// Creates the checkpoints of a run in its output folder.
    pub fn new(folder: &OutputFolder, schedule: Checkpoint, source: SourceRecord) -> Self {
        Self {
            folder: CheckpointFolder::new(folder.file("checkpoints")),
            schedule,
            source,
            last: Instant::now(),
            cost: Duration::ZERO,
        }
    }

    /// Returns the time to write the last checkpoint; zero before the first.
    pub fn cost(&self) -> Duration {
        self.cost
    }

    /// Returns whether a checkpoint is due after the current step.
    pub fn is_due(&self, simulation: &Simulation) -> bool {
        let step = simulation.state().step;
        let due = |schedule: Schedule| schedule.is_due(step, simulation.dt(), simulation.steps());
        match self.schedule {
            Checkpoint::Wall(seconds) => {
                // The interval of the deck may exceed the range of the clock.
                let wait = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
                // A load step may take as long as a whole dynamic run, and the next one may fail.
                let affordable = SHARE * self.cost;
                let is_static = simulation.integrator().is_static();
                let elapsed = self.last.elapsed();
                elapsed >= wait || is_static && elapsed >= affordable
            }
            Checkpoint::Every(steps) => due(Schedule::Every(steps)),
            Checkpoint::Interval(time) => due(Schedule::Interval(time)),
        }
    }

    /// Writes the current state.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&mut self, simulation: &Simulation) -> Result<PathBuf, RunError> {
        let began = Instant::now();
        let step = simulation.state().step;
        let written = match self.container(simulation)? {
            Some(container) => self.folder.write(step, &container).map_err(RunError::from),
            None => Ok(self.folder.file(step)),
        };
        let path = agreed(&**simulation.system().domain().comm(), written)?;
        self.last = Instant::now();
        self.cost = self.last - began;
        Ok(path)
    }

    /// Writes the state of a failed run, which cannot be resumed.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_failed(&self, simulation: &Simulation) -> Result<PathBuf, RunError> {
        let path = self.folder.path().join(FAILED);
        if let Some(container) = self.container(simulation)? {
            container.write(&path)?;
        }
        Ok(path)
    }

    /// Removes the state of an earlier failure.
    pub fn forget_failed(&self) {
        // An error is ignored: the next failure overwrites the file.
        let _ = std::fs::remove_file(self.folder.path().join(FAILED));
    }

    /// Returns the step at which `resume` would continue.
    pub fn last_step(&self) -> Option<u64> {
        self.folder.steps().ok()?.last().copied()
    }

    /// Returns the content of a checkpoint on the process that writes it; `None` on the others.
    fn container(&self, simulation: &Simulation) -> Result<Option<Container>, RunError> {
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
        let Some(archive) = archive.gathered(simulation.system().domain())? else {
            return Ok(None);
        };
        let metadata = serde_json::to_value(metadata)?;
        Ok(Some(Container::from_archive(metadata, archive)))
    }
}

/// A checkpoint read from a file.
pub struct Stored {
    /// The file.
    pub path: PathBuf,
    /// The metadata.
    pub metadata: Metadata,
    /// The state.
    pub archive: Archive,
    /// Errors of newer checkpoints that cannot be used.
    pub refused: Vec<IoError>,
}

impl Stored {
    /// Reads the newest usable checkpoint of a run, whose content may need at most `memory` bytes.
    ///
    /// # Errors
    /// No checkpoint is complete, it is from another program, or it needs more memory.
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
