//! Checkpoints of a run: schedule and metadata.
//!
//! A checkpoint is written before the first step, so that a run that is killed at any time can be resumed, then by
//! the schedule of the deck (by default every ten minutes of wall-clock time; static runs also between load steps, as
//! long as this takes at most a twentieth of the time), and when a signal stops the run. If a run becomes unstable,
//! its state is written to `failed.chk` for inspection; `resume` continues from the last regular checkpoint.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use pericles::division::DividedArchive;
use pericles::domain::Comm;
use pericles::observe::Schedule;
use pericles::{Archive, Checkpointed, PericlesError, Simulation};
use pericles_deck::Checkpoint;
use pericles_io::{
    CheckpointFolder, Container, DividedCheckpoint, IoError, OutputFolder, write_divided,
};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::body_record::BodyRecord;
use crate::error::RunError;
use crate::processes::{agreed, on_first};
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
    /// The time, s.
    pub t: f64,
    /// The time step, s.
    pub dt: f64,
    /// The body, for runs that start from this state.
    pub body: BodyRecord,
    /// Warnings during the run so far.
    pub warnings: Vec<String>,
    /// The deck or the model.
    pub source: SourceRecord,
}

/// The checkpoints of a run.
pub struct Checkpoints {
    folder: CheckpointFolder,
    schedule: Checkpoint,
    source: SourceRecord,
    body: BodyRecord,
    /// Warnings during the run so far.
    warnings: Vec<String>,
    last: Instant,
    /// Time to write the last checkpoint.
    cost: Duration,
}

impl Checkpoints {
    /// Creates the checkpoints of a run in its output folder.
    pub fn new(
        folder: &OutputFolder,
        schedule: Checkpoint,
        source: SourceRecord,
        body: BodyRecord,
    ) -> Self {
        Self {
            folder: CheckpointFolder::new(folder.file("checkpoints")),
            schedule,
            source,
            body,
            warnings: Vec::new(),
            last: Instant::now(),
            cost: Duration::ZERO,
        }
    }

    /// Records a warning during the run, which a resumed run has as well.
    pub fn warn(&mut self, warning: String) {
        self.warnings.push(warning);
    }

    /// Returns the recorded warnings.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
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
        let (metadata, archive) = self.content(simulation)?;
        let domain = simulation.system().domain();
        let path = match domain.is_divided() {
            true => {
                let archive = DividedArchive::new(archive, domain)?;
                self.folder.write_divided(step, &metadata, archive)?
            }
            false => {
                let container = Container::from_archive(metadata, archive);
                self.folder.write(step, &container)?
            }
        };
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
        let (metadata, archive) = self.content(simulation)?;
        let domain = simulation.system().domain();
        match domain.is_divided() {
            true => write_divided(&path, &metadata, DividedArchive::new(archive, domain)?)?,
            false => Container::from_archive(metadata, archive).write(&path)?,
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

    /// Returns metadata and state of this process. All processes must call it together.
    fn content(&self, simulation: &Simulation) -> Result<(Value, Archive), RunError> {
        let comm = simulation.system().domain().comm();
        agreed(&**comm, self.own_content(simulation))
    }

    fn own_content(&self, simulation: &Simulation) -> Result<(Value, Archive), RunError> {
        simulation
            .settle()
            .map_err(|error| RunError::of_run(error, String::new))?;
        let operator = simulation.system().operator();
        let metadata = Metadata {
            version: env!("CARGO_PKG_VERSION").into(),
            instruction_set: operator.instruction_set().name().into(),
            step: simulation.state().step,
            t: simulation.state().t,
            dt: simulation.dt(),
            body: self.body.clone(),
            warnings: self.warnings.clone(),
            source: self.source.clone(),
        };
        let mut archive = Archive::default();
        simulation.save(&mut archive);
        Ok((serde_json::to_value(metadata)?, archive))
    }
}

/// The state in a checkpoint.
pub enum Content {
    /// The archive of a body on a single process.
    Whole(Archive),
    /// The archive of a divided body, which the processes read together.
    Divided(Box<DividedCheckpoint>),
}

/// A checkpoint that a run resumes from.
pub struct Stored {
    /// The file.
    pub path: PathBuf,
    /// The metadata.
    pub metadata: Metadata,
    /// Errors of newer checkpoints that cannot be used, on the first process.
    pub rejected: Vec<IoError>,
    pub(crate) content: Content,
}

impl Stored {
    /// Reads or opens a given checkpoint, as [`Stored::latest`].
    ///
    /// # Errors
    /// The checkpoint is not complete, is from another program, or needs more memory.
    pub fn open(path: &Path, memory: u64, comm: &dyn Comm) -> Result<Self, RunError> {
        if comm.size() > 1 {
            let checkpoint = DividedCheckpoint::open(path, memory, comm)?;
            return Self::of_divided(checkpoint, Vec::new(), comm);
        }
        let container = Container::read(path, memory)?;
        Self::of_container(path, container, Vec::new(), comm)
    }

