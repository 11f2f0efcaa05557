//! Principal axes of symmetric 3 × 3 matrices.

/// Largest number of sweeps; three or four are usually enough, because the method converges quadratically.
const SWEEPS: usize = 30;

/// Returns orthonormal eigenvectors of a symmetric matrix, by Jacobi rotations (Golub & Van Loan, Matrix
/// Computations, section 8.5).
///
/// ```
/// let axes = pericles::solve::principal_axes([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 1.0]]);
/// // The eigenvector of the eigenvalue 3 is (1, 1, 0)/√2.
/// assert!(axes.iter().any(|a| ((a[0] * a[1]) - 0.5).abs() < 1e-15 && a[2] == 0.0));
/// ```
pub fn principal_axes(mut matrix: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let across = matrix[p][q];
            let small = f64::EPSILON * (matrix[p][p].abs() * matrix[q][q].abs()).sqrt();
            if across.abs() <= small {
                continue;
            }
            rotated = true;
            let half = (matrix[q][q] - matrix[p][p]) / (2.0 * across);
            let tangent = 1.0_f64.copysign(half) / (half.abs() + half.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            let sine = tangent * cosine;
            for row in &mut matrix {
                (row[p], row[q]) = (
                    cosine * row[p] - sine * row[q],
                    sine * row[p] + cosine * row[q],
                );
            }
            let (one, other) = (matrix[p], matrix[q]);
            for c in 0..3 {
                matrix[p][c] = cosine * one[c] - sine * other[c];
                matrix[q][c] = sine * one[c] + cosine * other[c];
            }
            let (one, other) = (axes[p], axes[q]);
            for c in 0..3 {
                axes[p][c] = cosine * one[c] - sine * other[c];
                axes[q][c] = sine * one[c] + cosine * other[c];
            }
        }
        if !rotated {
            break;
        }
    }
    axes
}

/// Returns the inverse of a matrix, or `None` if it is singular to round-off.
pub fn inverse(m: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let minor = |i: usize, j: usize| {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
    let size = (0..3).map(|c| m[c][c].abs()).fold(0.0, f64::max);
    if determinant.abs() <= 1e-9 * size.powi(3) {
        return None;
    }
    Some(std::array::from_fn(|i| {
        std::array::from_fn(|j| minor(j, i) / determinant)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_axes_are_orthonormal_and_diagonalise_the_matrix() {
        let noise = crate::noise::noise(600, 3);
        for numbers in noise.chunks(6) {
            let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|k| numbers[k]);
            let matrix = [[a, b, c], [b, d, e], [c, e, f]];
            let axes = principal_axes(matrix);
            for (i, x) in axes.iter().enumerate() {
                for (j, y) in axes.iter().enumerate() {
                    let dot: f64 = (0..3).map(|k| x[k] * y[k]).sum();
                    assert!((dot - f64::from(u8::from(i == j))).abs() < 1e-14);
                    let product: f64 = (0..3)
                        .flat_map(|k| (0..3).map(move |l| (k, l)))
                        .map(|(k, l)| x[k] * matrix[k][l] * y[l])
                        .sum();
                    assert!(i == j || product.abs() < 1e-14, "{matrix:?}");
                }
            }
        }
    }
}
