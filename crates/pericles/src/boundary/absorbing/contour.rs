//! The kernels of the fully discrete scheme by Cauchy's integral.

use std::f64::consts::TAU;

use rayon::prelude::*;
use realfft::num_complex::Complex;

use super::LatticeStencil;
use super::roots::factor_at;
use crate::operator::linear::LineTransform;

/// σ(w) = (1/w − 2 + w)/dt²: what velocity Verlet makes of ∂²/∂t².
pub(super) fn verlet_symbol(w: Complex<f64>, dt: f64) -> Complex<f64> {
    // (1 − w)²/w: no cancellation near w = 1.
    let one = Complex::new(1.0, 0.0) - w;
    one * one / (w * (dt * dt))
}

/// h_1 … h_K with `steps + 1` coefficients from the factor on a circle of radius r < 1, at 8 points per coefficient with r^points = 10^−16.5.
///
/// O(K³ N), on all threads; an independent check of [`super::factor_kernels`], which is faster.
pub fn contour_kernels(stencil: &LatticeStencil, dt: f64, steps: usize) -> Vec<Vec<f64>> {
    let points = (8 * (steps + 1)).next_power_of_two();
    let radius = 10f64.powf(-16.5 / points as f64);
    let transform = LineTransform::new(points);
    let samples: Vec<Vec<Complex<f64>>> = (0..transform.modes())
        .into_par_iter()
        .map(|p| {
            // The transform's sign: coefficients of w^j come with exp(+i j φ) when w = r exp(−i φ).
            let w = Complex::from_polar(radius, -TAU * p as f64 / points as f64);
            factor_at(stencil, verlet_symbol(w, dt))
        })
        .collect();
    let mut scratch = transform.scratch();
    let mut line = vec![0.0; points];
    (0..stencil.reach())
        .map(|m| {
            let mut spectrum: Vec<Complex<f64>> = samples.iter().map(|h| h[m]).collect();
            transform.inverse(&mut spectrum, &mut line, &mut scratch);
            let mut growth = 1.0 / points as f64;
            line[..=steps]
                .iter()
                .map(|x| {
                    let coefficient = x * growth;
                    growth /= radius;
                    coefficient
                })
                .collect()
        })
        .collect()
}
