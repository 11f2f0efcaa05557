//! Small matrices and their principal axes. The functions of matrices are inlined, because those of D = 2 and 3 take as long
//! as a call.

/// A square matrix by rows.
pub type Matrix<const D: usize> = [[f64; D]; D];

/// Returns the unit matrix.
#[inline(always)]
pub fn unit<const D: usize>() -> Matrix<D> {
    diagonal([1.0; D])
}

/// Returns a diagonal matrix.
#[inline(always)]
pub fn diagonal<const D: usize>(entries: [f64; D]) -> Matrix<D> {
    let mut matrix = [[0.0; D]; D];
    for (a, entry) in entries.into_iter().enumerate() {
        matrix[a][a] = entry;
    }
    matrix
}

/// Returns A B.
#[inline(always)]
pub fn product<const D: usize>(a: &Matrix<D>, b: &Matrix<D>) -> Matrix<D> {
    matrix(|i, j| (0..D).map(|k| a[i][k] * b[k][j]).sum())
}

/// Returns Aᵀ.
#[inline(always)]
pub fn transpose<const D: usize>(a: &Matrix<D>) -> Matrix<D> {
    matrix(|i, j| a[j][i])
}

/// Returns s A + t B.
#[inline(always)]
pub fn combination<const D: usize>(s: f64, a: &Matrix<D>, t: f64, b: &Matrix<D>) -> Matrix<D> {
    matrix(|i, j| s * a[i][j] + t * b[i][j])
}

/// Returns ½ (A + Aᵀ).
#[inline(always)]
pub fn symmetric<const D: usize>(a: &Matrix<D>) -> Matrix<D> {
    matrix(|i, j| 0.5 * (a[i][j] + a[j][i]))
}

/// Returns Σ A_ii.
#[inline(always)]
pub fn trace<const D: usize>(a: &Matrix<D>) -> f64 {
    (0..D).map(|i| a[i][i]).sum()
}

/// Returns A : B = Σ A_ij B_ij.
#[inline(always)]
pub fn contraction<const D: usize>(a: &Matrix<D>, b: &Matrix<D>) -> f64 {
    let rows = a.iter().flatten().zip(b.iter().flatten());
    rows.map(|(x, y)| x * y).sum()
}

/// Returns a matrix from a function of row and column.
#[inline(always)]
pub fn matrix<const D: usize>(entry: impl Fn(usize, usize) -> f64) -> Matrix<D> {
    let mut matrix = [[0.0; D]; D];
    for (i, row) in matrix.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            *value = entry(i, j);
        }
    }
    matrix
}

/// Returns the 3 × 3 matrix with `a` in the first rows and columns and `rest` on the remaining diagonal.
#[inline(always)]
pub fn in_space<const D: usize>(a: &Matrix<D>, rest: f64) -> Matrix<3> {
    matrix(|i, j| match i < D && j < D {
        true => a[i][j],
        false if i == j => rest,
        false => 0.0,
    })
}

/// Returns the first D rows and columns.
#[inline(always)]
pub fn in_body<const D: usize>(a: &Matrix<3>) -> Matrix<D> {
    matrix(|i, j| a[i][j])
}

/// Returns the determinant.
#[inline(always)]
pub fn determinant(a: &Matrix<3>) -> f64 {
    let minor = |j: usize, k: usize| a[1][j] * a[2][k] - a[1][k] * a[2][j];
    a[0][0] * minor(1, 2) - a[0][1] * minor(0, 2) + a[0][2] * minor(0, 1)
}

/// Returns the inverse of a matrix with this determinant.
#[inline(always)]
pub fn inverse(a: &Matrix<3>, determinant: f64) -> Matrix<3> {
    let of = |i: usize, j: usize| {
        let ([p, q], [r, s]) = (others(j), others(i));
        a[p][r] * a[q][s] - a[p][s] * a[q][r]
    };
    matrix(|i, j| of(i, j) / determinant)
}

/// Returns the next two indices after i, cyclically.
fn others(i: usize) -> [usize; 2] {
    [(i + 1) % 3, (i + 2) % 3]
}

/// Returns the eigenvalues of a symmetric matrix, and unit eigenvectors as columns, by Jacobi rotations.
pub fn principal_axes<const D: usize>(a: &Matrix<D>) -> ([f64; D], Matrix<D>) {
    /// Four suffice in three dimensions; convergence of the off-diagonal entries is quadratic.
    const SWEEPS: usize = 30;
    let (mut a, mut axes) = (symmetric(a), unit::<D>());
    for _ in 0..SWEEPS {
        let size = contraction(&a, &a);
        let mut beside = 0.0;
        for p in 0..D {
            for q in p + 1..D {
                beside += a[p][q] * a[p][q];
                rotate(&mut a, &mut axes, [p, q]);
            }
        }
        if beside <= f64::EPSILON * f64::EPSILON * 1e-6 * size || !size.is_finite() {
            break;
        }
    }
    (std::array::from_fn(|i| a[i][i]), axes)
}

/// Applies the rotation that annihilates the entry p q of a symmetric matrix.
fn rotate<const D: usize>(a: &mut Matrix<D>, axes: &mut Matrix<D>, [p, q]: [usize; 2]) {
    if a[p][q] == 0.0 {
        return;
    }
    let ratio = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
    let c = 1.0 / t.hypot(1.0);
    let s = t * c;
    for k in 0..D {
        let (x, y) = (a[k][p], a[k][q]);
        (a[k][p], a[k][q]) = (c * x - s * y, s * x + c * y);
    }
    for k in 0..D {
        let (x, y) = (a[p][k], a[q][k]);
        (a[p][k], a[q][k]) = (c * x - s * y, s * x + c * y);
    }
    for row in axes.iter_mut() {
        let (x, y) = (row[p], row[q]);
        (row[p], row[q]) = (c * x - s * y, s * x + c * y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: Matrix<3> = [[4.0, 1.0, -2.0], [1.0, 3.0, 0.5], [-2.0, 0.5, 5.0]];

    #[test]
    fn principal_axes_diagonalise_a_matrix() {
        let (values, axes) = principal_axes(&A);
        let back = product(&product(&axes, &diagonal(values)), &transpose(&axes));
        let difference = combination(1.0, &back, -1.0, &A);
        assert!(contraction(&difference, &difference).sqrt() < 1e-14);
        assert!((values.iter().product::<f64>() / determinant(&A) - 1.0).abs() < 1e-14);
        // Equal eigenvalues leave the axes unchanged.
        assert_eq!(principal_axes(&unit::<3>()), ([1.0; 3], unit()));
    }

    #[test]
    fn inverse_times_matrix_is_the_unit_matrix() {
        let full = [[1.1, 0.05, -0.02], [0.3, 0.95, 0.04], [0.01, -0.6, 1.02]];
        let one = product(&inverse(&full, determinant(&full)), &full);
        let difference = combination(1.0, &one, -1.0, &unit());
        assert!(contraction(&difference, &difference).sqrt() < 1e-15);
    }
}
