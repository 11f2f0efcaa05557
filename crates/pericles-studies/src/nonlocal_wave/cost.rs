//! Cost of one exact step.

use std::sync::Arc;
use std::time::Instant;

use pericles::material::StressState;
use pericles::operator::LinearOperator;
use pericles::time::{Integrator, State};
use pericles::{PointScalar, System};
use pericles_run::RunError;
use pericles_waves::linear::SpectralForce;
use pericles_waves::{FunctionMethod, Trigonometric, TrigonometricOptions};

use super::line::{UNIT, cells_of, march, pulse, system};
use crate::common::difference;
use crate::data::{Case, Found};

const T: f64 = 30.0;

/// State after one step, and the time for creating the scheme and stepping, s.
fn step(system: &mut System, functions: FunctionMethod) -> Result<(State, f64), RunError> {
    let began = Instant::now();
    let options = TrigonometricOptions {
        functions,
        ..Default::default()
    };
    let mut scheme: Box<dyn Integrator> = Box::new(Trigonometric::new(options, system)?);
    let mut state = pulse(system.cloud());
    march(system, &mut *scheme, &mut state, T, 1, |_, _| {})?;
    Ok((state, began.elapsed().as_secs_f64()))
}

/// Chebyshev series compared with eigenvectors on n points: their difference, and their times in seconds.
pub(super) fn cost(case: &Case<'_>) -> Result<Found, RunError> {
    let n = case.number("n")?;
    let h = 20.0 / (n - 1.0);
    let cloud = Arc::new(cells_of(-10.0 - 0.5 * h, n * h, h)?);
    let mut body = system(&cloud, &UNIT.material())?;
    let (series, fast) = step(&mut body, FunctionMethod::Chebyshev)?;
    let (vectors, slow) = step(&mut body, FunctionMethod::Eigenvectors)?;
    Ok([
        ("difference", difference(&series.u, &vectors.u)),
        ("series", fast),
        ("eigenvectors", slow),
    ]
    .into())
}

/// A million points in a period: any time for a few transforms.
pub(super) fn million_points(_: &Case<'_>) -> Result<Found, RunError> {
    let n = 1_000_000;
    let h = 1e-4;
    let cloud = Arc::new(cells_of(-50.0, n as f64 * h, h)?.with_periodic_faces()?);
    let material = UNIT.material();
    let constants = material.constants(&cloud, StressState::Uniaxial)?;
    let operator = SpectralForce::<1>::new(Arc::clone(&cloud), &material, &constants)?;
    let start = pulse(&cloud);
    let mut out = vec![0.0; n];
    operator.apply_into(&start.u, &mut out);
    let began = Instant::now();
    operator.apply_into(&start.u, &mut out);
    let product = began.elapsed().as_secs_f64();
    let density = PointScalar::Uniform(material.density);
    let mut body = System::new(Arc::clone(&cloud), Box::new(operator), density)?;
    let (state, seconds) = step(&mut body, FunctionMethod::Fourier)?;
    let mirrored = state.u.iter().rev().copied().collect::<Vec<_>>();
    Ok([
        ("asymmetry", difference(&state.u, &mirrored)),
        ("product", product),
        ("seconds", seconds),
    ]
    .into())
}
