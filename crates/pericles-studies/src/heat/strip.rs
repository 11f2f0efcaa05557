//! Bending of a strip of two metals.

use pericles_run::RunError;

use super::ran;
use crate::data::{Case, Found};
use crate::decks::deck;

/// Half the length over which the curvature is measured, m.
const SPAN: f64 = 10e-3;

/// Curvature (1/m) of Timoshenko's beam of two layers of equal thickness h/2: moduli, expansion coefficients, h = 3 mm, 100 K.
fn timoshenko() -> f64 {
    let (ratio, difference, height, heating) = (210.0 / 70.0, 23e-6 - 12e-6, 3e-3, 100.0);
    24.0 * difference * heating / (height * (12.0 + (1.0 + ratio) * (1.0 + 1.0 / ratio)))
}

/// Curvature of the deck's strip around its middle, from the vertical displacements of a row of points next to the
/// interface, relative to Timoshenko's.
pub(super) fn curvature(case: &Case<'_>) -> Result<Found, RunError> {
    let run = ran(&deck(case, &[])?)?;
    let cloud = run.system().cloud();
    let (n, dx) = (cloud.len(), cloud.spacing());
    let [x, y] = [cloud.axis(0), cloud.axis(1)];
    let row = |&i: &usize| (0.0..dx).contains(&y[i]) && x[i].abs() < SPAN;
    let points: Vec<usize> = (0..n).filter(row).collect();
    // Least squares of u_y = a + b x + c x²; the places are symmetric about zero.
    let mean = |of: &dyn Fn(usize) -> f64| {
        points.iter().map(|&i| of(i)).sum::<f64>() / points.len() as f64
    };
    let u = |i: usize| run.state().u[n + i];
    let square = mean(&|i| x[i] * x[i]);
    let moment = mean(&|i| (x[i] * x[i] - square) * u(i));
    let spread = mean(&|i| (x[i] * x[i] - square).powi(2));
    let curvature = 2.0 * (moment / spread).abs();
    Ok(Found::default()
        .value("curvature", curvature)
        .value("ratio", curvature / timoshenko()))
}
