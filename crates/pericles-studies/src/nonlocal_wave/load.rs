//! Quadratures of loads that vary within a step of the trigonometric scheme.

use std::f64::consts::PI;
use std::rc::Rc;

use nalgebra::{DMatrix, DVector};
use pericles::System;
use pericles::boundary::{Load, TimeFunction};
use pericles::operator::PointSubset;
use pericles::time::State;
use pericles_run::RunError;
use pericles_waves::{LoadRule, Trigonometric, TrigonometricOptions};

use super::line::{Method, UNIT, march, nodes, system};
use crate::common::difference;
use crate::data::{Case, Found};

const END: f64 = 3.0;
/// Duration of the pulse of the load, which acts beyond the end.
const DURATION: f64 = 4.0;
const H: f64 = 0.1;

/// Force density of the load at the nodes without its time function.
fn density(x: f64) -> f64 {
    0.5 * f64::from(u8::from(x.abs() < 1.0))
}

fn body() -> Result<System, RunError> {
    let cloud = nodes(Method::Mt(None), H)?;
    let mut body = system(&cloud, &UNIT.material())?;
    let amplitude: Vec<f64> = cloud.axis(0).iter().map(|&x| density(x)).collect();
    let pulse = TimeFunction::Pulse {
        start: 0.0,
        duration: DURATION,
    };
    let all = (0..cloud.len() as u32).collect();
    let amplitude = pericles::boundary::LoadDensity::PerPoint(amplitude);
    body.add_load(Load::new(all, amplitude, pulse))?;
    Ok(body)
}

/// Exact displacement at the end from rest: a mode of frequency ω with the load b sin²(Ωt/2) per mass moves by
/// (b/2) [(1 − cos ωt)/ω² − (cos Ωt − cos ωt)/(ω² − Ω²)].
fn exact() -> Result<Vec<f64>, RunError> {
    let body = body()?;
    let n = body.points();
    let mut stiffness = DMatrix::zeros(n, n);
    for k in 0..n {
        let mut unit = vec![0.0; n];
        unit[k] = 1.0;
        let mut force = vec![0.0; n];
        let operator = body.operator();
        operator.add_force(0.0, &unit, PointSubset::All, &mut force);
        stiffness.set_column(k, &-DVector::from_vec(force));
    }
    let cloud = body.cloud();
    let load = DVector::from_iterator(n, cloud.axis(0).iter().map(|&x| density(x)));
    let modes = stiffness.symmetric_eigen();
    let forced = 2.0 * PI / DURATION;
    let mut u = DVector::zeros(n);
    for (vector, square) in modes.eigenvectors.column_iter().zip(&modes.eigenvalues) {
        let omega = square.max(0.0).sqrt();
        // (1 − cos ωt)/ω² without cancellation.
        let half = 0.5 * omega * END;
        let constant = match half < 1e-8 {
            true => 0.5 * END * END,
            false => 0.5 * (END * half.sin() / half).powi(2),
        };
        let pulse = ((forced * END).cos() - (omega * END).cos()) / (square - forced * forced);
        u += vector * (0.5 * vector.dot(&load) * (constant - pulse));
    }
    Ok(u.as_slice().to_vec())
}

/// Order of a quadrature from half of the `steps` to all of them, and its error.
pub(super) fn load_rule(case: &Case<'_>) -> Result<Found, RunError> {
    let rules = [("Gauss", LoadRule::Gauss), ("midpoint", LoadRule::Midpoint)];
    let load_rule = case.one_of("rule", &rules)?;
    let exact: Rc<Vec<f64>> = case.once("modes".into(), exact)?;
    let error = |steps: usize| -> Result<f64, RunError> {
        let options = TrigonometricOptions {
            load_rule,
            ..Default::default()
        };
        let mut body = body()?;
        let mut scheme = Trigonometric::new(options, &body)?;
        let mut state = State::at_rest(body.points());
        let dt = END / steps as f64;
        march(&mut body, &mut scheme, &mut state, dt, steps, |_, _| {})?;
        Ok(difference(&state.u, &exact))
    };
    let steps = case.count("steps")?;
    let (coarse, fine) = (error(steps / 2)?, error(steps)?);
    Ok([
        ("value", (coarse / fine).log2()),
        ("error", fine),
        ("half", (steps / 2) as f64),
    ]
    .into())
}
