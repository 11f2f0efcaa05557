//! Fragments over time.

use pericles::observe::{Fragments, ObserveError, Observer, Snapshot};
use pericles::units::BodyUnits;

use super::table::{ObserverTable, TableTarget, step_and_time, whole};
use crate::csv::Column;

/// Fragments, the pieces connected by intact bonds: `fragments.csv`.
///
/// One row per output. Columns: step, time, number of fragments, mass of the heaviest piece; number and mass
/// of pieces smaller than a fragment; number and mass of points without bonds.
pub struct FragmentCourse {
    table: ObserverTable,
    smallest: f64,
}

impl FragmentCourse {
    /// Creates the observer; a piece with at least the fraction `smallest` of the body's mass counts as a
    /// fragment.
    pub fn new(table: impl Into<TableTarget>, smallest: f64, units: BodyUnits) -> Self {
        let mass = || units.unit("kg");
        let mut columns = step_and_time();
        columns.push(Column::integer("fragments"));
        columns.push(Column::real("largest_mass", mass()));
        columns.push(Column::integer("small_pieces"));
        columns.push(Column::real("small_mass", mass()));
        columns.push(Column::integer("single_points"));
        columns.push(Column::real("single_mass", mass()));
        Self {
            table: ObserverTable::new(table.into(), "observer/fragments", columns),
            smallest,
        }
    }
}

impl Observer for FragmentCourse {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        let (state, system) = (snapshot.state(), snapshot.system());
        let count = Fragments::of(system.operator(), system.domain())
            .count(&system.masses()[..system.points()], self.smallest);
        self.table.append(
            snapshot,
            &[
                whole(state.step),
                state.t.into(),
                whole(count.fragments),
                count.largest.into(),
                whole(count.small),
                count.small_mass.into(),
                whole(count.single),
                count.single_mass.into(),
            ],
        )?;
        Ok(())
    }
}

pericles::saved! {
    impl Checkpointed for FragmentCourse {
        table: part,
        smallest: fixed,
    }
}
