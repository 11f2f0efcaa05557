//! Named scalars of a state, and tables of them.
//!
//! A source computes scalars from a state alone. Tables write them, and derived quantities and stop conditions read
//! them by the names of their columns, so that a scalar has one name and one definition.

use pericles::System;
use pericles::boundary::PrescribedMotion;
use pericles::observe::{ObserveError, Observer, Probe, ProbeReading, Snapshot};
use pericles::units::BodyUnits;

use super::table::{AXES, ObserverTable, TableTarget, step_and_time, whole};
use crate::csv::{Cell, Column};

/// Scalars of a state.
pub trait Signals: Send + Sync {
    /// Returns their names and units.
    fn columns(&self) -> Vec<Column>;

    /// Returns their values. All processes call it together and receive the same values.
    ///
    /// # Errors
    /// They cannot be computed.
    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError>;
}

impl Signals for Box<dyn Signals> {
    fn columns(&self) -> Vec<Column> {
        (**self).columns()
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        (**self).cells(snapshot)
    }
}

/// A table of signals: step, time, and a column per signal.
pub struct SignalTable {
    table: ObserverTable,
    signals: Box<dyn Signals>,
}

impl SignalTable {
    /// Creates the table of signals; `key` is the name of its length in checkpoints.
    pub fn new(
        table: impl Into<TableTarget>,
        key: &'static str,
        signals: impl Signals + 'static,
    ) -> Self {
        let columns = [step_and_time(), signals.columns()].concat();
        Self {
            table: ObserverTable::new(table.into(), key, columns),
            signals: Box::new(signals),
        }
    }
}

impl Observer for SignalTable {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        let state = snapshot.state();
        let mut row = vec![whole(state.step), state.t.into()];
        row.extend(self.signals.cells(snapshot)?);
        Ok(self.table.append(snapshot, &row)?)
    }
}

pericles::saved! {
    impl Checkpointed for SignalTable {
        table: part,
        signals: fixed,
    }
}

/// The time (s) of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimeSignal;

impl Signals for TimeSignal {
    fn columns(&self) -> Vec<Column> {
        vec![Column::real("time", "s")]
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        Ok(vec![snapshot.state().t.into()])
    }
}

/// Energies and their balance, momentum, broken bonds: the first columns of histories.
///
/// Kinetic, elastic and dissipated energy, external work (loads and supports, since the start), the correction by which
/// the energy conserved by the time scheme differs, the balance (sum of energies and correction, minus the work and the
/// initial energy; zero if energy is conserved), momentum along each axis of the body, broken bonds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EnergySignals {
    /// Dimension of the body.
    pub dimension: usize,
    /// Units of the energies and momenta.
    pub units: BodyUnits,
}

impl Signals for EnergySignals {
    fn columns(&self) -> Vec<Column> {
        let energies = [
            "kinetic_energy",
            "elastic_energy",
            "dissipated_energy",
            "external_work",
            "scheme_correction",
            "balance",
        ];
        let mut columns: Vec<Column> = energies
            .map(|name| Column::real(name, self.units.unit("J")))
            .into();
        for axis in &AXES[..self.dimension] {
            let unit = self.units.unit("kg m/s");
            columns.push(Column::real(format!("momentum_{axis}"), unit));
        }
        columns.push(Column::integer("broken_bonds"));
        columns
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let (state, system) = (snapshot.state(), snapshot.system());
        let energies = snapshot.energies();
        let mut cells: Vec<Cell> = vec![
            energies.kinetic.into(),
            energies.elastic.into(),
            energies.dissipated.into(),
            energies.work.into(),
            energies.scheme.into(),
            energies.balance().into(),
        ];
        let momentum = system.momentum(&state.v);
        cells.extend(momentum[..self.dimension].iter().map(|&p| Cell::Real(p)));
        cells.push(whole(system.operator().broken_bonds()));
        Ok(cells)
    }
}

/// Mean displacement `<name>_u_<axis>` (m) and velocity `<name>_v_<axis>` (m/s) of probes.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbeSignals {
    /// The probes.
    pub probes: Vec<Probe>,
    /// Dimension of the body.
    pub dimension: usize,
}

impl Signals for ProbeSignals {
    fn columns(&self) -> Vec<Column> {
        let mut columns = Vec::new();
        for probe in &self.probes {
            for (letter, unit) in [("u", "m"), ("v", "m/s")] {
                let named = |axis: &&str| format!("{}_{letter}_{axis}", probe.name);
                let axes = AXES[..self.dimension].iter();
                columns.extend(axes.map(|axis| Column::real(named(axis), unit)));
            }
        }
        columns
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let mut cells = Vec::new();
        for probe in &self.probes {
            let ProbeReading {
                displacement,
                velocity,
            } = probe.read(snapshot)?;
            for vector in [displacement, velocity] {
                cells.extend(vector[..self.dimension].iter().map(|&x| Cell::Real(x)));
            }
        }
        Ok(cells)
    }
}

/// The force of the support on the body for each prescribed motion and axis, `<name>_<axis>` (N): the reaction
/// Σ V (ρ a − f − b) over the constrained points.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReactionSignals {
    names: Vec<String>,
    units: BodyUnits,
}

impl ReactionSignals {
    /// Creates the reactions of the motions of a system.
    pub fn new(system: &System) -> Self {
        let named = |motion: &PrescribedMotion| {
            let axes = motion.axes();
            let names = axes.map(|axis| format!("{}_{}", motion.name, AXES[axis]));
            names.collect::<Vec<_>>()
        };
        Self {
            names: system.motions().iter().flat_map(named).collect(),
            units: system.cloud().body_units(),
        }
    }
}

impl Signals for ReactionSignals {
    fn columns(&self) -> Vec<Column> {
        let unit = self.units.unit("N");
        let names = self.names.iter();
        names
            .map(|name| Column::real(name.as_str(), unit.as_str()))
            .collect()
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let system = snapshot.system();
        let mut cells = Vec::new();
        for motion in system.motions() {
            let force = motion.reaction(system.cloud());
            cells.extend(motion.axes().map(|axis| Cell::Real(force[axis])));
        }
        Ok(cells)
    }
}
