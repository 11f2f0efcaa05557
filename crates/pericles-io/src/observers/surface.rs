//! Measures of a surface over time.

use pericles::observe::{ObserveError, Observer, Snapshot};
use pericles_manifold::{EnergyBound, SurfaceMeasure};

use super::table::{AXES, ObserverTable, TableTarget, step_and_time, whole};
use crate::csv::{Cell, Column};

const KEY: &str = "observer/surface/bound";

/// Stretch of a surface, margin of the energy bound, localisation of elastic energy: `surface.csv`.
///
/// Columns: step, time, stretch S/S₀ − 1, margin √E(0) + ∫‖b‖/√(2ρ) − √E(t), localisation (maximum energy
/// density over its mean), fraction of the energy in the top 2 % of vertices, number of zones of concentrated
/// energy, area and centre of the largest, inverted triangles, edges stretched beyond twice their length.
pub struct SurfaceCourse {
    table: ObserverTable,
    measure: SurfaceMeasure,
    bound: EnergyBound,
}

impl SurfaceCourse {
    /// Creates the observer of a surface.
    pub fn new(table: impl Into<TableTarget>, measure: SurfaceMeasure) -> Self {
        let mut columns = step_and_time();
        columns.push(Column::real("stretch", ""));
        columns.push(Column::real("bound_margin", "J^0.5"));
        columns.push(Column::real("localisation", ""));
        columns.push(Column::real("top_share", ""));
        columns.push(Column::integer("zones"));
        columns.push(Column::real("zone_area", "m2"));
        for axis in AXES {
            columns.push(Column::real(format!("zone_{axis}"), "m"));
        }
        columns.push(Column::integer("inverted_triangles"));
        columns.push(Column::integer("overstretched_edges"));
        Self {
            table: ObserverTable::new(table.into(), "observer/surface", columns),
            measure,
            bound: EnergyBound::default(),
        }
    }
}

impl Observer for SurfaceCourse {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        let state = snapshot.state();
        let reading = self.measure.read(snapshot);
        let margin = self.bound.margin(snapshot);
        let (area, centre) = reading
            .zones
            .first()
            .map_or((0.0, [f64::NAN; 3]), |zone| (zone.area, zone.centre));
        let mut row = vec![
            whole(state.step),
            state.t.into(),
            reading.stretch.into(),
            margin.into(),
            reading.localisation.into(),
            reading.top_share.into(),
            whole(reading.zones.len() as u64),
            area.into(),
        ];
        row.extend(centre.map(Cell::Real));
        row.push(whole(reading.inverted_triangles as u64));
        row.push(whole(reading.overstretched_edges as u64));
        Ok(self.table.append(snapshot, &row)?)
    }
}

pericles::saved! {
    impl Checkpointed for SurfaceCourse {
        table: part,
        bound: array("{KEY}"),
        measure: fixed,
    }
}
