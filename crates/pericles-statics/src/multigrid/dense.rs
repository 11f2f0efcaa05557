//! Cholesky factorisation of small dense matrices.

use crate::sparse::{Number, SparseMatrix};

/// Factorisation A = L Lᵀ of a symmetric positive semidefinite matrix. Singular directions get a stiffness of
/// the size of the diagonal, so that a factor always exists.
#[derive(Debug, Clone)]
pub struct DenseCholesky {
    n: usize,
    /// L, row by row.
    lower: Vec<f64>,
}

/// Pivots below this fraction of the diagonal are singular.
const SINGULAR: f64 = 1e-12;

impl DenseCholesky {
    /// Computes the factor of a sparse matrix.
    pub fn new(matrix: &SparseMatrix) -> Self {
        let n = matrix.rows();
        let mut dense = vec![0.0; n * n];
        for i in 0..n {
            for (k, a) in matrix.row(i) {
                dense[i * n + k] = a;
            }
        }
        Self::of_dense(n, dense)
    }

    /// Computes the factor of a dense matrix, row by row, whose lower triangle is used.
    pub fn of_dense(n: usize, mut lower: Vec<f64>) -> Self {
        for i in 0..n {
            let (above, row) = lower.split_at_mut(i * n);
            let diagonal = row[i];
            for j in 0..i {
                let other = &above[j * n..j * n + j + 1];
                let dot: f64 = row[..j].iter().zip(other).map(|(a, b)| a * b).sum();
                row[j] = (row[j] - dot) / other[j];
            }
            let pivot = diagonal - row[..i].iter().map(|a| a * a).sum::<f64>();
            row[i] = if pivot > SINGULAR * diagonal.abs() {
                pivot.sqrt()
            } else if diagonal > 0.0 {
                // A singular direction.
                diagonal.sqrt()
            } else {
                1.0
            };
        }
        Self { n, lower }
    }

    /// Computes `out` = A⁻¹ x.
    pub fn solve_into<T: Number>(&self, x: &[T], out: &mut [T]) {
        let n = self.n;
        for i in 0..n {
            let row = &self.lower[i * n..i * n + i + 1];
            let mut sum = T::splat(0.0);
            for (a, b) in row[..i].iter().zip(&out[..i]) {
                sum = sum + T::splat(*a) * *b;
            }
            out[i] = (x[i] - sum) / T::splat(row[i]);
        }
        for i in (0..n).rev() {
            out[i] = out[i] / T::splat(self.lower[i * n + i]);
            let value = out[i];
            let row = &self.lower[i * n..i * n + i];
            for (x, l) in out[..i].iter_mut().zip(row) {
                *x = *x - T::splat(*l) * value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_satisfy_the_linear_system() {
        let n = 12;
        let matrix = SparseMatrix::from_rows(n, n, &|i, add| {
            for k in 0..n {
                let near = 1.0 / (1.0 + i.abs_diff(k) as f64).powi(2);
                add(k, near + if i == k { 2.0 } else { 0.0 });
            }
        });
        let exact: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let (mut right, mut x) = (vec![0.0; n], vec![0.0; n]);
        matrix.multiply_into(&exact, &mut right);
        DenseCholesky::new(&matrix).solve_into(&right, &mut x);
        for (x, exact) in x.iter().zip(&exact) {
            assert!((x - exact).abs() < 1e-13);
        }
    }
}
