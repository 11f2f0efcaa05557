//! `run.json`: what was run, how it went, and the audit of energy and momentum.

use std::io::Write;
use std::path::Path;

use pericles::Simulation;
use pericles_io::write_atomically;
use serde::Serialize;

use crate::audit::Audit;
use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::facts::Facts;
use crate::machine;
use crate::source::{ModelData, Source};

/// How a run stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It runs, or its process died.
    Running,
    /// It reached its end.
    Finished,
    /// It was stopped and can be resumed.
    Stopped,
    /// It failed.
    Failed,
}

/// The content of `run.json`; SI units throughout, numbers that are not finite as null.
#[derive(Debug, Serialize)]
pub struct Report {
    /// How the run stands.
    pub status: Status,
    /// What went wrong.
    pub error: Option<String>,
    /// The stop condition that ended a finished run before its last step.
    pub stop_reason: Option<String>,
    /// The title of the model.
    pub title: Option<String>,
    program: Program,
    /// What is known of the model.
    pub model: Facts,
    /// How far the run came and how fast.
    pub progress: Span,
    /// The account at the end; none of a run that has not come to rest.
    pub audit: Option<Audit>,
    #[serde(flatten)]
    source: Given,
}

#[derive(Debug, Serialize)]
struct Program {
    name: &'static str,
    version: &'static str,
    threads: usize,
    machine: String,
}

/// What was done since the program was started, and how fast.
#[derive(Debug, Default, Serialize)]
pub struct Span {
    /// The step at which the present session began.
    pub first_step: u64,
    /// The last step made.
    pub last_step: u64,
    /// Simulated time reached, s.
    pub t: f64,
    /// Time of the clock since the first step of this session, output included, s.
    pub wall_seconds: f64,
    /// Directed bonds times steps over the time of the clock, 1/s.
    pub directed_bond_updates_per_second: f64,
    /// Bytes; none where the system does not tell.
    pub peak_memory: Option<u64>,
}

/// What was given, a deck with the values that were read from it, or a model.
#[derive(Debug, Serialize)]
enum Given {
    #[serde(rename = "deck")]
    Deck {
        #[serde(flatten)]
        text: DeckText,
        values: serde_json::Value,
    },
    #[serde(rename = "model_data")]
    Model(Box<ModelData>),
}

impl Given {
    fn of(source: &Source) -> Self {
        match source {
            Source::Deck { deck, text } => Self::Deck {
                text: text.clone(),
                values: deck.to_json().clone(),
            },
            Source::Model(data) => Self::Model(data.clone()),
        }
    }
}

impl Report {
    /// A report of a run that begins at `first_step`.
    pub(crate) fn new(source: &Source, facts: Facts, first_step: u64) -> Self {
        Self {
            status: Status::Running,
            error: None,
            stop_reason: None,
            title: source.model().title.clone(),
            program: Program {
                name: "pericles",
                version: env!("CARGO_PKG_VERSION"),
                threads: rayon::current_num_threads(),
                machine: machine::words(),
            },
            model: facts,
            progress: Span {
                first_step,
                last_step: first_step,
                ..Span::default()
            },
            audit: None,
            source: Given::of(source),
        }
    }

    /// Notes that the run goes on from `step`.
    pub(crate) fn begin_session(&mut self, step: u64) {
        self.status = Status::Running;
        self.audit = None;
        self.progress.first_step = step;
        self.progress.last_step = step;
    }

    /// Notes how far the run came and how fast.
    pub(crate) fn note_progress(&mut self, simulation: &Simulation, wall_seconds: f64) {
        let state = simulation.state();
        let first_step = self.progress.first_step;
        let updates = (state.step - first_step) as f64 * self.model.directed_bonds as f64;
        self.progress = Span {
            first_step,
            last_step: state.step,
            t: state.t,
            wall_seconds,
            directed_bond_updates_per_second: updates / wall_seconds,
            peak_memory: machine::peak_memory(),
        };
    }

    /// Writes the report.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(crate) fn write(&self, path: &Path) -> Result<(), RunError> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(write_atomically(path, |file| {
            file.write_all(text.as_bytes())
        })?)
    }
}
