//! Eigenvalues of small dense symmetric matrices.

/// Returns the ascending eigenvalues and orthonormal eigenvectors of a symmetric n × n matrix, given row by
/// row, by Jacobi rotations. The vectors are concatenated.
///
/// ```
/// let (values, vectors) = pericles_statics::symmetric_eigen(2, vec![2.0, 1.0, 1.0, 2.0]);
/// assert!((values[0] - 1.0).abs() < 1e-14 && (values[1] - 3.0).abs() < 1e-14);
/// assert!((vectors[2].abs() - 0.5f64.sqrt()).abs() < 1e-14);
/// ```
pub fn symmetric_eigen(n: usize, mut a: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
    /// Largest number of sweeps over all pairs; convergence is quadratic, typically in six sweeps.
    const SWEEPS: usize = 60;
    let mut vectors = vec![0.0; n * n];
    for k in 0..n {
        vectors[k * n + k] = 1.0;
    }
    for _ in 0..SWEEPS {
        let mut off = 0.0;
        for p in 0..n {
            for q in p + 1..n {
                off += a[p * n + q].powi(2);
            }
        }
        let diagonal: f64 = (0..n).map(|k| a[k * n + k].powi(2)).sum();
        if off <= 1e-32 * diagonal || off == 0.0 {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                rotate(n, &mut a, &mut vectors, p, q);
            }
        }
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| a[i * n + i].total_cmp(&a[j * n + j]));
    let values = order.iter().map(|&k| a[k * n + k]).collect();
    let sorted = order
        .iter()
        .flat_map(|&k| vectors[k * n..(k + 1) * n].iter().copied());
    (values, sorted.collect())
}

/// Applies a rotation that annihilates the entry (p, q).
fn rotate(n: usize, a: &mut [f64], vectors: &mut [f64], p: usize, q: usize) {
    let apq = a[p * n + q];
    if apq == 0.0 {
        return;
    }
    let theta = (a[q * n + q] - a[p * n + p]) / (2.0 * apq);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let t = if theta == 0.0 { 1.0 } else { t };
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    for k in 0..n {
        let (x, y) = (a[k * n + p], a[k * n + q]);
        a[k * n + p] = c * x - s * y;
        a[k * n + q] = s * x + c * y;
    }
    for k in 0..n {
        let (x, y) = (a[p * n + k], a[q * n + k]);
        a[p * n + k] = c * x - s * y;
        a[q * n + k] = s * x + c * y;
        let (x, y) = (vectors[p * n + k], vectors[q * n + k]);
        vectors[p * n + k] = c * x - s * y;
        vectors[q * n + k] = s * x + c * y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvectors_diagonalise_the_matrix() {
        let n = 9;
        let entry =
            |i: usize, k: usize| ((i * k) as f64).sin() + 1.0 / (1.0 + i.abs_diff(k) as f64);
        let a: Vec<f64> = (0..n * n)
            .map(|e| entry((e / n).min(e % n), (e / n).max(e % n)))
            .collect();
        let (values, vectors) = symmetric_eigen(n, a.clone());
        assert!(values.is_sorted());
        for k in 0..n {
            for i in 0..n {
                let av: f64 = (0..n).map(|j| a[i * n + j] * vectors[k * n + j]).sum();
                assert!((av - values[k] * vectors[k * n + i]).abs() < 1e-12);
            }
        }
    }
}
