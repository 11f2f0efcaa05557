//! Crack tips over time.

use std::path::PathBuf;

use pericles::observe::{CrackTracker, Field, ObserveError, Observer, Snapshot};

use super::table::{AXES, ObserverTable, step_and_time, whole};
use crate::csv::{Cell, Column};

/// Tip of the crack that grows from each pre-crack: `cracks.csv`.
///
/// One row per crack and output. Columns: step, time, crack (numbered from 1 in the order of the deck),
/// reference position of the tip, its advance from the pre-crack, number of points of the crack. Until the
/// crack has grown by one spacing, the position is empty and the advance is zero, because points beside the
/// pre-crack may count as damaged from the start.
pub struct Cracks {
    table: ObserverTable,
    tracker: CrackTracker,
    dimension: usize,
}

impl Cracks {
    /// Creates the observer from a tracker, for a body of the given dimension.
    pub fn new(path: impl Into<PathBuf>, tracker: CrackTracker, dimension: usize) -> Self {
        let mut columns = step_and_time();
        columns.push(Column::integer("crack"));
        for axis in &AXES[..dimension] {
            columns.push(Column::real(format!("tip_{axis}"), "m"));
        }
        columns.push(Column::real("advance", "m"));
        columns.push(Column::integer("points"));
        Self {
            table: ObserverTable::new(path.into(), "observer/cracks", columns),
            tracker,
            dimension,
        }
    }
}

impl Observer for Cracks {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        self.table.touch(snapshot)?;
        let Some(damage) = snapshot.whole(Field::Damage) else {
            return Ok(());
        };
        let (state, cloud) = (snapshot.state(), snapshot.whole_cloud());
        let tips = self.tracker.tips(cloud, &damage);
        for (tip, number) in tips.into_iter().zip(1..) {
            let tip = tip.filter(|tip| tip.advance > cloud.spacing());
            let mut row = vec![whole(state.step), state.t.into(), whole(number)];
            for c in 0..self.dimension {
                row.push(Cell::Real(tip.map_or(f64::NAN, |tip| tip.place[c])));
            }
            row.push(tip.map_or(0.0, |tip| tip.advance).into());
            row.push(whole(tip.map_or(0, |tip| tip.points as u64)));
            self.table.append(snapshot, &row)?;
        }
        Ok(())
    }
}

pericles::saved! {
    impl Checkpointed for Cracks {
        table: part,
        tracker, dimension: fixed,
    }
}
