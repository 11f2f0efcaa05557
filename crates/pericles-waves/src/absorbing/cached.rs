//! Cache of kernels.

use super::{GhostKernels, LatticeStencil, LatticeStep, contour_kernels};
use pericles::cache::{Cache, Key};
use pericles::sum::max_norm;
use pericles::{Archive, Values};

/// Returns the kernels of [`contour_kernels`], from the cache if present. Cached kernels are verified: arrays that
/// do not satisfy the defining equations are recomputed.
pub fn cached_kernels(
    stencil: &LatticeStencil,
    step: LatticeStep,
    steps: usize,
    cache: &dyn Cache,
) -> GhostKernels {
    let key = Key::new("absorbing-kernels-3")
        .f64s(stencil.weights())
        .f64s(&[step.dt])
        .u64s(&[step.scheme as u64])
        .u64s(&[steps as u64]);
    let reach = stencil.reach();
    let stored = cache
        .load(&key)
        .and_then(|arrays| read(&arrays, reach, steps));
    if let Some(series) = stored.filter(|series| holds(series, stencil, step.dt)) {
        return GhostKernels::shift(series);
    }
    let series = contour_kernels(stencil, step, steps);
    let mut arrays = Archive::default();
    for (k, series) in series.iter().enumerate() {
        arrays.put(name(k), Values::F64(series.clone()));
    }
    cache.store(&key, &arrays);
    GhostKernels::shift(series)
}

fn name(k: usize) -> String {
    format!("h/{}", k + 1)
}

fn read(arrays: &Archive, reach: usize, steps: usize) -> Option<Vec<Vec<f64>>> {
    let one = |k| arrays.f64s(&name(k)).ok().map(<[f64]>::to_vec);
    let series: Option<Vec<Vec<f64>>> = (0..reach).map(one).collect();
    series.filter(|series| series.iter().all(|h| h.len() == steps + 1))
}

/// Returns true if a_K (h_k − Σ h_m h_{m+k}) = a_k h_K at the last coefficient, which depends on all others. The
/// equation is the ratio of two equations of the factor.
fn holds(series: &[Vec<f64>], stencil: &LatticeStencil, dt: f64) -> bool {
    let (weights, reach) = (stencil.weights(), stencil.reach());
    let last = series[0].len() - 1;
    let product = |a: &[f64], b: &[f64]| -> f64 {
        a.iter()
            .zip(b[..=last].iter().rev())
            .map(|(x, y)| x * y)
            .sum()
    };
    let largest = max_norm(weights);
    (1..=reach).all(|k| {
        let sum: f64 = (0..reach - k)
            .map(|m| product(&series[m], &series[m + k]))
            .sum();
        let error = weights[reach - 1] * (series[k - 1][last] - sum)
            - weights[k - 1] * series[reach - 1][last];
        // Tolerance for round-off of kernels of size dt² a and below.
        error.abs() <= 1e-9 * largest * dt * dt * largest
    })
}
