//! Eigenvalues and eigenvectors of real matrices by a real Schur form converted to a complex one.

use nalgebra::{Complex, DMatrix, Schur};

type C = Complex<f64>;

/// Largest number of iterations per eigenvalue; two or three are usual. For matrices that consist of round-off the
/// iteration may not terminate.
pub(super) const ITERATIONS: usize = 30;

/// M = Q T Qᴴ with T upper triangular: computes the real Schur form of M and rotates its 2 × 2 blocks to triangles,
/// a quarter of the work of a complex Schur decomposition. `None` if the iteration does not converge.
pub(super) fn complex_schur(matrix: DMatrix<f64>) -> Option<(DMatrix<C>, DMatrix<C>)> {
    let most = ITERATIONS * matrix.nrows();
    let (q, t) = Schur::try_new(matrix, f64::EPSILON, most)?.unpack();
    let complex = |x: f64| C::new(x, 0.0);
    let (mut q, mut t) = (q.map(complex), t.map(complex));
    let n = t.nrows();
    for k in 1..n {
        if t[(k, k - 1)].norm() <= f64::EPSILON * (t[(k - 1, k - 1)].norm() + t[(k, k)].norm()) {
            t[(k, k - 1)] = C::default();
            continue;
        }
        // An eigenvector (x, y) of the block becomes the first column of its rotation.
        let [a, b, c, d] = [(k - 1, k - 1), (k - 1, k), (k, k - 1), (k, k)].map(|at| t[at]);
        let half = 0.5 * (a - d);
        let root = (half * half + b * c).sqrt();
        let value = 0.5 * (a + d) + root;
        let (x, y) = (value - d, c);
        let norm = (x.norm_sqr() + y.norm_sqr()).sqrt();
        let (x, y) = (x / norm, y / norm);
        for j in k - 1..n {
            let (upper, lower) = (t[(k - 1, j)], t[(k, j)]);
            t[(k - 1, j)] = x.conj() * upper + y.conj() * lower;
            t[(k, j)] = x * lower - y * upper;
        }
        let turn = |matrix: &mut DMatrix<C>, rows: usize| {
            for i in 0..rows {
                let (left, right) = (matrix[(i, k - 1)], matrix[(i, k)]);
                matrix[(i, k - 1)] = x * left + y * right;
                matrix[(i, k)] = x.conj() * right - y.conj() * left;
            }
        };
        turn(&mut t, k + 1);
        turn(&mut q, n);
        t[(k, k - 1)] = C::default();
    }
    Some((q, t))
}

/// Eigenvectors of an upper triangular matrix, as columns of an upper triangular matrix with unit diagonal.
pub(super) fn triangular_eigenvectors(triangle: &DMatrix<C>) -> DMatrix<C> {
    let n = triangle.nrows();
    let smallest = f64::EPSILON * triangle.norm();
    let mut vectors = DMatrix::identity(n, n);
    for p in 0..n {
        // By columns of the triangle, which are contiguous: the residual that known entries leave for the others.
        let mut left: Vec<C> = triangle.column(p).iter().take(p).copied().collect();
        for i in (0..p).rev() {
            let mut gap = triangle[(p, p)] - triangle[(i, i)];
            if gap.norm() < smallest {
                gap = C::new(smallest, 0.0);
            }
            let entry = left[i] / gap;
            vectors[(i, p)] = entry;
            for (left, t) in left[..i].iter_mut().zip(triangle.column(i).iter()) {
                *left += t * entry;
            }
        }
    }
    vectors
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schur_form_reproduces_the_matrix_and_its_eigenvectors() {
        let n = 23;
        let noise = pericles::noise::noise(n * n, 5);
        let matrix = DMatrix::from_row_slice(n, n, &noise);
        let (q, t) = complex_schur(matrix.clone()).unwrap();
        let complex = matrix.map(|x| C::new(x, 0.0));
        assert!((&q * &t * q.adjoint() - &complex).norm() < 1e-12);
        assert!(t.lower_triangle().norm() - t.diagonal().norm() < 1e-13);
        let vectors = &q * triangular_eigenvectors(&t);
        let values = DMatrix::from_diagonal(&t.diagonal());
        assert!((complex * &vectors - &vectors * values).norm() < 1e-11 * vectors.norm());
        assert!(t.diagonal().iter().any(|x| x.im.abs() > 0.1));
    }

    #[test]
    fn nan_matrix_has_no_schur_form() {
        let matrix = DMatrix::from_element(4, 4, f64::NAN);
        assert!(complex_schur(matrix).is_none());
    }
}
