//! Reaction forces over time.

use std::path::PathBuf;

use pericles::boundary::PrescribedMotion;
use pericles::observe::{ObserveError, Observer, Snapshot};

use super::table::{AXES, ObserverTable, step_and_time, whole};
use crate::csv::{Cell, Column};

/// The force of the support on the body for each prescribed motion and axis: `reactions.csv`.
///
/// Columns: step, time, then `<name>_<axis>` in newtons. The reaction is Σ V (ρ a − f − b) over the constrained points.
pub struct Reactions {
    table: ObserverTable,
}

impl Reactions {
    /// Creates the observer for a system with these motions, which must belong to the system.
    pub fn new(path: impl Into<PathBuf>, motions: &[PrescribedMotion]) -> Self {
        let mut columns = step_and_time();
        for motion in motions {
            for axis in motion.axes() {
                columns.push(Column::real(format!("{}_{}", motion.name, AXES[axis]), "N"));
            }
        }
        Self {
            table: ObserverTable::new(path.into(), "observer/reactions", columns),
        }
    }
}

impl Observer for Reactions {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        let (state, system) = (snapshot.state(), snapshot.system());
        let mut row = vec![whole(state.step), state.t.into()];
        for motion in system.motions() {
            let force = motion.reaction(system.cloud());
            row.extend(motion.axes().map(|axis| Cell::Real(force[axis])));
        }
        Ok(self.table.append(snapshot, &row)?)
    }
}

pericles::saved! {
    impl Checkpointed for Reactions {
        table: part,
    }
}
