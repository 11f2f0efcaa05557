//! The factor of the symbol at a complex frequency, from its roots.

use nalgebra::{Complex, DMatrix, DVector};

use super::LatticeStencil;

type C = Complex<f64>;

/// h_1 … h_K at s² → σ: (−1)^{m+1} e_m of the roots of D(z) = σ + 2Σa_k − Σ a_k (z^k + z^{−k}) inside the unit circle.
///
/// With x = (z + 1/z)/2 the symbol is a Chebyshev series in x, whose zeros are the eigenvalues of its colleague matrix (Good 1961); two Newton steps on the
/// autocorrelation c P(z) P(1/z) = D then give full accuracy.
pub(super) fn factor_at(stencil: &LatticeStencil, sigma: C) -> Vec<C> {
    let (reach, a) = (stencil.reach(), stencil.weights());
    let centre = sigma + 2.0 * stencil.sum();
    // P(z) = Π (1 − z_j z).
    let mut factor = vec![C::new(1.0, 0.0)];
    for x in chebyshev_zeros(centre, a) {
        let root = (x * x - 1.0).sqrt();
        let (one, other) = (x + root, x - root);
        // The larger one has no cancellation; the other is its reciprocal.
        let z = if one.norm_sqr() > other.norm_sqr() {
            one.inv()
        } else {
            other.inv()
        };
        factor.push(C::default());
        for k in (1..factor.len()).rev() {
            let below = factor[k - 1];
            factor[k] -= z * below;
        }
    }
    // The coefficient of z^K is −a_K = c · factor[K].
    let scale = (-C::new(a[reach - 1], 0.0) / factor[reach]).sqrt();
    let mut b = DVector::from_iterator(reach + 1, factor.iter().map(|x| x * scale));
    for _ in 0..2 {
        polish(&mut b, centre, a);
    }
    (1..=reach).map(|m| -b[m] / b[0]).collect()
}

/// The zeros of centre − 2 Σ a_k T_k(x).
fn chebyshev_zeros(centre: C, a: &[f64]) -> Vec<C> {
    let reach = a.len();
    let coefficient = |k: usize| {
        if k == 0 {
            centre
        } else {
            C::new(-2.0 * a[k - 1], 0.0)
        }
    };
    if reach == 1 {
        return vec![-coefficient(0) / coefficient(1)];
    }
    let mut colleague = DMatrix::<C>::zeros(reach, reach);
    colleague[(0, 1)] = C::new(1.0, 0.0);
    for j in 1..reach {
        colleague[(j, j - 1)] = C::new(0.5, 0.0);
        if j + 1 < reach {
            colleague[(j, j + 1)] = C::new(0.5, 0.0);
        }
    }
    for k in 0..reach {
        colleague[(reach - 1, k)] -= coefficient(k) / (2.0 * coefficient(reach));
    }
    eigenvalues(colleague)
}

/// The eigenvalues of a complex matrix.
pub(super) fn eigenvalues(matrix: DMatrix<C>) -> Vec<C> {
    let (_, triangle) = matrix.schur().unpack();
    triangle.diagonal().iter().copied().collect()
}

/// A Newton step on Σ_j b_j b_{j+k} = d_k with d = (centre, −a_1 … −a_K).
fn polish(b: &mut DVector<C>, centre: C, a: &[f64]) {
    let n = b.len();
    let mut residual = DVector::<C>::zeros(n);
    let mut jacobian = DMatrix::<C>::zeros(n, n);
    for k in 0..n {
        let wanted = if k == 0 {
            centre
        } else {
            C::new(-a[k - 1], 0.0)
        };
        residual[k] = (0..n - k).map(|j| b[j] * b[j + k]).sum::<C>() - wanted;
        for i in 0..n {
            if i + k < n {
                jacobian[(k, i)] += b[i + k];
            }
            if i >= k {
                jacobian[(k, i)] += b[i - k];
            }
        }
    }
    // At a branch point, where there is no unique solution, the roots stand as they are.
    if let Some(step) = jacobian.lu().solve(&residual)
        && step.iter().all(|x| x.re.is_finite() && x.im.is_finite())
    {
        *b -= step;
    }
}

/// F_n^m from h: F_{n+1}^m = F_n^1 h_m + F_n^{m+1}; m runs faster.
pub(super) fn expanded(h: &[C]) -> Vec<C> {
    let reach = h.len();
    let mut full = h.to_vec();
    for n in 1..reach {
        for m in 0..reach {
            let row = (n - 1) * reach;
            let next = if m + 1 < reach {
                full[row + m + 1]
            } else {
                C::default()
            };
            full.push(full[row] * h[m] + next);
        }
    }
    full
}
