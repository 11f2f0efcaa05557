//! Table 4 and figures 3 and 4: spectral method on a periodic domain.

use std::f64::consts::PI;
use std::sync::Arc;

use pericles::material::StressState;
use pericles::space::PointCloud;
use pericles::time::State;
use pericles::{PointScalar, System};
use pericles_run::RunError;
use pericles_waves::exact::ExactSolution;
use pericles_waves::linear::SpectralForce;
use pericles_waves::{Trigonometric, TrigonometricOptions};

use super::line::{LINE, UNIT, cells_of, march, pulse};
use crate::common::largest;
use crate::data::{Case, Found};

const T: f64 = 3.5;

/// Period 2πM with n points, one of them at −πM.
fn ring(half_periods: f64, n: usize) -> Result<Arc<PointCloud>, RunError> {
    let period = 2.0 * PI * half_periods;
    let h = period / n as f64;
    let cells = cells_of(-0.5 * (period + h), period, h)?;
    Ok(Arc::new(cells.with_periodic_faces()?))
}

/// Pulse at time t, computed in one step.
fn displacement(cloud: &Arc<PointCloud>, t: f64) -> Result<State, RunError> {
    let material = UNIT.material();
    let constants = material.constants(cloud, StressState::Uniaxial)?;
    let operator = SpectralForce::<1>::new(Arc::clone(cloud), &material, &constants)?;
    let density = PointScalar::Uniform(material.density);
    let mut system = System::new(Arc::clone(cloud), Box::new(operator), density)?;
    let mut scheme = Trigonometric::new(TrigonometricOptions::default(), &system)?;
    let mut state = pulse(cloud);
    march(&mut system, &mut scheme, &mut state, t, 1, |_, _| {})?;
    Ok(state)
}

/// Errors on [−π, π], or with `everywhere` on the whole period of 2π · `half_periods`: the largest relative to the
/// largest computed displacement, and Σe²/Σu².
pub(super) fn error(case: &Case<'_>) -> Result<Found, RunError> {
    let window = if case.flag("everywhere") {
        f64::INFINITY
    } else {
        PI
    };
    let cloud = ring(case.number("half_periods")?, case.count("n")?)?;
    let state = displacement(&cloud, T)?;
    let inside = |i: &usize| cloud.axis(0)[*i].abs() <= window * (1.0 + 1e-12);
    let points: Vec<usize> = (0..cloud.len()).filter(inside).collect();
    let x: Vec<f64> = points.iter().map(|&i| cloud.axis(0)[i]).collect();
    let mut exact = vec![0.0; x.len()];
    LINE.displacement_into(T, &x, &mut exact);
    let computed: Vec<f64> = points.iter().map(|&i| state.u[i]).collect();
    let pairs = computed.iter().zip(&exact);
    let difference: Vec<f64> = pairs.map(|(computed, exact)| computed - exact).collect();
    let squares = |values: &[f64]| values.iter().map(|u| u * u).sum::<f64>();
    let shown: Vec<f64> = difference.iter().map(|e| e.abs().max(1e-17)).collect();
    Ok(Found::from([
        ("largest", largest(&difference) / largest(&computed)),
        ("squares", squares(&difference) / squares(&exact)),
    ])
    .curve("error", &x, &shown))
}

/// Figure 3: largest error on [−π, π] at six times.
pub(super) fn period(_: &Case<'_>) -> Result<Found, RunError> {
    let cloud = ring(2.5, 320)?;
    let x = cloud.axis(0).to_vec();
    let mut found = Found::default();
    let mut worst = 0.0f64;
    for t in [0.5, 1.0, 1.5, 2.0, 2.5, 3.0] {
        let state = displacement(&cloud, t)?;
        found = found.labelled("spectral", Some(format!("t = {t}")), &x, &state.u);
        let mut exact = vec![0.0; x.len()];
        LINE.displacement_into(t, &x, &mut exact);
        let inside = (0..x.len()).filter(|&i| x[i].abs() <= PI);
        worst = inside.fold(worst, |m, i| m.max((state.u[i] - exact[i]).abs()));
    }
    Ok(found.value("value", worst))
}
