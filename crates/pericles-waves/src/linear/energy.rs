//! Energies of linear operators from forces, without a loop over bonds.

use pericles::sum::sum;

/// Value relative to which displacements are taken, so that a rigid translation gives exactly zero.
pub(super) fn origin<const D: usize>(u: &[f64]) -> [f64; D] {
    let n = u.len() / D;
    std::array::from_fn(|c| u[c * n + n / 2])
}

/// Elastic energy −½ Σ V f·u, J.
pub(super) fn elastic_energy<const D: usize>(
    volumes: &[f64],
    u: &[f64],
    force: &[f64],
    origin: [f64; D],
) -> f64 {
    let n = volumes.len();
    let work = sum(D * n, |k| {
        volumes[k % n] * force[k] * (u[k] - origin[k / n])
    });
    -0.5 * work
}

/// Adds w = ¼ s − ½ f·u of every point to `out`, J/m³; s are the sums of the operator over products u_a u_b.
pub(super) fn add_density<const D: usize>(
    u: &[f64],
    force: &[f64],
    origin: [f64; D],
    squares: &[f64],
    out: &mut [f64],
) {
    let n = squares.len();
    for i in 0..n {
        let work: f64 = (0..D)
            .map(|c| force[c * n + i] * (u[c * n + i] - origin[c]))
            .sum();
        out[i] += 0.25 * squares[i] - 0.5 * work;
    }
}
