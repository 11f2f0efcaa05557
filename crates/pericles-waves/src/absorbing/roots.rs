//! Factor of the symbol at complex frequencies, from its roots and by continuation along curves.

use nalgebra::{Complex, DMatrix, Schur};

use super::LatticeStencil;
use super::schur::ITERATIONS;

type C = Complex<f64>;

/// Computes h_1 … h_K at s² → σ: (−1)^{m+1} e_m of the roots of D(z) = σ + 2Σa_k − Σ a_k (z^k + z^{−k}) inside the
/// unit circle.
pub(super) fn factor_at(stencil: &LatticeStencil, sigma: C) -> Vec<C> {
    Factor::at(stencil, sigma).kernels()
}

/// Factor c^½ (1, −h_1 … −h_K): the solution b of Σ_j b_j b_{j+k} = (σ + 2Σa, −a_1 … −a_K) whose zeros lie outside
/// the unit circle.
pub(super) struct Factor<'a> {
    stencil: &'a LatticeStencil,
    b: Vec<C>,
    before: Option<Vec<C>>,
    system: Vec<C>,
    step: Vec<C>,
}

/// Relative size of a correction that leaves an error of its square.
const SMALL: f64 = 1e-9;
/// Number of corrections after which the continuation is abandoned.
const CORRECTIONS: usize = 6;

impl<'a> Factor<'a> {
    /// Computes the factor from its roots. With x = (z + 1/z)/2 the symbol is a Chebyshev series in x, whose zeros
    /// are the eigenvalues of its colleague matrix (Good 1961); two Newton steps on the autocorrelation then give
    /// full accuracy.
    pub(super) fn at(stencil: &'a LatticeStencil, sigma: C) -> Self {
        let reach = stencil.reach();
        let mut factor = Self {
            stencil,
            b: vec![C::default(); reach + 1],
            before: None,
            system: vec![C::default(); (reach + 1) * (reach + 1)],
            step: vec![C::default(); reach + 1],
        };
        factor.restart(sigma);
        factor
    }

    fn restart(&mut self, sigma: C) {
        let (reach, a) = (self.stencil.reach(), self.stencil.weights());
        let centre = sigma + 2.0 * self.stencil.sum();
        // P(z) = Π (1 − z_j z).
        let mut product = vec![C::new(1.0, 0.0)];
        for x in chebyshev_zeros(centre, a) {
            let root = (x * x - 1.0).sqrt();
            let (one, other) = (x + root, x - root);
            // The larger root has no cancellation; the other is its reciprocal.
            let z = if one.norm_sqr() > other.norm_sqr() {
                one.inv()
            } else {
                other.inv()
            };
            product.push(C::default());
            for k in (1..product.len()).rev() {
                let below = product[k - 1];
                product[k] -= z * below;
            }
        }
        // The coefficient of z^K is −a_K = c · product[K].
        let scale = (-C::new(a[reach - 1], 0.0) / product[reach]).sqrt();
        self.b = product.iter().map(|x| x * scale).collect();
        self.before = None;
        for _ in 0..2 {
            self.correct(sigma);
        }
    }

    /// Moves to a nearby σ: by Newton's method from linear extrapolation of the last two factors, or from the roots
    /// if it does not converge.
    pub(super) fn follow(&mut self, sigma: C) {
        let last = self.b.clone();
        if let Some(before) = &self.before {
            for (b, before) in self.b.iter_mut().zip(before) {
                *b += *b - before;
            }
        }
        let converged = (0..CORRECTIONS).any(|_| self.correct(sigma) < SMALL);
        if converged {
            self.before = Some(last);
        } else {
            self.restart(sigma);
        }
    }

    /// h_1 … h_K.
    pub(super) fn kernels(&self) -> Vec<C> {
        let mut kernels = vec![C::default(); self.stencil.reach()];
        self.kernels_into(&mut kernels);
        kernels
    }

