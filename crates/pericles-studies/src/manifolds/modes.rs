//! Lowest natural mode of a linear surface.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::sync::{Mutex, MutexGuard, PoisonError};

use pericles::cache::{Cache, Key};
use pericles::solve::{SolveLimits, Work, conjugate_gradient};
use pericles::time::highest_frequency;
use pericles::{Archive, System};
use pericles_run::{Assembly, Resources, RunError, build};

use crate::data::{Case, Found};
use crate::decks::deck;

/// Distances do not depend on α: they are computed once per mesh.
#[derive(Default)]
struct Kept(Mutex<HashMap<String, Archive>>);

impl Kept {
    fn arrays(&self) -> MutexGuard<'_, HashMap<String, Archive>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Cache for Kept {
    fn load(&self, key: &Key) -> Option<Archive> {
        self.arrays().get(&key.digest()).cloned()
    }

    fn store(&self, key: &Key, arrays: &Archive) {
        self.arrays().insert(key.digest(), arrays.clone());
    }
}

fn assembly(case: &Case<'_>) -> Result<Assembly, RunError> {
    let kept = case.once("distances".into(), || Ok(Kept::default()))?;
    let resources = Resources {
        cache: &*kept,
        ..Resources::default()
    };
    Ok(build(&deck(case, &[])?, &resources)?)
}

/// Ratio of the lowest eigenvalue to that of the `continuum`, if given, and the corresponding period.
pub(super) fn breathing(case: &Case<'_>) -> Result<Found, RunError> {
    let eigenvalue = lowest_eigenvalue(&assembly(case)?.system)?;
    let over = eigenvalue / case.optional("continuum").unwrap_or(1.0);
    Ok([("eigenvalue", over), ("period", TAU / eigenvalue.sqrt())].into())
}

/// Estimate of the highest frequency.
pub(super) fn highest(case: &Case<'_>) -> Result<Found, RunError> {
    let assembly = assembly(case)?;
    let omega = highest_frequency(&assembly.system, &assembly.state.u)?;
    Ok(omega.estimate.into())
}

/// Rayleigh quotient ∫ u·(−K u)/∫ |u|² of u = x, relative to that of the `continuum`.
pub(super) fn quotient(case: &Case<'_>) -> Result<Found, RunError> {
    let system = assembly(case)?.system;
    let n = system.points();
    let mut u = system.cloud().positions().to_vec();
    u[n..].fill(0.0);
    let mut force = vec![0.0; 3 * n];
    system.operator().tangent_into(0.0, &u, &u, &mut force);
    let areas = system.cloud().volumes();
    let inner = |f: &[f64]| -> f64 { (0..n).map(|i| areas[i] * u[i] * f[i]).sum() };
    Ok((-inner(&force) / inner(&u) / case.number("continuum")?).into())
}

/// Lowest eigenvalue ω² of −K/ρ for p = 2 on one displacement component orthogonal to translations, by inverse
/// iteration from the coordinate x. On a sphere it belongs to u = x, y, z, the breathing mode.
fn lowest_eigenvalue(system: &System) -> Result<f64, RunError> {
    let n = system.points();
    let areas = system.cloud().volumes();
    let mass: Vec<f64> = (0..n).map(|i| system.density().at(i) * areas[i]).collect();
    let total: f64 = mass.iter().sum();
    let operator = system.operator();
    // Translations are shifted above the spectrum.
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

/// Largest number of inverse iterations.
const MOST: usize = 40;
