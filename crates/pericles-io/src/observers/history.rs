//! Energy balance over time.

use std::path::PathBuf;

use pericles::observe::{ObserveError, Observer, Snapshot};

use super::HistoryColumns;
use super::table::{AXES, ObserverTable, step_and_time, whole};
use crate::csv::{Cell, Column};

/// The rows of a history: energies, momentum and broken bonds of states.
///
/// Columns: step, time, kinetic, elastic and dissipated energy, external work (loads and supports, since the
/// start), the correction by which the energy conserved by the time scheme differs, the balance (sum of
/// energies and correction, minus the work and the initial energy; zero if energy is conserved), momentum
/// along each axis of the body, broken bonds, and the columns added by [`HistoryRows::with`].
pub struct HistoryRows {
    columns: Vec<Column>,
    dimension: usize,
    more: Vec<Box<dyn HistoryColumns>>,
}

impl HistoryRows {
    /// Creates the rows for a body of the given dimension.
    pub fn new(dimension: usize) -> Self {
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
            columns,
            dimension,
            more: Vec::new(),
        }
    }

    /// Adds columns.
    #[must_use]
    pub fn with(mut self, columns: impl HistoryColumns + 'static) -> Self {
        self.columns.extend(columns.columns());
        self.more.push(Box::new(columns));
        self
    }

    /// Returns names and units of the columns.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Returns the row of a state.
    pub fn row(&mut self, snapshot: &Snapshot<'_>) -> Vec<Cell> {
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
        row
    }
}

pericles::saved! {
    impl Checkpointed for HistoryRows {
        more: part,
        columns, dimension: fixed,
    }
}

/// A history in a table: `history.csv`.
pub struct History {
    table: ObserverTable,
    rows: HistoryRows,
    /// Largest magnitude of the balance so far, J.
    largest_balance: f64,
}

impl History {
    /// Creates a history with the given rows.
    pub fn new(path: impl Into<PathBuf>, rows: HistoryRows) -> Self {
        let columns = rows.columns().to_vec();
        Self {
            table: ObserverTable::new(path.into(), "observer/history", columns),
            rows,
            largest_balance: 0.0,
        }
    }

    /// Returns the largest magnitude of the energy balance in the rows so far, J.
    pub fn largest_balance(&self) -> f64 {
        self.largest_balance
    }
}

impl Observer for History {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        let row = self.rows.row(snapshot);
        let balance = snapshot.energies().balance();
        self.largest_balance = self.largest_balance.max(balance.abs());
        Ok(self.table.append(snapshot, &row)?)
    }
}

pericles::saved! {
    impl Checkpointed for History {
        table, rows: part,
        largest_balance: array("observer/largest-balance"),
    }
}