    fn of_divided(
        checkpoint: DividedCheckpoint,
        rejected: Vec<IoError>,
        comm: &dyn Comm,
    ) -> Result<Self, RunError> {
        let path = checkpoint.path().to_path_buf();
        let metadata = checkpoint.metadata().clone();
        let content = Content::Divided(Box::new(checkpoint));
        Self::of((path, metadata, content), rejected, comm)
    }

    fn of_container(
        path: &Path,
        container: Container,
        rejected: Vec<IoError>,
        comm: &dyn Comm,
    ) -> Result<Self, RunError> {
        let (metadata, archive) =
            (container.into_archive()).map_err(|reason| RunError::Checkpoint {
                path: path.into(),
                reason,
            })?;
        let content = Content::Whole(archive);
        Self::of((path.into(), metadata, content), rejected, comm)
    }

    fn of(
        (path, metadata, content): (PathBuf, Value, Content),
        rejected: Vec<IoError>,
        comm: &dyn Comm,
    ) -> Result<Self, RunError> {
        // Other processes may not see the file.
        let read = || {
            serde_json::from_value(metadata).map_err(|error| RunError::Checkpoint {
                path: path.clone(),
                reason: error.to_string(),
            })
        };
        let words = |metadata: &Metadata| serde_json::to_string(metadata).unwrap_or_default();
        let (metadata, text) = on_first(comm, read, words)?;
        Ok(Self {
            metadata: metadata.map_or_else(|| serde_json::from_str(&text), Ok)?,
            path,
            rejected,
            content,
        })
    }

    /// Reads or opens the newest usable checkpoint of a run; the part of a process may need at most `memory` bytes. All
    /// processes must call it together.
    ///
    /// # Errors
    /// No checkpoint is complete, it is from another program, or it needs more memory.
    pub fn latest(folder: &OutputFolder, memory: u64, comm: &dyn Comm) -> Result<Self, RunError> {
        let folder = CheckpointFolder::new(folder.file("checkpoints"));
        if comm.size() > 1 {
            let (checkpoint, rejected) = folder.latest_divided(memory, comm)?;
            return Self::of_divided(checkpoint, rejected, comm);
        }
        let latest = folder.latest_valid(memory)?;
        Self::of_container(&latest.path, latest.container, latest.rejected, comm)
    }

    /// Restores a simulation. All processes must call it together.
    ///
    /// # Errors
    /// The checkpoint does not match the simulation, or its file has changed since it was opened.
    pub fn restore(self, simulation: &mut Simulation) -> Result<(), RunError> {
        let path = self.path;
        let unusable = |error: PericlesError| match error {
            PericlesError::OnAnotherProcess => error.into(),
            error => RunError::Checkpoint {
                path: path.clone(),
                reason: error.to_string(),
            },
        };
        let restored = match self.content {
            Content::Whole(archive) => simulation.restore(&archive),
            Content::Divided(mut checkpoint) => {
                let mut template = Archive::default();
                simulation.save(&mut template);
                let domain = simulation.system().domain();
                Archive::part_of(&template, &mut *checkpoint, domain)
                    .and_then(|own| simulation.restore(&own))
            }
        };
        let comm = Arc::clone(simulation.system().domain().comm());
        agreed(&*comm, restored.map_err(unusable))
    }
}
