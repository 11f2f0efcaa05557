//! Displacement and velocity at probe positions over time.

use std::path::PathBuf;

use pericles::observe::{ObserveError, Observer, Probe, Snapshot};

use super::table::{AXES, ObserverTable, step_and_time, whole};
use crate::csv::{Cell, Column};

/// Displacement and velocity at probes: `probes.csv`.
///
/// Columns: step, time, then for each probe `<name>_u_<axis>` (m) and `<name>_v_<axis>` (m/s).
pub struct Probes {
    table: ObserverTable,
    probes: Vec<Probe>,
    dimension: usize,
}

impl Probes {
    /// Creates the observer of probes in a body of the given dimension.
    pub fn new(path: impl Into<PathBuf>, probes: Vec<Probe>, dimension: usize) -> Self {
        let mut columns = step_and_time();
        for probe in &probes {
            for (letter, unit) in [("u", "m"), ("v", "m/s")] {
                for axis in &AXES[..dimension] {
                    columns.push(Column::real(
                        format!("{}_{letter}_{axis}", probe.name),
                        unit,
                    ));
                }
            }
        }
        Self {
            table: ObserverTable::new(path.into(), "observer/probes", columns),
            probes,
            dimension,
        }
    }
}

impl Observer for Probes {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        let state = snapshot.state();
        let mut row = vec![whole(state.step), state.t.into()];
        for probe in &self.probes {
            let reading = probe.read(snapshot)?;
            for vector in [reading.displacement, reading.velocity] {
                row.extend(vector[..self.dimension].iter().map(|&x| Cell::Real(x)));
            }
        }
        Ok(self.table.append(snapshot, &row)?)
    }
}

pericles::saved! {
    impl Checkpointed for Probes {
        table: part,
        probes, dimension: fixed,
    }
}
