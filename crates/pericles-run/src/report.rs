//! `run.json`: source, model, progress, and balance of energy and momentum.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;

use pericles::Simulation;
use serde::Serialize;

use crate::audit::Audit;
use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::facts::Facts;
use crate::json::write_json;
use crate::machine;
use crate::sharing::Sharing;
use crate::source::{ModelData, Source};

/// The status of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// The run is in progress, or its process was killed.
    Running,
    /// The run reached its end.
    Finished,
    /// The run was stopped and can be resumed.
    Stopped,
    /// The run failed.
    Failed,
}

/// The content of `run.json` in SI units; NaN and infinities are null.
#[derive(Debug, Serialize)]
pub struct Report {
    /// The status of the run.
    pub status: Status,
    /// The error of a failed run.
    pub error: Option<String>,
    /// The stop condition that ended a finished run before its last step.
    pub stop_reason: Option<String>,
    /// The title of the model.
    pub title: Option<String>,
    program: Program,
    /// Properties of the model.
    pub model: Facts,
    /// SI units of numbers of `model`, `audit` and `progress`.
    units: BTreeMap<&'static str, String>,
    /// Progress and performance.
    pub progress: Span,
    /// Division among processes and time in communication at the end; `None` for a single process.
    pub sharing: Option<Sharing>,
    /// Balance of energy and momentum at the end; `None` during the run.
    pub audit: Option<Audit>,
    #[serde(flatten)]
    source: Given,
}

#[derive(Debug, Serialize)]
struct Program {
    name: &'static str,
    version: &'static str,
    commit: Option<&'static str>,
    threads: usize,
    machine: String,
}

/// The commit of the program. The program, the last crate that is compiled, sets it: a constant of this crate would
/// have all crates above it compiled after every commit.
static COMMIT: OnceLock<Option<&'static str>> = OnceLock::new();

/// Sets the commit from which the running program was built, which `run.json` records. The first call decides.
pub fn set_commit(commit: Option<&'static str>) {
    COMMIT.get_or_init(|| commit);
}

/// Progress and performance of the current session.
#[derive(Debug, Default, Serialize)]
pub struct Span {
    /// The step at which the current session began.
    pub first_step: u64,
    /// The last completed step.
    pub last_step: u64,
    /// Simulated time reached, s.
    pub t: f64,
    /// Wall-clock time since the first step of this session, including output, s.
    pub wall_seconds: f64,
    /// Directed bonds times steps per wall-clock time, 1/s.
    pub directed_bond_updates_per_second: f64,
    /// Peak memory, bytes; `None` if the system does not report it.
    pub peak_memory: Option<u64>,
}

impl Span {
    /// SI units of the numbers.
    const UNITS: [(&str, &[&str]); 3] = [
        ("s", &["t", "wall_seconds"]),
        ("1/s", &["directed_bond_updates_per_second"]),
        ("B", &["peak_memory"]),
    ];
}

/// Returns the units of the numbers of a report.
fn units(facts: &Facts) -> BTreeMap<&'static str, String> {
    let model = facts
        .iter()
        .filter(|fact| fact.is_recorded && !fact.unit.is_empty());
    let model = model.map(|fact| (fact.key, fact.unit.clone()));
    let later = Audit::UNITS.into_iter().chain(Span::UNITS);
    let later = later.flat_map(|(unit, keys)| keys.iter().map(move |key| (*key, facts.unit(unit))));
    model.chain(later).collect()
}

/// The source: a deck with the values read from it, or a model.
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
    /// Creates the report of a run that begins at `first_step`.
    pub(crate) fn new(source: &Source, facts: Facts, first_step: u64) -> Self {
        Self {
            status: Status::Running,
            error: None,
            stop_reason: None,
            title: source.model().title.clone(),
            program: Program {
                name: "pericles",
                version: env!("CARGO_PKG_VERSION"),
                commit: COMMIT.get().copied().flatten(),
                threads: rayon::current_num_threads(),
                machine: machine::words(),
            },
            units: units(&facts),
            model: facts,
            progress: Span {
                first_step,
                last_step: first_step,
                ..Span::default()
            },
            sharing: None,
            audit: None,
            source: Given::of(source),
        }
    }

    /// Starts a session at `step`.
    pub(crate) fn begin_session(&mut self, step: u64) {
        self.status = Status::Running;
        self.sharing = None;
        self.audit = None;
        self.progress.first_step = step;
        self.progress.last_step = step;
    }

    /// Records progress and performance.
    pub(crate) fn note_progress(&mut self, simulation: &Simulation, wall_seconds: f64) {
        let state = simulation.state();
        let first_step = self.progress.first_step;
        let updates = (state.step - first_step) as f64 * self.model.count("directed_bonds") as f64;
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
    /// The file cannot be written.
    pub(crate) fn write(&self, path: &Path) -> Result<(), RunError> {
        write_json(path, self)
    }
}
