//! Highest frequency of bodies: estimate and bound compared with dense eigenvalues, and the plane-wave bound of
//! large bodies.

use nalgebra::DMatrix;
use pericles::System;
use pericles_run::{Resources, RunError, build};

use crate::data::{Case, Found};
use crate::decks::deck;

/// Ratios of the estimate and the bound of the highest frequency to the exact value or, for a body too `large` for
/// a dense matrix, of the bound to the estimate; and products with the matrix.
pub(super) fn highest_frequency(case: &Case<'_>) -> Result<Found, RunError> {
    let assembly = build(&deck(case, &[])?, &Resources::default())?;
    let found = assembly.body_frequency;
    let result = Found::default().value("products", found.map(|found| found.applications as f64));
    if case.flag("large") {
        let ratio = found.map(|found| found.bound / found.estimate);
        return Ok(result.value("bound", ratio));
    }
    let truth = largest_eigenvalue(&assembly.system, &assembly.state.u).sqrt();
    Ok(result
        .value("estimate", found.map(|found| found.estimate / truth))
        .value("bound", found.map(|found| found.bound / truth)))
}

/// Largest eigenvalue of M^-1/2 K M^-1/2, with its columns computed one by one.
fn largest_eigenvalue(system: &System, u: &[f64]) -> f64 {
    let roots: Vec<f64> = system.masses().iter().map(|mass| mass.sqrt()).collect();
    let n = roots.len();
    let mut matrix = DMatrix::zeros(n, n);
    let (mut unit, mut column) = (vec![0.0; n], vec![0.0; n]);
    for k in 0..n {
        unit[k] = 1.0;
        system.hold(&mut unit);
        system.vibration_into(u, &unit, &mut column);
        unit[k] = 0.0;
        for i in 0..n {
            matrix[(i, k)] = roots[i] * column[i] / roots[k];
        }
    }
    let matrix = 0.5 * (&matrix + matrix.transpose());
    matrix.symmetric_eigenvalues().max()
}
