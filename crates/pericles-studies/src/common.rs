//! Helpers shared by several topics.

use pericles::space::{Grid, PointCloud, Shape};
use pericles::{Control, Simulation};
use pericles_run::RunError;

/// Box of square or cubic cells.
pub(crate) fn cells(
    origin: [f64; 3],
    size: Vec<f64>,
    spacing: f64,
) -> Result<PointCloud, RunError> {
    let grid = Grid {
        shape: Shape::Box { origin, size },
        spacing,
        section: 1.0,
        holes: Vec::new(),
    };
    Ok(grid.points()?)
}

/// Runs a simulation to its end.
pub(crate) fn finish(simulation: &mut Simulation) -> Result<(), RunError> {
    watch(simulation, |_| ())
}

/// Runs a simulation to its end and calls the observer as often as the loop provides.
pub(crate) fn watch(
    simulation: &mut Simulation,
    mut look: impl FnMut(&Simulation),
) -> Result<(), RunError> {
    let run = simulation.run(|now| {
        look(now);
        Control::Continue
    });
    run.map_err(|error| RunError::of_run(error, || "the study was stopped".into()))?;
    Ok(())
}

/// Largest magnitude.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// Largest difference.
pub(crate) fn difference(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
