//! Table 1: kernels of the Euler–Bernoulli lattice compared with their closed forms.

use std::f64::consts::PI;

use pericles::PericlesError;
use pericles_run::RunError;
use pericles_waves::absorbing::{
    GhostKernels, LatticeStencil, green_functions, green_functions_closed, trapezoidal_kernels,
};

use crate::data::{Case, Found};

/// J_n(2t)/t for n = 1 and 2.
fn bessel(t: f64) -> [f64; 2] {
    if t < 1e-8 {
        // Limits: J_1(2t)/t → 1, J_2(2t)/t → t/2.
        return [1.0, 0.5 * t];
    }
    [1, 2].map(|n| libm::jn(n, 2.0 * t) / t)
}

/// f_0^1, f_0^2, f_{−1}^1, f_{−1}^2 at a time, with φ_n = (−i)^n n J_n(2t)/t exp(2it): 2 Re φ_1, −φ_1 * φ̄_1, 2 Re
/// φ_2 + φ_1 * φ̄_1, −2 Re φ_2 * φ̄_1. Convolutions by Gauss quadrature on panels shorter than an oscillation.
fn closed_forms(t: f64) -> [f64; 4] {
    const PANEL: f64 = 0.25;
    const NODES: [[f64; 2]; 4] = [
        [0.183_434_642_495_649_8, 0.362_683_783_378_362],
        [0.525_532_409_916_329, 0.313_706_645_877_887_3],
        [0.796_666_477_413_626_7, 0.222_381_034_453_374_5],
        [0.960_289_856_497_536_3, 0.101_228_536_290_376_3],
    ];
    let count = (t / PANEL).ceil();
    let half = 0.5 * t / count;
    let [mut plain, mut mixed] = [0.0, 0.0];
    for panel in 0..count as usize {
        let middle = (2 * panel + 1) as f64 * half;
        for [place, weight] in NODES {
            for tau in [middle - half * place, middle + half * place] {
                let ([one, two], [other, _]) = (bessel(tau), bessel(t - tau));
                let phase = 2.0 * (2.0 * tau - t);
                plain += half * weight * one * other * phase.cos();
                mixed += half * weight * 2.0 * two * other * phase.sin();
            }
        }
    }
    let [one, two] = bessel(t);
    [
        2.0 * one * (2.0 * t).sin(),
        -plain,
        plain - 4.0 * two * (2.0 * t).cos(),
        -2.0 * mixed,
    ]
}

/// Largest error of the four kernels at a step.
fn error(kernels: &GhostKernels, dt: f64, step: usize, exact: &[f64; 4]) -> f64 {
    let pairs = kernels.series().iter().zip(exact);
    let apart = pairs.map(|(series, exact)| (series[step] / dt - exact).abs());
    apart.fold(0.0, f64::max)
}

/// Kernels for step 3π/`parts`: with the paper's Runge–Kutta method for the Green functions up to the longest time,
/// and with exact Green functions up to times below 100π.
fn of_step(case: &Case<'_>, parts: f64) -> Result<[GhostKernels; 2], RunError> {
    let stencil = LatticeStencil::new(&[4.0, -1.0]).map_err(PericlesError::from)?;
    let dt = 3.0 * PI / parts;
    // At most half a million steps.
    let end = if case.context.full { 3000.0 } else { 300.0 };
    let closed = green_functions_closed(&stencil, dt, number(end, parts));
    // The ring grows with time, and so does its cost.
    let green = green_functions(&stencil, dt, number(SHORT, parts), 4);
    Ok([closed, green].map(|green| trapezoidal_kernels(&stencil, dt, &green)))
}

/// Longest time below 100π, in units of π.
const SHORT: f64 = 18.0;

/// Index of the step at a time in units of π.
fn number(time: f64, parts: f64) -> usize {
    (time / 3.0 * parts).round() as usize
}

/// Largest error of the kernels at `time` π and, for short times, of those with exact Green functions.
pub(super) fn kernels(case: &Case<'_>) -> Result<Found, RunError> {
    let (time, parts) = (case.number("time")?, case.number("parts")?);
    let kernels = case.once(format!("kernels {parts}"), || of_step(case, parts))?;
    let exact = case.once(format!("exact {time}"), || Ok(closed_forms(time * PI)))?;
    let error = |kernels| error(kernels, 3.0 * PI / parts, number(time, parts), &exact);
    let [historical, plain] = &*kernels;
    let beside = (time <= SHORT).then(|| error(plain));
    Ok(Found::from(error(historical)).value("beside", beside))
}
