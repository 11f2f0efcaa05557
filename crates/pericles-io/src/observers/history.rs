//! Energy balance over time.

use std::path::PathBuf;

use pericles::observe::{ObserveError, Observer, Snapshot};

use super::HistoryColumns;
use super::table::{AXES, ObserverTable, step_and_time, whole};
use crate::csv::{Cell, Column};

/// Energies, momentum and broken bonds: `history.csv`.
///
/// Columns: step, time, kinetic, elastic and dissipated energy, external work (loads and supports, since the
/// start), the correction by which the energy conserved by the time scheme differs, the balance (sum of
/// energies and correction, minus the work and the initial energy; zero if energy is conserved), momentum
/// along each axis of the body, broken bonds, and the columns added by [`History::with`].
pub struct History {
    table: ObserverTable,
    dimension: usize,
    more: Vec<Box<dyn HistoryColumns>>,
}

impl History {
    /// Creates a history for a body of the given dimension.
    pub fn new(path: impl Into<PathBuf>, dimension: usize) -> Self {
        let mut columns = step_and_time();
        for name in [
            "kinetic_energy",
            "elastic_energy",
            "dissipated_energy",
            "external_work",
            "scheme_correction",
            "balance",
        ] {
            columns.push(Column::real(name, "J"));
        }
        for axis in &AXES[..dimension] {
            columns.push(Column::real(format!("momentum_{axis}"), "kg m/s"));
        }
        columns.push(Column::integer("broken_bonds"));
        Self {
            table: ObserverTable::new(path.into(), "observer/history", columns),
            dimension,
            more: Vec::new(),
        }
    }

    /// Adds columns.
    #[must_use]
    pub fn with(mut self, columns: impl HistoryColumns + 'static) -> Self {
        self.table.add_columns(columns.columns());
        self.more.push(Box::new(columns));
        self
    }
}

impl Observer for History {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        let (state, system) = (snapshot.state(), snapshot.system());
        let energies = snapshot.energies();
        let mut row = vec![
            whole(state.step),
            state.t.into(),
            energies.kinetic.into(),
            energies.elastic.into(),
            energies.dissipated.into(),
            energies.work.into(),
            energies.scheme.into(),
            energies.balance().into(),
        ];
        let momentum = system.momentum(&state.v);
        row.extend(momentum[..self.dimension].iter().map(|&p| Cell::Real(p)));
        row.push(whole(system.operator().broken_bonds()));
        for columns in &mut self.more {
            row.extend(columns.cells(snapshot));
        }
        Ok(self.table.append(&row)?)
    }
}

pericles::saved! {
    impl Checkpointed for History {
        table, more: part,
        dimension: fixed,
    }
}
