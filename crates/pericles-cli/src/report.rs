//! `run.json`: what was run, how it went, and the audit of energy and momentum.

use std::io::Write;
use std::path::Path;

use pericles::Simulation;
use pericles::observe::Field;
use pericles_deck::Deck;
use pericles_io::{IoError, read_csv, write_atomically};
use serde::Serialize;

use crate::checkpoint::DeckText;
use crate::error::CliError;
use crate::machine;
use crate::mirror::{MirrorError, Symmetries};
use crate::prepare::Facts;
use crate::refinement::RefinementAudit;
use crate::watch;

/// How a run stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Status {
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
pub(crate) struct Report {
    pub(crate) status: Status,
    /// What went wrong.
    pub(crate) error: Option<String>,
    /// The stop condition that ended a finished run before its last step.
    pub(crate) stop_reason: Option<String>,
    pub(crate) title: Option<String>,
    program: Program,
    pub(crate) model: Facts,
    pub(crate) progress: Span,
    pub(crate) audit: Option<Audit>,
    deck: DeckRecord,
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
pub(crate) struct Span {
    pub(crate) first_step: u64,
    pub(crate) last_step: u64,
    /// Simulated time reached, s.
    pub(crate) t: f64,
    /// Time of the clock since the first step of this session, output included, s.
    pub(crate) wall_seconds: f64,
    pub(crate) directed_bond_updates_per_second: f64,
    /// Bytes; none where the system does not tell.
    pub(crate) peak_memory: Option<u64>,
}

#[derive(Debug, Serialize)]
struct DeckRecord {
    #[serde(flatten)]
    text: DeckText,
    values: serde_json::Value,
}

/// What the audit compares the end with: the state before the first step of the whole run.
pub(crate) struct Start {
    momentum: [f64; 3],
    symmetries: Symmetries,
}

impl Start {
    /// Of a simulation that has made no step yet.
    pub(crate) fn of(simulation: &Simulation) -> Self {
        Self {
            momentum: simulation.system().momentum(&simulation.state().v),
            symmetries: Symmetries::of(simulation),
        }
    }
}

/// The account of energy and momentum at the end.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Audit {
    pub(crate) kinetic_energy: f64,
    pub(crate) elastic_energy: f64,
    pub(crate) dissipated_energy: f64,
    pub(crate) external_work: f64,
    pub(crate) initial_energy: f64,
    /// By how much the scheme's own conserved energy differs from kinetic + elastic.
    pub(crate) scheme_correction: f64,
    /// What the energies do not add up by.
    pub(crate) balance: f64,
    pub(crate) balance_over_work: f64,
    pub(crate) balance_over_dissipated: f64,
    /// The largest size of the balance among the rows of history.csv.
    pub(crate) largest_balance: f64,
    pub(crate) momentum: [f64; 3],
    pub(crate) impulse: [f64; 3],
    /// |momentum − momentum at the start − impulse|; NaN (null) for static states, which have no momentum.
    pub(crate) momentum_error: f64,
    /// The same over √(2 · kinetic energy · mass).
    pub(crate) momentum_error_relative: f64,
    pub(crate) broken_bonds: u64,
    pub(crate) largest_damage: f64,
    /// The balance over the larger of work and initial energy.
    pub(crate) energy_drift: f64,
    /// Highest frequency of the reference state that limits the step times the step; none if nothing resists motion.
    pub(crate) omega_dt: Option<f64>,
    /// Points whose force was evaluated since the start of the run: the whole body counts as many as it has points.
    pub(crate) evaluated_points: u64,
    /// Error of the last force for being computed in floats, over the largest force.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) force_rounding: Option<f64>,
    /// How far the displacements are from their mirror images, where a run begins as its own.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) mirror_errors: Vec<MirrorError>,
    /// None for schemes with one time step.
    pub(crate) refinement: Option<RefinementAudit>,
    /// What is odd about the results.
    pub(crate) warnings: Vec<String>,
}

impl Report {
    /// A report of a run that begins at `first_step`.
    pub(crate) fn new(deck: &Deck, text: DeckText, facts: Facts, first_step: u64) -> Self {
        Self {
            status: Status::Running,
            error: None,
            stop_reason: None,
            title: deck.title.clone(),
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
            deck: DeckRecord {
                text,
                values: deck.to_json().clone(),
            },
        }
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
    pub(crate) fn write(&self, path: &Path) -> Result<(), CliError> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(write_atomically(path, |file| {
            file.write_all(text.as_bytes())
        })?)
    }
}

impl Audit {
    /// The account of the present state.
    ///
    /// # Errors
    /// A history that cannot be read.
    pub(crate) fn of(
        simulation: &Simulation,
        start: &Start,
        history: &Path,
        report: &Report,
    ) -> Result<Self, IoError> {
        let (system, state) = (simulation.system(), simulation.state());
        let snapshot = simulation.snapshot();
        let energies = snapshot.energies();
        let balance = energies.balance();
        let momentum = system.momentum(&state.v);
        let impulse = system.ledger().impulse;
        let error = if simulation.integrator().is_static() {
            f64::NAN
        } else {
            (0..3)
                .map(|c| (momentum[c] - start.momentum[c] - impulse[c]).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        let volumes = system.cloud().volumes();
        let mass: f64 = (0..system.points())
            .map(|i| system.density().at(i) * volumes[i])
            .sum();
        let damage = snapshot.field(Field::Damage);
        // A run may keep no history.
        let table = history.exists().then(|| read_csv(history)).transpose()?;
        let rows = table.as_ref().and_then(|table| table.column("balance"));
        let audit = Self {
            kinetic_energy: energies.kinetic,
            elastic_energy: energies.elastic,
            dissipated_energy: energies.dissipated,
            external_work: energies.work,
            initial_energy: energies.initial,
            scheme_correction: energies.scheme,
            balance,
            balance_over_work: balance / energies.work.abs(),
            balance_over_dissipated: balance / energies.dissipated,
            largest_balance: rows
                .unwrap_or_default()
                .iter()
                .fold(balance.abs(), |most: f64, b| most.max(b.abs())),
            momentum,
            impulse,
            momentum_error: error,
            momentum_error_relative: error / (2.0 * energies.kinetic * mass).sqrt(),
            broken_bonds: system.operator().broken_bonds(),
            largest_damage: damage.iter().fold(0.0, |most: f64, &d| most.max(d)),
            energy_drift: balance / energies.work.abs().max(energies.initial.abs()),
            omega_dt: report
                .model
                .highest_frequency
                .map(|omega| omega * report.model.dt),
            evaluated_points: system.evaluated_points(),
            force_rounding: system.operator().rounding(&simulation.state().u),
            mirror_errors: start.symmetries.errors(simulation),
            refinement: simulation
                .integrator()
                .refinement()
                .map(|refinement| RefinementAudit::of(&refinement, system)),
            warnings: Vec::new(),
        };
        Ok(Self {
            warnings: watch::warnings(simulation, &audit),
            ..audit
        })
    }
}
