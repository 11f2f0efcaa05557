//! Frequencies and polarisations of plane waves.

use super::vector::{SquareMatrix, Vector, dot};

/// Frequency and polarisation of a plane wave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// ω², 1/s² (or the square of a speed, m²/s²); negative if the lattice is unstable.
    pub omega_squared: f64,
    /// Unit vector.
    pub polarisation: Vector,
}

impl Mode {
    /// Returns ω, 1/s; NaN if the mode is unstable.
    pub fn omega(&self) -> f64 {
        self.omega_squared.sqrt()
    }

    /// Squared component of the polarisation along a direction of any length, 0 … 1: 1 for pressure waves, 0 for shear
    /// waves.
    pub fn longitudinal(&self, direction: Vector) -> f64 {
        dot(self.polarisation, direction).powi(2) / dot(direction, direction)
    }
}

/// Numerical frequency (2/dt) asin(ω dt/2) of velocity Verlet with time step dt for a mode of frequency ω; `None`
/// beyond the stability limit.
pub fn verlet_frequency(omega: f64, dt: f64) -> Option<f64> {
    let half = 0.5 * omega * dt;
    (half.abs() <= 1.0).then(|| 2.0 / dt * half.asin())
}

/// Computes eigenvalues, ascending, and eigenvectors by the Jacobi method.
pub(super) fn modes_of(matrix: &SquareMatrix, dimension: usize) -> Vec<Mode> {
    let mut a = *matrix;
    let mut vectors = [[0.0; 3]; 3];
    for c in 0..3 {
        vectors[c][c] = 1.0;
    }
    let scale: f64 = a.iter().flatten().map(|x| x * x).sum();
    // Convergence is quadratic: three sweeps usually suffice; thirty are never needed.
    for _ in 0..30 {
        let off: f64 = (0..3)
            .map(|p| (p + 1..3).map(|q| a[p][q].powi(2)).sum::<f64>())
            .sum();
        if off <= 1e-34 * scale {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] != 0.0 {
                rotate(&mut a, &mut vectors, p, q);
            }
        }
    }
    let mut modes: Vec<Mode> = (0..dimension)
        .map(|c| Mode {
            omega_squared: a[c][c],
            polarisation: vectors[c],
        })
        .collect();
    modes.sort_by(|x, y| x.omega_squared.total_cmp(&y.omega_squared));
    modes
}

/// Zeroes entry (p, q) by a Jacobi rotation; rows of `vectors` are the eigenvectors.
fn rotate(a: &mut SquareMatrix, vectors: &mut [Vector; 3], p: usize, q: usize) {
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
    let t = if theta == 0.0 { 1.0 } else { t };
    let c = 1.0 / t.hypot(1.0);
    let s = t * c;
    let off = a[p][q];
    a[p][p] -= t * off;
    a[q][q] += t * off;
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    let r = 3 - p - q;
    let (x, y) = (a[r][p], a[r][q]);
    a[r][p] = c * x - s * y;
    a[r][q] = s * x + c * y;
    a[p][r] = a[r][p];
    a[q][r] = a[r][q];
    for k in 0..3 {
        let (x, y) = (vectors[p][k], vectors[q][k]);
        vectors[p][k] = c * x - s * y;
        vectors[q][k] = s * x + c * y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn jacobi_eigenpairs_satisfy_the_eigenvalue_equation(d in prop::array::uniform3(-2.0f64..2.0), o in prop::array::uniform3(-2.0f64..2.0)) {
            let matrix = [[d[0], o[0], o[1]], [o[0], d[1], o[2]], [o[1], o[2], d[2]]];
            let modes = modes_of(&matrix, 3);
            for mode in &modes {
                for row in 0..3 {
                    let product = dot(matrix[row], mode.polarisation);
                    prop_assert!((product - mode.omega_squared * mode.polarisation[row]).abs() < 1e-13);
                }
                prop_assert!((dot(mode.polarisation, mode.polarisation) - 1.0).abs() < 1e-14);
            }
            prop_assert!(modes[0].omega_squared <= modes[1].omega_squared);
            prop_assert!(dot(modes[0].polarisation, modes[2].polarisation).abs() < 1e-13);
            // The shares along a wave vector of any length add up to one.
            for k in [[3e4, 0.0, 0.0], [0.2, -0.1, 0.05], [-700.0, 20.0, 1e3]] {
                let sum: f64 = modes.iter().map(|mode| mode.longitudinal(k)).sum();
                prop_assert!((sum - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn verlet_increases_frequencies() {
        // At ω = 4, dt = 0.1 the shift is 0.027.
        assert!((verlet_frequency(4.0, 0.1).unwrap() - 4.0 - 0.027).abs() < 1e-3);
        assert!(verlet_frequency(20.1, 0.1).is_none());
    }
}
