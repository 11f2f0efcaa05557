//! What one exact step costs.

use std::sync::Arc;
use std::time::Instant;

use pericles::material::StressState;
use pericles::operator::LinearOperator;
use pericles::time::{Integrator, State};
use pericles::{PointScalar, System};
use pericles_run::RunError;
use pericles_waves::linear::SpectralForce;
use pericles_waves::{FunctionMethod, Trigonometric, TrigonometricOptions};

use super::line::{UNIT, cells_of, largest, march, pulse, system};
use super::paper::PAPER;
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(super) const STUDY: Study = Study {
    id: "nonlocal-wave/cost",
    paper: PAPER,
    title: "One exact step to T = 30: Chebyshev series, eigenvectors, plane waves (beyond the paper)",
    run,
};

const T: f64 = 30.0;

/// The state after one step, and the seconds that making the scheme and stepping took.
fn step(system: &mut System, functions: FunctionMethod) -> Result<(State, f64), RunError> {
    let began = Instant::now();
    let options = TrigonometricOptions {
        functions,
        ..Default::default()
    };
    let mut scheme: Box<dyn Integrator> = Box::new(Trigonometric::new(options, system)?);
    let mut state = pulse(&Arc::clone(system.cloud()), 1.0);
    march(system, &mut *scheme, &mut state, T, 1, |_, _| {})?;
    Ok((state, began.elapsed().as_secs_f64()))
}

fn run(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = Vec::new();
    let sizes: &[usize] = if context.full { &[501, 2001] } else { &[501] };
    for &n in sizes {
        let h = 20.0 / (n - 1) as f64;
        let cloud = Arc::new(cells_of(-10.0 - 0.5 * h, n as f64 * h, h)?);
        let mut body = system(&cloud, &UNIT.material())?;
        let (series, fast) = step(&mut body, FunctionMethod::Chebyshev)?;
        let (vectors, slow) = step(&mut body, FunctionMethod::Eigenvectors)?;
        let miss = largest(&series.u, &vectors.u, 0.0);
        let row = Row::new(
            format!("n = {n}: Chebyshev less eigenvectors"),
            "",
            Some(miss),
        );
        rows.push(row.within(0.0, 1e-12));
        rows.push(Row::new(
            format!("n = {n}: Chebyshev series"),
            "s",
            Some(fast),
        ));
        rows.push(Row::new(format!("n = {n}: eigenvectors"), "s", Some(slow)));
        let ratio = Row::new(
            format!("n = {n}: eigenvectors over series"),
            "",
            Some(slow / fast),
        );
        rows.push(ratio.note("wall time, of this machine and moment; n = 2001 with --full"));
    }
    // A million points: any time for a few transforms.
    let n = 1_000_000;
    let h = 1e-4;
    let cloud = Arc::new(cells_of(-50.0, n as f64 * h, h)?.with_periodic_faces()?);
    let material = UNIT.material();
    let constants = material.constants(&cloud, StressState::Uniaxial)?;
    let operator = SpectralForce::<1>::new(Arc::clone(&cloud), &material, &constants)?;
    let start = pulse(&cloud, 1.0);
    let mut out = vec![0.0; n];
    operator.apply_into(&start.u, &mut out);
    let began = Instant::now();
    operator.apply_into(&start.u, &mut out);
    let product = began.elapsed().as_secs_f64();
    let density = PointScalar::Uniform(material.density);
    let mut body = System::new(Arc::clone(&cloud), Box::new(operator), density)?;
    let (state, seconds) = step(&mut body, FunctionMethod::Fourier)?;
    let mirrored = state.u.iter().rev().copied().collect::<Vec<_>>();
    rows.push(
        Row::new(
            "a million points on a period: asymmetry",
            "",
            Some(largest(&state.u, &mirrored, 0.0)),
        )
        .within(0.0, 1e-11),
    );
    rows.push(Row::new(
        "a million points: one product",
        "s",
        Some(product),
    ));
    rows.push(Row::new("a million points: to T = 30", "s", Some(seconds)));
    rows.push(
        Row::new("a million points: to T = 30 over one product", "", Some(seconds / product))
            .note("two products (the forces at both ends), three transforms each for the functions of v and a"),
    );
    Ok(rows)
}
