//! Force–displacement curve of static states.

use pericles::System;
use pericles::observe::{ObserveError, Observer, Snapshot};

use super::table::{AXES, ObserverTable, TableTarget, step_and_time, whole};
use crate::csv::{Cell, Column, read_csv};
use crate::error::IoError;
use crate::picture::{Axis, Curve, LineChart};

/// Mean displacement and force of each prescribed motion along each of its axes, and of each loaded set along the
/// other axes: `force_displacement.csv`, and a chart `force_displacement.png` at the end of the run.
///
/// Columns: step, time, then `<name>_displacement_<axis>` in metres and `<name>_force_<axis>` in newtons. The
/// force acts from the support or load on the body. Displacements are taken from the body, so that they are correct
/// if a scheme scales the prescribed values. The chart shows the motions whose displacement changes. If the scheme finds
/// the loads of each breaking bond, the displacement may decrease from one state to the next (snap-back), which no test with
/// increasing displacement shows: the chart then shows the states whose displacement exceeds all earlier ones, and the whole
/// path in grey.
pub struct ForceDisplacement {
    table: ObserverTable,
    title: String,
    pairs: Vec<Pair>,
    unit: String,
    is_event_driven: bool,
}

/// A pair of columns.
#[derive(Debug, Clone)]
struct Pair {
    name: String,
    axis: usize,
    force: Acting,
}

/// Source of a force.
#[derive(Debug, Clone)]
enum Acting {
    /// A prescribed motion.
    Support(usize),
    /// Loads on the same points.
    Loads(Vec<usize>),
}

impl ForceDisplacement {
    /// Creates the observer for a system; `loaded` are the names of the sets on which its loads act, in the order of
    /// the loads. The chart is drawn beside a table in a file, with the ending `png`.
    pub fn new(
        table: impl Into<TableTarget>,
        title: impl Into<String>,
        system: &System,
        loaded: &[String],
    ) -> Self {
        let pairs = pairs(system, loaded);
        let unit = system.cloud().body_units().unit("N");
        let mut columns = step_and_time();
        for pair in &pairs {
            let [displacement, force] = names(&pair.name, pair.axis);
            columns.push(Column::real(displacement, "m"));
            columns.push(Column::real(force, unit.as_str()));
        }
        Self {
            table: ObserverTable::new(table.into(), "observer/force_displacement", columns),
            title: title.into(),
            pairs,
            unit,
            is_event_driven: false,
        }
    }

    /// Marks the states as those in which bonds break, at loads that the scheme finds.
    #[must_use]
    pub fn event_driven(mut self) -> Self {
        self.is_event_driven = true;
        self
    }

    /// Draws the chart from the table.
    fn draw(&self) -> Result<(), IoError> {
        let Some(path) = self.table.written() else {
            return Ok(());
        };
        let table = read_csv(path)?;
        let column = |name: &str| table.column(name).unwrap_or_default();
        let axes = (
            Axis::new("displacement", "m"),
            Axis::new("force", self.unit.as_str()),
        );
        let mut chart = LineChart::new(axes.0, axes.1).title(&self.title);
        let (mut curves, mut has_path) = (0, false);
        for Pair { name, axis, .. } in &self.pairs {
            let [displacement, force] = names(name, *axis);
            let (x, y) = (column(&displacement), column(&force));
            if x.iter().all(|u| *u == x[0]) {
                continue;
            }
            let outer = match self.is_event_driven {
                true => envelope(x),
                false => (0..x.len()).collect(),
            };
            if outer.len() < x.len() {
                let label = if has_path { "" } else { "all states" };
                chart = chart.curve(Curve::line(label, x, y).colour(PATH));
                has_path = true;
            }
            let [x, y] =
                [x, y].map(|column| -> Vec<f64> { outer.iter().map(|&k| column[k]).collect() });
            let label = format!("{} {}", name.replace('_', " "), AXES[*axis]);
            chart = chart.curve(Curve::line(label, &x, &y).with_markers());
            curves += 1;
        }
        match curves {
            0 => Ok(()),
            _ => chart.write(path.with_extension("png")),
        }
    }
}

/// Colour of the path through all states.
const PATH: [u8; 3] = [176, 176, 176];

/// Returns the states whose displacement is at least that of all earlier ones, in magnitude.
fn envelope(displacements: &[f64]) -> Vec<usize> {
    let mut largest = 0.0;
    let mut outer = Vec::new();
    for (k, u) in displacements.iter().enumerate() {
        if u.abs() >= largest {
            largest = u.abs();
            outer.push(k);
        }
    }
    outer
}

fn pairs(system: &System, loaded: &[String]) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for (k, motion) in system.motions().iter().enumerate() {
        pairs.extend(motion.axes().map(|axis| Pair {
            name: motion.name.clone(),
            axis,
            force: Acting::Support(k),
        }));
    }
    for (k, (load, name)) in system.loads().iter().zip(loaded).enumerate() {
        for axis in (0..system.dimension()).filter(|&axis| !load.is_free_of(axis)) {
            let same = |pair: &&mut Pair| pair.name == *name && pair.axis == axis;
            match pairs.iter_mut().find(same).map(|pair| &mut pair.force) {
                Some(Acting::Loads(loads)) => loads.push(k),
                // Loads on constrained components change the reactions only.
                Some(Acting::Support(_)) => {}
                None => pairs.push(Pair {
                    name: name.clone(),
                    axis,
                    force: Acting::Loads(vec![k]),
                }),
            }
        }
    }
    pairs
}

/// Returns the names of the displacement and force columns.
fn names(motion: &str, axis: usize) -> [String; 2] {
    ["displacement", "force"].map(|what| format!("{motion}_{what}_{}", AXES[axis]))
}

impl Observer for ForceDisplacement {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        let (state, system) = (snapshot.state(), snapshot.system());
        let mut row = vec![whole(state.step), state.t.into()];
        let (n, domain) = (system.points(), system.domain());
        for pair in &self.pairs {
            let (points, force) = match &pair.force {
                Acting::Support(k) => {
                    let motion = &system.motions()[*k];
                    (&motion.points, motion.reaction(system.cloud())[pair.axis])
                }
                // A static run starts from the body without loads, constant ones too.
                Acting::Loads(loads) if state.step == 0 => (&system.loads()[loads[0]].points, 0.0),
                Acting::Loads(loads) => {
                    let forces = loads.iter().map(|&k| system.load_resultant(k, state.t));
                    let force: f64 = forces.map(|force| force[pair.axis]).sum();
                    (&system.loads()[loads[0]].points, force)
                }
            };
            let entry = |k: usize| pair.axis * n + points[k] as usize;
            let sum = domain.sum(points.len(), |k| state.u[entry(k)]);
            let points = domain.count(points.len() as u64);
            row.push(Cell::Real(sum / points as f64));
            row.push(Cell::Real(force));
        }
        Ok(self.table.append(snapshot, &row)?)
    }

    fn finish(&mut self) -> std::result::Result<(), ObserveError> {
        Ok(self.draw()?)
    }
}

pericles::saved! {
    impl Checkpointed for ForceDisplacement {
        table: part,
        title, pairs, unit, is_event_driven: fixed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn envelope_of_a_snap_back_has_growing_displacements() {
        assert_eq!(envelope(&[0.0, 1.0, 0.6, 0.9, 1.2, 1.2]), [0, 1, 4, 5]);
        assert_eq!(envelope(&[0.0, -1.0, -0.5, -2.0]), [0, 1, 3]);
    }
}
