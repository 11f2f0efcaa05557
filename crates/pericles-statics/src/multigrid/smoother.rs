//! Chebyshev smoothing.

use pericles::domain::Domain;
use pericles::parallel::for_each_chunk;

use crate::sparse::SparseMatrix;

/// Products with the matrix in one smoothing.
const DEGREE: usize = 3;
/// The eigenvalues that are smoothed reach from the largest down to this part of it.
const LOWEST: f64 = 1.0 / 20.0;
/// Iterations of the estimate of the largest eigenvalue, and its margin.
const ITERATIONS: usize = 15;
const MARGIN: f64 = 1.1;

/// A polynomial in D⁻¹A that is small on the upper part of its spectrum.
#[derive(Debug, Clone)]
pub struct Smoother {
    inverse: Vec<f64>,
    /// An estimate of the largest eigenvalue of D⁻¹A, with a margin.
    largest: f64,
}

impl Smoother {
    /// Of a matrix with a positive diagonal.
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

    /// The largest eigenvalue of D⁻¹A from below, by power iteration from a vector that oscillates from unknown to unknown.
    fn estimate(matrix: &SparseMatrix, diagonal: &[f64], inverse: &[f64]) -> f64 {
        let n = matrix.rows();
        let domain = Domain::alone(n);
        let mut x: Vec<f64> = (0..n).map(|i| (2.3 * i as f64 + 0.4).sin()).collect();
        let mut product = vec![0.0; n];
        let mut value = 0.0;
        for _ in 0..ITERATIONS {
            let square = domain.sum(n, |i| diagonal[i] * x[i] * x[i]);
            if square <= 0.0 {
                return 1.0;
            }
            let scale = 1.0 / square.sqrt();
            x.iter_mut().for_each(|x| *x *= scale);
            matrix.multiply_into(&x, &mut product);
            value = domain.dot(&x, &product);
            for i in 0..n {
                x[i] = inverse[i] * product[i];
            }
        }
        value
    }

    /// (I − ω D⁻¹A) T with ω = 4/3 over the largest eigenvalue: the smoothed prolongation.
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

    /// Improves `x` towards the solution of A x = `right`; `from_zero` says that `x` is zero.
    pub fn smooth(
        &self,
        matrix: &SparseMatrix,
        right: &[f64],
        x: &mut [f64],
        [residual, direction]: [&mut Vec<f64>; 2],
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
                    let before = if step == 0 { 0.0 } else { keep * *d };
                    *d = before + push * inverse[first + k] * residual[first + k];
                }
            });
            let direction = &*direction;
            for_each_chunk(x, &|first, chunk| {
                for (k, x) in chunk.iter_mut().enumerate() {
                    *x += direction[first + k];
                }
            });
        }
    }
}