    /// As [`Factor::kernels`], into a buffer.
    pub(super) fn kernels_into(&self, kernels: &mut [C]) {
        let first = -self.b[0].inv();
        for (h, b) in kernels.iter_mut().zip(&self.b[1..]) {
            *h = b * first;
        }
    }

    /// Performs a Newton step and returns its size relative to the factor. At a branch point, where the solution is
    /// not unique, the factor is left unchanged.
    ///
    /// The equation for k = 0 is replaced by the sum of all, (Σ b)² = D(1) = σ: the original one would lose the
    /// digits of σ compared with 2Σa, and an exterior with a small stiffness to the ground causes an error that
    /// grows with the square of time.
    fn correct(&mut self, sigma: C) -> f64 {
        let n = self.b.len();
        let (b, a) = (&self.b, self.stencil.weights());
        let sum: C = b.iter().sum();
        self.step[0] = sigma - sum * sum;
        self.system[..n].fill(2.0 * sum);
        for k in 1..n {
            let product: C = b.iter().zip(&b[k..]).map(|(x, y)| x * y).sum();
            self.step[k] = -a[k - 1] - product;
            let row = &mut self.system[k * n..(k + 1) * n];
            for (i, entry) in row.iter_mut().enumerate() {
                let above = b.get(i + k).copied().unwrap_or_default();
                let below = if i >= k { b[i - k] } else { C::default() };
                *entry = above + below;
            }
        }
        if !solve(&mut self.system, &mut self.step) {
            return f64::INFINITY;
        }
        let square = |x: &[C]| x.iter().map(C::norm_sqr).sum::<f64>();
        let size = (square(&self.step) / square(&self.b)).sqrt();
        if size.is_finite() {
            for (b, step) in self.b.iter_mut().zip(&self.step) {
                *b += step;
            }
        }
        size
    }
}

/// Solves a small system by Gaussian elimination with row pivoting; the matrix (row by row) is overwritten. Returns
/// false if it is singular.
fn solve(matrix: &mut [C], x: &mut [C]) -> bool {
    let n = x.len();
    for p in 0..n {
        let size = |i: &usize| matrix[i * n + p].norm_sqr();
        let pivot = (p..n).max_by(|i, j| size(i).total_cmp(&size(j)));
        let Some(pivot) = pivot.filter(|i| size(i) > 0.0) else {
            return false;
        };
        if pivot != p {
            x.swap(pivot, p);
            let (above, below) = matrix.split_at_mut(pivot * n);
            above[p * n + p..(p + 1) * n].swap_with_slice(&mut below[p..n]);
        }
        let inverse = matrix[p * n + p].inv();
        let (above, below) = matrix.split_at_mut((p + 1) * n);
        let row = &above[p * n + p + 1..];
        for (i, other) in below.chunks_exact_mut(n).enumerate() {
            let factor = other[p] * inverse;
            for (entry, of_pivot) in other[p + 1..].iter_mut().zip(row) {
                *entry -= factor * of_pivot;
            }
            let pivot = x[p];
            x[p + 1 + i] -= factor * pivot;
        }
    }
    for p in (0..n).rev() {
        let known: C = matrix[p * n + p + 1..(p + 1) * n]
            .iter()
            .zip(&x[p + 1..])
            .map(|(a, x)| a * x)
            .sum();
        x[p] = (x[p] - known) / matrix[p * n + p];
    }
    true
}

/// Zeros of centre − 2 Σ a_k T_k(x).
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

/// Eigenvalues of a complex matrix; NaN if the iteration does not converge.
pub(super) fn eigenvalues(matrix: DMatrix<C>) -> Vec<C> {
    let count = matrix.nrows();
    match Schur::try_new(matrix, f64::EPSILON, ITERATIONS * count) {
        Some(schur) => schur.unpack().1.diagonal().iter().copied().collect(),
        None => vec![C::new(f64::NAN, f64::NAN); count],
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
