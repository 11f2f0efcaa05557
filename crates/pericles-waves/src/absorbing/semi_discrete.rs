//! Kernels of the semi-discrete lattice, as in the paper.

use super::history::{BlockedHistory, History};
use super::{GhostKernels, LatticeStencil, green_functions};

/// Computes the K² kernels dt f_n^m(j dt) for the trapezoidal rule, from the Green functions of the lattice
/// ([`green_functions`]).
///
/// f_n^m is the displacement of exterior site n when only site m moves, by a delta in time, and satisfies
///
/// ```text
/// f_n^m + Σ_l Σ_{k=1−l..K} a_k (g_{k+l−n} * f_l^m) = Σ_{k=0..K−m} a_{k+m} g_{k+n},      n, l = 0, −1 … −(K − 1)
/// ```
///
/// (equations 19–20 of the paper). The convolutions are evaluated by the trapezoidal rule with the step of the run:
/// only then is Σ_j dt f consistent at zero frequency; exact samples of f would cause a drift. With g(0) = 0 the
/// rule is explicit; its sums are computed by blocks in O(K³ N log² N).
///
/// Second order in dt; [`super::factor_kernels`] has the same cost and adds no error.
pub fn semi_discrete_kernels(stencil: &LatticeStencil, dt: f64, steps: usize) -> GhostKernels {
    let g = green_functions(stencil, dt, steps, 2 * stencil.reach());
    trapezoidal_kernels(stencil, dt, &g)
}

/// As [`semi_discrete_kernels`], from given Green functions g_0 … g_{2K−1}.
pub fn trapezoidal_kernels(stencil: &LatticeStencil, dt: f64, g: &[Vec<f64>]) -> GhostKernels {
    let (reach, a) = (stencil.reach(), stencil.weights());
    let length = g[0].len();
    // Sum of a_k g over pairs (k, site).
    let sum = |factor: f64, terms: &mut dyn Iterator<Item = (usize, usize)>| {
        let mut series = vec![0.0; length];
        for (k, site) in terms {
            for (x, g) in series.iter_mut().zip(&g[site]) {
                *x += factor * a[k - 1] * g;
            }
        }
        series
    };
    let mut products = Vec::with_capacity(reach * reach);
    for n in 0..reach {
        for l in 0..reach {
            let mut terms = (1 + l..=reach).map(|k| (k, k - l + n));
            products.push(sum(-dt, &mut terms));
        }
    }
    let mut history = BlockedHistory::new(GhostKernels::full(reach, products));
    let mut full = vec![Vec::new(); reach * reach];
    let (mut now, mut products) = (vec![0.0; reach], vec![0.0; reach]);
    for m in 1..=reach {
        let sources: Vec<Vec<f64>> = (0..reach)
            .map(|n| sum(1.0, &mut (0..=reach - m).map(|k| (k + m, k.abs_diff(n)))))
            .collect();
        history.reset();
        let mut kernels = vec![vec![0.0; length]; reach];
        for j in 0..length {
            history.ghosts_into(&mut products);
            for n in 0..reach {
                now[n] = sources[n][j] + products[n];
                kernels[n][j] = dt * now[n];
            }
            history.push(&now, &[]);
        }
        for (n, kernel) in kernels.into_iter().enumerate() {
            full[n * reach + m - 1] = kernel;
        }
    }
    GhostKernels::full(reach, full)
}
