//! Green functions by the closure of the paper; kept to reproduce its tables.

use super::LatticeStencil;

/// Computes g_0 … g_{2K−1} at 0, dt … by the classical Runge–Kutta method on the chain of 2K sites, closed by the
/// identity
///
/// ```text
/// Σ_{k=1..K} k a_k (g_{m+k} − g_{m−k}) = −(2m/t) g_m'(t)
/// ```
///
/// solved for the 2K-th to (3K − 1)-th g; its right-hand side is zero at t = 0 (equations 23–27 of the paper).
///
/// **Historical.** The closure is exact but unstable: for the Gaussian micromodulus errors grow as exp(0.41 t) with
/// K = 7, up to exp(10.9 t) for K = 10. It is stable for the Euler–Bernoulli lattice and for constant and conical
/// micromoduli. Use [`super::green_functions`].
pub fn green_functions_closed(stencil: &LatticeStencil, dt: f64, steps: usize) -> Vec<Vec<f64>> {
    let sites = 2 * stencil.reach();
    let mut state = [vec![0.0; sites], vec![0.0; sites]];
    state[1][0] = 1.0;
    let mut g: Vec<Vec<f64>> = (0..sites).map(|_| Vec::with_capacity(steps + 1)).collect();
    let rate = |t: f64, [g, v]: &[Vec<f64>; 2]| [v.clone(), acceleration(stencil, t, g, v)];
    let advanced = |state: &[Vec<f64>; 2], h: f64, rate: &[Vec<f64>; 2]| {
        std::array::from_fn(|part| {
            let pairs = state[part].iter().zip(&rate[part]);
            pairs.map(|(x, r)| x + h * r).collect()
        })
    };
    for j in 0..=steps {
        for (g, now) in g.iter_mut().zip(&state[0]) {
            g.push(*now);
        }
        let t = j as f64 * dt;
        let first = rate(t, &state);
        let second = rate(t + 0.5 * dt, &advanced(&state, 0.5 * dt, &first));
        let third = rate(t + 0.5 * dt, &advanced(&state, 0.5 * dt, &second));
        let fourth = rate(t + dt, &advanced(&state, dt, &third));
        for part in 0..2 {
            for m in 0..sites {
                let middle = second[part][m] + third[part][m];
                state[part][m] += dt / 6.0 * (first[part][m] + 2.0 * middle + fourth[part][m]);
            }
        }
    }
    g
}

/// Second derivatives g_m'' of the closed chain.
fn acceleration(stencil: &LatticeStencil, t: f64, g: &[f64], v: &[f64]) -> Vec<f64> {
    let (reach, a) = (stencil.reach() as isize, stencil.weights());
    let mut all = g.to_vec();
    for m in reach..2 * reach {
        let at = |site: isize| all[site.unsigned_abs()];
        let source = if t > 0.0 {
            -2.0 * m as f64 / t * v[m as usize]
        } else {
            0.0
        };
        let known: f64 = (1..reach)
            .map(|k| k as f64 * a[k as usize - 1] * (at(m + k) - at(m - k)))
            .sum();
        let outermost = reach as f64 * a[reach as usize - 1];
        all.push(at(m - reach) + (source - known) / outermost);
    }
    let at = |site: isize| all[site.unsigned_abs()];
    (0..2 * reach)
        .map(|m| {
            (1..=reach)
                .map(|k| a[k as usize - 1] * (at(m + k) - 2.0 * at(m) + at(m - k)))
                .sum()
        })
        .collect()
}
