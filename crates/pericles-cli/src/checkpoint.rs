//! Checkpoints of a run: when they are due, and what they hold besides the state.
//!
//! One is written before the first step, so that a run that dies at any time can be resumed, then at the deck's schedule (by default every ten minutes
//! of wall time; static runs also between load steps, as far as that takes no more than a twentieth of the time), and when a signal stops the run. A run that becomes unstable leaves its failing state as `failed.chk`, which is for looking
//! at only: `resume` goes on from the last regular one.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use pericles::observe::Schedule;
use pericles::{Archive, Saved, Simulation};
use pericles_deck::{Checkpoint, Deck};
use pericles_io::{CheckpointFolder, Container, IoError, OutputFolder};
use serde::{Deserialize, Serialize};

use crate::error::CliError;
use crate::inputs::Inputs;

/// The state of a run that became unstable.
pub(crate) const FAILED: &str = "failed.chk";
/// Between load steps checkpoints are as many times rarer than they take to write.
const SHARE: u32 = 20;

/// What a checkpoint says besides the state: enough to build the same run again.
#[derive(Debug, Clone, Serialize, Deserialize, PartialEq)]
pub(crate) struct Metadata {
    /// The version that wrote it.
    pub(crate) version: String,
    /// The instruction set it ran with.
    pub(crate) instruction_set: String,
    /// Steps taken.
    pub(crate) step: u64,
    /// The deck.
    pub(crate) deck: DeckText,
}

/// A deck as it was given.
#[derive(Debug, Clone, Serialize, Deserialize, PartialEq)]
pub(crate) struct DeckText {
    /// What messages call it.
    pub(crate) file: String,
    /// Its text.
    pub(crate) source: String,
    /// The overrides from the command line.
    pub(crate) overrides: Vec<String>,
    /// The files that the deck names.
    #[serde(default, skip_serializing_if = "Inputs::is_empty")]
    pub(crate) inputs: Inputs,
}

impl DeckText {
    /// The text of a deck that was read from `file`.
    pub(crate) fn of(deck: &Deck, file: String) -> Self {
        Self {
            inputs: Inputs::of(deck, &file),
            file,
            source: deck.source().to_owned(),
            overrides: deck.overrides().map(str::to_owned).collect(),
        }
    }

    /// Reads the deck again, from whatever folder.
    ///
    /// # Errors
    /// What this version no longer accepts; a file that the deck names and that is no longer what it was.
    pub(crate) fn read(&self) -> Result<Deck, CliError> {
        let file = self.inputs.located(&self.file);
        let deck = Deck::parse(&self.source, &file, &self.overrides)?;
        self.inputs.check(&deck)?;
        Ok(deck)
    }
}

/// The checkpoints of one run.
pub(crate) struct Checkpoints {
    folder: CheckpointFolder,
    schedule: Checkpoint,
    deck: DeckText,
    last: Instant,
    /// How long the last one took to write.
    cost: Duration,
}

impl Checkpoints {
    /// The checkpoints of a run in its output folder.
    pub(crate) fn new(folder: &OutputFolder, schedule: Checkpoint, deck: DeckText) -> Self {
        Self {
            folder: CheckpointFolder::new(folder.file("checkpoints")),
            schedule,
            deck,
            last: Instant::now(),
            cost: Duration::ZERO,
        }
    }

    /// How long the last one took to write; zero before the first.
    pub(crate) fn cost(&self) -> Duration {
        self.cost
    }

    /// Whether one is due after the present step.
    pub(crate) fn is_due(&self, simulation: &Simulation) -> bool {
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
    pub(crate) fn write(&mut self, simulation: &Simulation) -> Result<PathBuf, CliError> {
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
    pub(crate) fn write_failed(&self, simulation: &Simulation) -> Result<PathBuf, CliError> {
        let path = self.folder.path().join(FAILED);
        self.container(simulation)?.write(&path)?;
        Ok(path)
    }

    /// Removes what an earlier failure left.
    pub(crate) fn forget_failed(&self) {
        // It is overwritten by the next failure, and of no use to a success.
        let _ = std::fs::remove_file(self.folder.path().join(FAILED));
    }

    /// The step from which `resume` would go on.
    pub(crate) fn last_step(&self) -> Option<u64> {
        self.folder.steps().ok()?.last().copied()
    }

    fn container(&self, simulation: &Simulation) -> Result<Container, CliError> {
        simulation
            .settle()
            .map_err(|error| CliError::of_run(error, String::new))?;
        let operator = simulation.system().operator();
        let metadata = Metadata {
            version: env!("CARGO_PKG_VERSION").into(),
            instruction_set: operator.instruction_set().name().into(),
            step: simulation.state().step,
            deck: self.deck.clone(),
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
pub(crate) struct Stored {
    /// The file.
    pub(crate) path: PathBuf,
    /// What it says.
    pub(crate) metadata: Metadata,
    /// The state.
    pub(crate) archive: Archive,
    /// Why newer ones were refused.
    pub(crate) refused: Vec<IoError>,
}

impl Stored {
    /// The newest usable checkpoint of a run; its content may take so many bytes of memory.
    ///
    /// # Errors
    /// No checkpoint that is whole, one of another program, one that needs more memory.
    pub(crate) fn latest(folder: &OutputFolder, memory: u64) -> Result<Self, CliError> {
        let latest = CheckpointFolder::new(folder.file("checkpoints")).latest_valid(memory)?;
        let unusable = |reason: String| CliError::Checkpoint {
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
