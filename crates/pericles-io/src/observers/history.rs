//! The energy account over time.

use std::path::PathBuf;

use pericles::observe::{ObserveError, Observer, Snapshot};
use pericles::{Archive, Result, Saved};

use super::table::{AXES, ObserverTable, step_and_time, whole};
use crate::csv::{Cell, Column};

/// Energies, momentum and broken bonds: `history.csv`.
///
/// Columns: step, time, kinetic, elastic and dissipated energy, external work (loads and supports, since the start), the correction by which the
/// energy that the time scheme itself conserves differs, the balance (the sum of the energies and the correction, less the work and the energy at the
/// start; zero if nothing is lost), momentum along each axis of the body, broken bonds.
pub struct History {
    table: ObserverTable,
    dimension: usize,
    inner: bool,
}

impl History {
    /// A history of a body of this dimension.
    pub fn new(path: impl Into<PathBuf>, dimension: usize) -> Self {
        Self::with_columns(path.into(), dimension, false)
    }

    /// The same for a scheme with inner iterations, which adds two columns: the iterations of the last step, and the last change of the velocity.
    pub fn with_inner_iterations(path: impl Into<PathBuf>, dimension: usize) -> Self {
        Self::with_columns(path.into(), dimension, true)
    }

    fn with_columns(path: PathBuf, dimension: usize, inner: bool) -> Self {
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
        if inner {
            columns.push(Column::integer("inner_iterations"));
            columns.push(Column::real("inner_change", "m/s"));
        }
        Self {
            table: ObserverTable::new(path, "observer/history", columns),
            dimension,
            inner,
        }
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
        if self.inner {
            let inner = snapshot.inner_iterations().unwrap_or_default();
            row.push(whole(inner.last));
            row.push(inner.change.into());
        }
        Ok(self.table.append(&row)?)
    }
}

impl Saved for History {
    fn save(&self, archive: &mut Archive) {
        self.table.save(archive);
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        self.table.restore(archive)
    }
}
