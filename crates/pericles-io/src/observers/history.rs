//! Energy balance over time.

use pericles::observe::{ObserveError, Observer, Snapshot};
use pericles::space::PointCloud;
use pericles::{Archive, Checkpointed, Result};

use super::HistoryColumns;
use super::signals::{EnergySignals, Signals};
use super::table::{ObserverTable, TableTarget, step_and_time, whole};
use crate::csv::{Cell, Column};

/// Signals as columns of a history; they have no state.
struct Stateless(Box<dyn Signals>);

impl HistoryColumns for Stateless {
    fn columns(&self) -> Vec<Column> {
        self.0.columns()
    }

    fn cells(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        self.0.cells(snapshot)
    }
}

impl Checkpointed for Stateless {
    fn save(&self, _archive: &mut Archive) {}

    fn restore(&mut self, _archive: &Archive) -> Result<()> {
        Ok(())
    }
}

/// The rows of a history: step, time, the columns of [`EnergySignals`], and those added by [`HistoryRows::with`] and
/// [`HistoryRows::with_signals`].
pub struct HistoryRows {
    columns: Vec<Column>,
    parts: Vec<Box<dyn HistoryColumns>>,
}

impl HistoryRows {
    /// Creates the rows for the points of a body.
    pub fn new(cloud: &PointCloud) -> Self {
        let rows = Self {
            columns: step_and_time(),
            parts: Vec::new(),
        };
        rows.with_signals(EnergySignals {
            dimension: cloud.dimension(),
            units: cloud.body_units(),
        })
    }

    /// Adds columns.
    #[must_use]
    pub fn with(mut self, columns: impl HistoryColumns + 'static) -> Self {
        self.columns.extend(columns.columns());
        self.parts.push(Box::new(columns));
        self
    }

    /// Adds signals.
    #[must_use]
    pub fn with_signals(self, signals: impl Signals + 'static) -> Self {
        self.with(Stateless(Box::new(signals)))
    }

    /// Returns names and units of the columns.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Returns the row of a state.
    ///
    /// # Errors
    /// A column cannot be computed.
    pub fn row(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let state = snapshot.state();
        let mut row = vec![whole(state.step), state.t.into()];
        for columns in &mut self.parts {
            row.extend(columns.cells(snapshot)?);
        }
        Ok(row)
    }
}

pericles::saved! {
    impl Checkpointed for HistoryRows {
        parts: part,
        columns: fixed,
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
    pub fn new(table: impl Into<TableTarget>, rows: HistoryRows) -> Self {
        let columns = rows.columns().to_vec();
        Self {
            table: ObserverTable::new(table.into(), "observer/history", columns),
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
        let row = self.rows.row(snapshot)?;
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
