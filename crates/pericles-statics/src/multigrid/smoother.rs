//! Chebyshev smoothing.

use crate::eigen::symmetric_eigen;
use crate::sparse::{Number, SparseMatrix};
use pericles::domain::Domain;
use pericles::parallel::for_each_chunk;

/// Number of products with the matrix in one smoothing.
const DEGREE: usize = 3;
/// Lowest smoothed eigenvalue as a fraction of the largest.
const LOWEST: f64 = 1.0 / 20.0;
/// Iterations of the estimate of the largest eigenvalue.
const ITERATIONS: usize = 12;
const MARGIN: f64 = 1.02;

/// Polynomial in D⁻¹A that is small on the upper part of its spectrum.
#[derive(Debug, Clone)]
pub struct Smoother {
    inverse: Vec<f64>,
    /// Estimate of the largest eigenvalue of D⁻¹A, with a margin.
    largest: f64,
}

impl Smoother {
    /// Creates the smoother of a matrix with a positive diagonal.
    pub fn new(matrix: &SparseMatrix) -> Self {
        let n = matrix.rows();
        let diagonal = pericles::parallel::for_each_point(n, &|i| matrix.diagonal(i));
        let inverse: Vec<f64> = diagonal
            .iter()
            .map(|&d| if d > 0.0 { 1.0 / d } else { 0.0 })
            .collect();
        let bound = (0..n)
            .map(|i| inverse[i] * matrix.row(i).map(|(_, a)| a.abs()).sum::<f64>())
            .fold(0.0, f64::max);
        let largest = (MARGIN * Self::estimate(matrix, &diagonal, &inverse)).min(bound);
        Self { inverse, largest }
    }

    /// Returns an upper estimate of the largest eigenvalue of D⁻¹A: the largest Ritz value of a few Lanczos
    /// steps plus the norm of its residual (Zhou & Li, SIAM J. Matrix Anal. Appl. 32, 2011). With a lower
    /// estimate the polynomial would grow on larger eigenvalues, and the preconditioner would not be positive
    /// definite.
    fn estimate(matrix: &SparseMatrix, diagonal: &[f64], inverse: &[f64]) -> f64 {
        let n = matrix.rows();
        let domain = Domain::alone(n);
        let norm = |x: &[f64]| domain.sum(n, |i| diagonal[i] * x[i] * x[i]).sqrt();
        let steps = ITERATIONS.min(n);
        // Pseudorandom entries.
        let noise = |i: usize| {
            let x = (12.9898 * i as f64 + 78.233).sin() * 43_758.545_3;
            x - x.floor() - 0.5
        };
        let mut last = vec![0.0; n];
        let mut present: Vec<f64> = (0..n).map(noise).collect();
        let (mut tridiagonal, mut beta) = (vec![0.0; steps * steps], norm(&present));
        let mut product = vec![0.0; n];
        let mut made = 0;
        let first = beta;
        for k in 0..steps {
            // If the vectors span an invariant space, the remainder is round-off.
            const NOTHING: f64 = 1e-10;
            if beta
                <= if k == 0 {
                    0.0
                } else {
                    NOTHING * first.min(1.0)
                }
            {
                break;
            }
            let scale = 1.0 / beta;
            present.iter_mut().for_each(|x| *x *= scale);
            matrix.multiply_into(&present, &mut product);
            let alpha = domain.dot(&present, &product);
            let coupling = if k == 0 { 0.0 } else { beta };
            for i in 0..n {
                let next = inverse[i] * product[i] - alpha * present[i] - coupling * last[i];
                last[i] = present[i];
                present[i] = next;
            }
            tridiagonal[k * steps + k] = alpha;
            if k > 0 {
                tridiagonal[k * steps + k - 1] = beta;
                tridiagonal[(k - 1) * steps + k] = beta;
            }
            beta = norm(&present);
            made = k + 1;
        }
        if made == 0 {
            return 1.0;
        }
        let entry = |e: usize| tridiagonal[e / made * steps + e % made];
        let (values, vectors) = symmetric_eigen(made, (0..made * made).map(entry).collect());
        values[made - 1] + beta * vectors[made * made - 1].abs()
    }

    /// Returns the smoothed prolongation (I − ω D⁻¹A) T with ω = 4/3 over the largest eigenvalue.
    pub fn smoothed(&self, matrix: &SparseMatrix, tentative: &SparseMatrix) -> SparseMatrix {
        let omega = 4.0 / 3.0 / self.largest;
        SparseMatrix::from_rows(matrix.rows(), tentative.columns(), &|i, add| {
            for (column, value) in tentative.row(i) {
                add(column, value);
            }
            let factor = -omega * self.inverse[i];
            for (k, a) in matrix.row(i) {
                for (column, value) in tentative.row(k) {
                    add(column, factor * a * value);
                }
            }
        })
    }

    /// Applies one smoothing to `x` for A x = `right`; `from_zero` indicates that `x` is zero.
    pub fn smooth<T: Number>(
        &self,
        matrix: &SparseMatrix,
        right: &[T],
        x: &mut [T],
        [residual, direction]: [&mut Vec<T>; 2],
        from_zero: bool,
    ) {
        let (high, low) = (self.largest, LOWEST * self.largest);
        let (theta, delta) = (0.5 * (high + low), 0.5 * (high - low));
        let sigma = theta / delta;
        let mut rho = 1.0 / sigma;
        residual.copy_from_slice(right);
        if !from_zero {
            matrix.subtract_product(x, residual);
        }
        for step in 0..DEGREE {
            let (keep, push) = if step == 0 {
                (0.0, 1.0 / theta)
            } else {
                matrix.subtract_product(direction, residual);
                let next = 1.0 / (2.0 * sigma - rho);
                let factors = (next * rho, 2.0 * next / delta);
                rho = next;
                factors
            };
            let (inverse, residual) = (&self.inverse, &*residual);
            for_each_chunk(direction, &|first, chunk| {
                for (k, d) in chunk.iter_mut().enumerate() {
                    let by = T::splat(push * inverse[first + k]);
                    let before = if step == 0 {
                        T::splat(0.0)
                    } else {
                        T::splat(keep) * *d
                    };
                    *d = before + by * residual[first + k];
                }
            });
            let direction = &*direction;
            for_each_chunk(x, &|first, chunk| {
                for (k, x) in chunk.iter_mut().enumerate() {
                    *x = *x + direction[first + k];
                }
            });
        }
    }
}
