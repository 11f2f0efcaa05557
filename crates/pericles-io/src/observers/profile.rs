//! A field along a straight line.

use pericles::vector::norm;
use std::path::PathBuf;

use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::space::{Point, PointCloud};
use pericles::{PericlesError, Result};

use super::picture_of::PictureOf;
use crate::csv::{Cell, Column, CsvTable};
use crate::picture::{Axis, Curve, LineChart};

/// A known solution at a place (m) and time (s).
pub type Reference = Box<dyn Fn(Point, f64) -> f64 + Send>;

/// A field of the last state along a straight line: a table and a chart.
///
/// The points within half a spacing of the line count; those at the same distance from its beginning are averaged. Columns: distance from the beginning, the mean place, the field and, where there is one, the
/// known solution there.
pub struct Profile {
    table: PathBuf,
    chart: PathBuf,
    title: String,
    what: PictureOf,
    reference: Option<Reference>,
    stations: Vec<Station>,
}

/// Points at the same distance along the line.
struct Station {
    distance: f64,
    place: Point,
    points: Vec<u32>,
}

impl Profile {
    /// The profile of a field, or of one of its components, between two places; table and chart are files. The first of several
    /// processes, which writes them, passes the points of the whole body.
    ///
    /// # Errors
    /// A line that no point is near.
    pub fn new(
        [table, chart]: [PathBuf; 2],
        title: impl Into<String>,
        (field, component): (Field, Option<usize>),
        ends: [Point; 2],
        cloud: &PointCloud,
    ) -> Result<Self> {
        let stations = stations(cloud, ends);
        if stations.is_empty() && cloud.domain().is_first() {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of points on the line of a profile",
                value: 0.0,
                allowed: "at least one: points within half a spacing of the line count",
            });
        }
        Ok(Self {
            table,
            chart,
            title: title.into(),
            what: PictureOf {
                component,
                ..PictureOf::new(field)
            },
            reference: None,
            stations,
        })
    }

    /// The same beside a known solution.
    #[must_use]
    pub fn with_reference(self, reference: Reference) -> Self {
        Self {
            reference: Some(reference),
            ..self
        }
    }
}

/// Returns the chart of a field of this name and unit over the distance along a line, beside a known solution.
pub fn profile_chart(
    distances: &[f64],
    (name, unit): (&str, &str),
    values: &[f64],
    known: Option<&[f64]>,
) -> LineChart {
    let mut chart = LineChart::new(Axis::new("distance", "m"), Axis::new(name, unit));
    if let Some(known) = known {
        chart = chart.curve(Curve::line("reference", distances, known).dashed());
    }
    chart.curve(Curve::line(name.replace('_', " "), distances, values).with_markers())
}

/// The points within half a spacing of a line, by their distance from its beginning.
fn stations(cloud: &PointCloud, [from, to]: [Point; 2]) -> Vec<Station> {
    /// Positions are equal to rounding.
    const EQUAL: f64 = 1e-6;
    let line: Point = std::array::from_fn(|c| to[c] - from[c]);
    let length = norm(line);
    let direction = match length > 0.0 {
        true => line.map(|x| x / length),
        false => [0.0; 3],
    };
    let half = (0.5 + EQUAL) * cloud.spacing();
    let mut near: Vec<(f64, u32)> = (0..cloud.len() as u32)
        .filter_map(|i| {
            let place = cloud.point(i as usize);
            let arm: Point = std::array::from_fn(|c| place[c] - from[c]);
            let along: f64 = (0..3).map(|c| arm[c] * direction[c]).sum();
            let beside = norm(std::array::from_fn(|c| arm[c] - along * direction[c]));
            let within = along >= -half && along <= length + half && beside <= half;
            within.then_some((along, i))
        })
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut stations: Vec<Station> = Vec::new();
    for (distance, i) in near {
        match stations.last_mut() {
            Some(last) if distance - last.distance <= EQUAL * cloud.spacing() => {
                last.points.push(i);
            }
            _ => stations.push(Station {
                distance,
                place: [0.0; 3],
                points: vec![i],
            }),
        }
    }
    for station in &mut stations {
        let share = 1.0 / station.points.len() as f64;
        for &i in &station.points {
            let place = cloud.point(i as usize);
            (0..3).for_each(|c| station.place[c] += share * place[c]);
        }
    }
    stations
}

impl Observer for Profile {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        snapshot.check(self.what.field)?;
        let (system, t) = (snapshot.system(), snapshot.state().t);
        let Some(field) = snapshot.whole(self.what.field) else {
            return Ok(());
        };
        let name = self.what.name(system.dimension());
        let unit = self.what.field.unit();
        let numbers = self.what.numbers(&field, snapshot.whole_cloud().len());
        let mean = |station: &Station| {
            let sum: f64 = station.points.iter().map(|&i| numbers[i as usize]).sum();
            sum / station.points.len() as f64
        };
        let values: Vec<f64> = self.stations.iter().map(mean).collect();
        let known: Option<Vec<f64>> = self.reference.as_ref().map(|reference| {
            let places = self.stations.iter().map(|station| station.place);
            places.map(|place| reference(place, t)).collect()
        });
        let mut columns = vec![Column::real("distance", "m")];
        columns.extend(["x", "y", "z"].map(|axis| Column::real(axis, "m")));
        columns.push(Column::real(name.clone(), unit));
        if known.is_some() {
            columns.push(Column::real("reference", unit));
        }
        let mut table = CsvTable::create(&self.table, &columns)?;
        for (k, station) in self.stations.iter().enumerate() {
            let mut row = vec![Cell::Real(station.distance)];
            row.extend(station.place.map(Cell::Real));
            row.push(Cell::Real(values[k]));
            row.extend(known.iter().map(|known| Cell::Real(known[k])));
            table.append(&row)?;
        }
        table.flush()?;
        let distances: Vec<f64> = self.stations.iter().map(|one| one.distance).collect();
        let chart = profile_chart(&distances, (&name, unit), &values, known.as_deref());
        Ok(chart.title(&self.title).time(t).write(&self.chart)?)
    }
}

pericles::saved! {
    impl Checkpointed for Profile {
        table, chart, title, what, reference, stations: fixed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::space::{Grid, Shape};

    #[test]
    fn points_on_both_sides_of_a_line_are_one_station() {
        let shape = Shape::Box {
            origin: [0.0, -2.0, 0.0],
            size: vec![5.0, 4.0],
        };
        let grid = Grid {
            shape,
            spacing: 1.0,
            section: 1.0,
            holes: Vec::new(),
        };
        let cloud = grid.points().unwrap();
        let found = stations(&cloud, [[1.0, 0.0, 0.0], [4.0, 0.0, 0.0]]);
        let distances: Vec<f64> = found.iter().map(|station| station.distance).collect();
        assert_eq!(distances, [-0.5, 0.5, 1.5, 2.5, 3.5]);
        for station in &found {
            assert_eq!((station.points.len(), station.place[1]), (2, 0.0));
        }
        assert!(stations(&cloud, [[9.0, 9.0, 0.0], [10.0, 9.0, 0.0]]).is_empty());
    }
}
