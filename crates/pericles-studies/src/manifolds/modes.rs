//! The slowest vibration of a linear surface.

use pericles::System;
use pericles::solve::{SolveLimits, Work, conjugate_gradient};
use pericles_run::RunError;

/// The lowest eigenvalue ω² of −K/ρ for p = 2 on one component of the displacement that is orthogonal to translations: inverse iteration from the
/// coordinate x. On a sphere it is that of u = x, y, z: the body breathes.
pub(super) fn breathing(system: &System) -> Result<f64, RunError> {
    let n = system.points();
    let areas = system.cloud().volumes();
    let mass: Vec<f64> = (0..n).map(|i| system.density().at(i) * areas[i]).collect();
    let total: f64 = mass.iter().sum();
    let operator = system.operator();
    // Translations are lifted above the spectrum.
    let lift = operator
        .frequency_bound(&|i| system.density().at(i))
        .powi(2);
    let mut field = vec![0.0; 3 * n];
    let mut force = vec![0.0; 3 * n];
    let mut apply = |x: &[f64], out: &mut [f64]| {
        field[..n].copy_from_slice(x);
        operator.tangent_into(0.0, &field, &field, &mut force);
        let mean = x.iter().zip(&mass).map(|(x, m)| x * m).sum::<f64>() / total;
        for i in 0..n {
            out[i] = lift * mean * mass[i] - areas[i] * force[i];
        }
    };
    let inner = |x: &[f64], y: &[f64]| -> f64 { (0..n).map(|i| mass[i] * x[i] * y[i]).sum() };
    let mut vector = system.cloud().axis(0).to_vec();
    let mut work = Work::new(n);
    let limits = SolveLimits {
        relative: 1e-10,
        ..SolveLimits::default()
    };
    let mut value = f64::NAN;
    for _ in 0..MOST {
        let right: Vec<f64> = vector.iter().zip(&mass).map(|(x, m)| x * m).collect();
        let mut next = vector.clone();
        conjugate_gradient(&mut apply, &right, &mut next, &limits, &mut work)
            .map_err(|error| RunError::Simulation(error.into()))?;
        let before = value;
        value = inner(&next, &vector) / inner(&next, &next);
        let size = inner(&next, &next).sqrt();
        vector = next.iter().map(|x| x / size).collect();
        if (value - before).abs() < 1e-9 * value {
            break;
        }
    }
    Ok(value)
}

/// Inverse iterations.
const MOST: usize = 40;
