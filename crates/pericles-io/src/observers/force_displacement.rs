//! Force–displacement curve of static states.

use std::path::PathBuf;

use pericles::boundary::PrescribedMotion;
use pericles::observe::{ObserveError, Observer, Snapshot};

use super::table::{AXES, ObserverTable, step_and_time, whole};
use crate::csv::{Cell, Column, read_csv};
use crate::error::IoError;
use crate::picture::{Axis, Curve, LineChart};

/// Mean displacement and force of each prescribed motion along each of its axes: `force_displacement.csv`,
/// and a chart `force_displacement.png` at the end of the run.
///
/// Columns: step, time, then `<name>_displacement_<axis>` in metres and `<name>_force_<axis>` in newtons. The
/// force is that of the support on the body. Displacements are taken from the body, so that they are correct
/// if a scheme scales the prescribed values. The chart shows the motions whose displacement changes.
pub struct ForceDisplacement {
    table: ObserverTable,
    path: PathBuf,
    chart: PathBuf,
    title: String,
    /// Name and axis of each pair of columns.
    pairs: Vec<(String, usize)>,
}

impl ForceDisplacement {
    /// Creates the observer for a system with these motions, which must be those of the system; `table` and
    /// `chart` are file paths.
    pub fn new(
        table: impl Into<PathBuf>,
        chart: impl Into<PathBuf>,
        title: impl Into<String>,
        motions: &[PrescribedMotion],
    ) -> Self {
        let path = table.into();
        let mut columns = step_and_time();
        let mut pairs = Vec::new();
        for motion in motions {
            for axis in motion.axes() {
                let [displacement, force] = names(&motion.name, axis);
                columns.push(Column::real(displacement, "m"));
                columns.push(Column::real(force, "N"));
                pairs.push((motion.name.clone(), axis));
            }
        }
        Self {
            table: ObserverTable::new(path.clone(), "observer/force_displacement", columns),
            path,
            chart: chart.into(),
            title: title.into(),
            pairs,
        }
    }

    /// Draws the chart from the table.
    fn draw(&self) -> Result<(), IoError> {
        if !self.path.exists() {
            return Ok(());
        }
        let table = read_csv(&self.path)?;
        let column = |name: &str| table.column(name).unwrap_or_default();
        let axes = (Axis::new("displacement", "m"), Axis::new("force", "N"));
        let mut chart = LineChart::new(axes.0, axes.1).title(&self.title);
        let mut curves = 0;
        for (name, axis) in &self.pairs {
            let [displacement, force] = names(name, *axis);
            let (x, y) = (column(&displacement), column(&force));
            let moves = x.iter().any(|u| *u != x[0]);
            if moves {
                let label = format!("{} {}", name.replace('_', " "), AXES[*axis]);
                chart = chart.curve(Curve::line(label, x, y).with_markers());
                curves += 1;
            }
        }
        match curves {
            0 => Ok(()),
            _ => chart.write(&self.chart),
        }
    }
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
        for motion in system.motions() {
            let (points, force) = (&motion.points, motion.reaction(system.cloud()));
            for axis in motion.axes() {
                let sum = domain.sum(points.len(), |k| state.u[axis * n + points[k] as usize]);
                row.push(Cell::Real(sum / points.len() as f64));
                row.push(Cell::Real(force[axis]));
            }
        }
        Ok(self.table.append(&row)?)
    }

    fn finish(&mut self) -> std::result::Result<(), ObserveError> {
        Ok(self.draw()?)
    }
}

pericles::saved! {
    impl Checkpointed for ForceDisplacement {
        table: part,
        path, chart, title, pairs: fixed,
    }
}
