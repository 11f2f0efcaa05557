//! Crack tips over time.

use std::sync::OnceLock;

use pericles::observe::{
    CrackTip, CrackTracker, Field, ObserveError, Observer, Snapshot, TrackedCrack,
};
use pericles::space::PointCloud;

use super::signals::Signals;
use super::table::{AXES, ObserverTable, TableTarget, step_and_time, whole};
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
    pub fn new(table: impl Into<TableTarget>, tracker: CrackTracker, dimension: usize) -> Self {
        let mut columns = step_and_time();
        columns.push(Column::integer("crack"));
        for axis in &AXES[..dimension] {
            columns.push(Column::real(format!("tip_{axis}"), "m"));
        }
        columns.push(Column::real("advance", "m"));
        columns.push(Column::integer("points"));
        Self {
            table: ObserverTable::new(table.into(), "observer/cracks", columns),
            tracker,
            dimension,
        }
    }
}

/// Returns the tips of the cracks; `None` until a crack has grown by one spacing, because points beside the pre-crack may
/// count as damaged from the start.
fn grown(
    tracker: &CrackTracker,
    cloud: &PointCloud,
    damage: &[f64],
) -> impl Iterator<Item = Option<CrackTip>> {
    let spacing = cloud.spacing();
    let tips = tracker.tips(cloud, damage).into_iter();
    tips.map(move |tip| tip.filter(|tip| tip.advance > spacing))
}

impl Observer for Cracks {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        self.table.touch(snapshot)?;
        let Some(damage) = snapshot.whole(Field::Damage) else {
            return Ok(());
        };
        let (state, cloud) = (snapshot.state(), snapshot.whole_cloud());
        let tips = grown(&self.tracker, cloud, &damage);
        for (tip, number) in tips.zip(1..) {
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

/// The tip of the crack that grows from each pre-crack: its reference position `crack_<number>_tip_<axis>` (m; NaN until
/// the crack has grown by one spacing) and its advance from the pre-crack `crack_<number>_advance` (m). Cracks are
/// numbered from 1 in the order of the deck.
pub struct CrackSignals {
    cracks: Vec<TrackedCrack>,
    threshold: f64,
    dimension: usize,
    /// Made at the first state, on the process that writes the results.
    tracker: OnceLock<CrackTracker>,
}

impl CrackSignals {
    /// Creates the signals of pre-cracks, for a body of the given dimension; points with a damage beyond the threshold
    /// belong to the cracks.
    pub fn new(cracks: Vec<TrackedCrack>, threshold: f64, dimension: usize) -> Self {
        Self {
            cracks,
            threshold,
            dimension,
            tracker: OnceLock::new(),
        }
    }

    fn tracker(&self, cloud: &PointCloud) -> std::result::Result<&CrackTracker, ObserveError> {
        match self.tracker.get() {
            Some(tracker) => Ok(tracker),
            None => {
                let made = CrackTracker::new(cloud, self.cracks.clone(), self.threshold)?;
                Ok(self.tracker.get_or_init(|| made))
            }
        }
    }
}

impl Signals for CrackSignals {
    fn columns(&self) -> Vec<Column> {
        let mut columns = Vec::new();
        for number in 1..=self.cracks.len() {
            for axis in &AXES[..self.dimension] {
                columns.push(Column::real(format!("crack_{number}_tip_{axis}"), "m"));
            }
            columns.push(Column::real(format!("crack_{number}_advance"), "m"));
        }
        columns
    }

    fn cells(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Vec<Cell>, ObserveError> {
        let width = self.dimension + 1;
        // The process that writes the results computes the tips and sends them to the others.
        let mut values = vec![f64::NEG_INFINITY; width * self.cracks.len()];
        if let Some(damage) = snapshot.whole(Field::Damage) {
            let cloud = snapshot.whole_cloud();
            let tips = grown(self.tracker(cloud)?, cloud, &damage);
            for (tip, values) in tips.zip(values.chunks_mut(width)) {
                for (c, value) in values[..self.dimension].iter_mut().enumerate() {
                    *value = tip.map_or(f64::NAN, |tip| tip.place[c]);
                }
                values[self.dimension] = tip.map_or(0.0, |tip| tip.advance);
            }
        }
        let domain = snapshot.system().domain();
        let values = values.into_iter();
        Ok(values.map(|value| domain.max(value).into()).collect())
    }
}
