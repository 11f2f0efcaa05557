//! Distance from a known solution over time.

use std::path::PathBuf;

use pericles::analysis::exact::{ExactSolution, Miss};
use pericles::observe::{ObserveError, Observer, Snapshot};
use pericles::space::PointSet;
use pericles::{Archive, Result, Saved, Values};

use super::table::{ObserverTable, step_and_time, whole};
use crate::csv::Column;

/// Errors of the displacement of a bar: `errors.csv`.
///
/// Columns: step, time, the largest error over the points that count (m), the largest of that so far, and the root mean square error over that of the solution.
pub struct Errors {
    table: ObserverTable,
    solution: Box<dyn ExactSolution>,
    points: PointSet,
    largest: f64,
}

impl Errors {
    /// Errors against a solution, at some points.
    pub fn new(
        path: impl Into<PathBuf>,
        solution: Box<dyn ExactSolution>,
        points: PointSet,
    ) -> Self {
        let mut columns = step_and_time();
        columns.push(Column::real("error", "m"));
        columns.push(Column::real("error_so_far", "m"));
        columns.push(Column::real("error_relative", "1"));
        Self {
            table: ObserverTable::new(path.into(), "observer/errors", columns),
            solution,
            points,
            largest: 0.0,
        }
    }
}

impl Observer for Errors {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        let state = snapshot.state();
        let x = snapshot.system().cloud().axis(0);
        let pick = |field: &[f64]| -> Vec<f64> {
            self.points.iter().map(|&i| field[i as usize]).collect()
        };
        let (places, computed) = (pick(x), pick(&state.u));
        let mut exact = vec![0.0; places.len()];
        self.solution
            .displacement_into(state.t, &places, &mut exact);
        let miss = Miss::between(&computed, &exact);
        self.largest = if miss.largest.is_nan() {
            f64::NAN
        } else {
            self.largest.max(miss.largest)
        };
        let row = [
            whole(state.step),
            state.t.into(),
            miss.largest.into(),
            self.largest.into(),
            miss.relative.into(),
        ];
        Ok(self.table.append(&row)?)
    }
}

impl Saved for Errors {
    fn save(&self, archive: &mut Archive) {
        self.table.save(archive);
        archive.put("observer/errors/largest", Values::F64(vec![self.largest]));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        self.table.restore(archive)?;
        archive.f64_into(
            "observer/errors/largest",
            std::slice::from_mut(&mut self.largest),
        )
    }
}
