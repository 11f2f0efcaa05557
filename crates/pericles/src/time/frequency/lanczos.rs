//! Lanczos iteration for the largest eigenvalue, with an upper bound.
//!
//! **Estimate.** The largest Ritz value θ after k products is a lower bound of the largest eigenvalue λ.
//!
//! **Bound** (van Dorsselaer, Hochstenbach & van der Vorst, SIAM J. Matrix Anal. Appl. 22 (2000) 837–852). With the
//! coefficients α_j, β_j of the iteration and the eigenvector v of λ, (q_{k+1}, v) Π β_j = χ_k(λ) (q_1, v), where
//! χ_k is the characteristic polynomial of the tridiagonal matrix. The left inner product is at most one, so that
//! χ_k(λ) ≤ Π β_j/|(q_1, v)|. Above θ the polynomial increases, and λ is below the point where it reaches Π β_j/τ
//! unless |(q_1, v)| < τ. The random start vector determines the probability of that: its entries are independent,
//! symmetric and uniform (times the root of the inverse mass) with standard deviation σ. (q_1, v)‖x‖ is then a sum
//! of independent log-concave variables, itself log-concave with standard deviation σ, and the density of such a
//! variable is at most 1/(√2 σ): |(q_1, v)| < τ has a probability of at most √2 τ‖x‖/σ. τ follows from
//! [`FAILURE`](super::FAILURE). The matrix need not be positive definite.
//!
//! **Rounding.** Without reorthogonalisation the vectors lose their orthogonality once a Ritz value has converged.
//! The recurrence of the products with v is perturbed by about 1e-16 per step, far below τ, so that the bound
//! remains valid; copies of converged values do not change the upper end.

use crate::domain::Domain;
use crate::noise::noise_on;

/// A symmetric matrix M⁻¹K in the inner product of the masses.
pub(super) struct Problem<'a> {
    pub product: &'a dyn Fn(&[f64], &mut [f64]),
    pub mass: &'a (dyn Fn(usize) -> f64 + Sync),
    pub domain: &'a Domain,
}

/// State of the iteration.
pub(super) struct Lanczos<'a> {
    problem: Problem<'a>,
    current: Vec<f64>,
    previous: Vec<f64>,
    next: Vec<f64>,
    diagonal: Vec<f64>,
    off: Vec<f64>,
    /// ln 1/τ; `None` for start vectors that are not random.
    depth: Option<f64>,
}

/// Lower and upper bound of the largest eigenvalue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Enclosure {
    /// Largest Ritz value, a lower bound.
    pub estimate: f64,
    /// Upper bound; infinite for start vectors that are not random.
    pub bound: f64,
}

impl<'a> Lanczos<'a> {
    /// Starts from a vector; `None` if it is zero.
    pub fn from_vector(problem: Problem<'a>, start: Vec<f64>) -> Option<Self> {
        let mut lanczos = Self {
            previous: vec![0.0; start.len()],
            next: vec![0.0; start.len()],
            current: start,
            problem,
            diagonal: Vec::new(),
            off: Vec::new(),
            depth: None,
        };
        let norm = lanczos.inner(&lanczos.current, &lanczos.current).sqrt();
        if !(norm > 0.0 && norm.is_finite()) {
            return None;
        }
        scale(&mut lanczos.current, 1.0 / norm);
        Some(lanczos)
    }

    /// Starts from a random vector, the same in every run, with the entries that `hold` sets to zero removed;
    /// `None` if no entry remains.
    pub fn from_noise(
        problem: Problem<'a>,
        entries: usize,
        failure: f64,
        hold: impl Fn(&mut [f64]),
    ) -> Option<Self> {
        let components = entries / problem.domain.owned_points().max(1);
        let mut start = noise_on(problem.domain, components, 0x9E37_79B9_7F4A_7C15);
        hold(&mut start);
        // σ² = 1/3 for numbers uniform in [−1, 1).
        let norm = problem.domain.norm(&start);
        for (k, x) in start.iter_mut().enumerate() {
            *x /= (problem.mass)(k).sqrt();
        }
        let lanczos = Self::from_vector(problem, start)?;
        Some(Self {
            depth: Some((6f64.sqrt() * norm / failure).ln()),
            ..lanczos
        })
    }

    fn inner(&self, x: &[f64], y: &[f64]) -> f64 {
        let mass = self.problem.mass;
        self.problem.domain.sum(x.len(), |k| mass(k) * x[k] * y[k])
    }

    /// Number of products so far.
    pub fn products(&self) -> usize {
        self.diagonal.len()
    }

    /// Performs one more product; returns whether the invariant subspace of the start vector is exhausted.
    pub fn advance(&mut self) -> bool {
        (self.problem.product)(&self.current, &mut self.next);
        let alpha = self.inner(&self.next, &self.current);
        let before = self.off.last().copied().unwrap_or(0.0);
        for k in 0..self.next.len() {
            self.next[k] -= alpha * self.current[k] + before * self.previous[k];
        }
        let beta = self.inner(&self.next, &self.next).sqrt();
        self.diagonal.push(alpha);
        let exhausted = beta <= 1e-12 * (alpha.abs() + before);
        self.off.push(beta.max(f64::MIN_POSITIVE));
        if !exhausted {
            scale(&mut self.next, 1.0 / beta);
            std::mem::swap(&mut self.previous, &mut self.current);
            std::mem::swap(&mut self.current, &mut self.next);
        }
        exhausted
    }

    /// Returns the bounds of the largest eigenvalue.
    pub fn enclosure(&self) -> Enclosure {
        let estimate = largest_eigenvalue(&self.diagonal, &self.off);
        let bound = match self.depth {
            // Bodies without stiffness have no scale for a bound.
            Some(depth) if estimate > 0.0 && estimate.is_finite() => {
                upper_bound(&self.diagonal, &self.off, estimate, depth)
            }
            _ => f64::INFINITY,
        };
        Enclosure { estimate, bound }
    }
}

/// Returns the x above the largest Ritz value at which ln χ(x) − Σ ln β = `depth`.
fn upper_bound(diagonal: &[f64], off: &[f64], ritz: f64, depth: f64) -> f64 {
    let betas: f64 = off.iter().map(|beta| beta.ln()).sum();
    // χ is the product of the pivots of x − T, which are positive above the spectrum.
    let beyond = |x: f64| {
        let (mut sum, mut pivot) = (0.0, f64::INFINITY);
        for (k, alpha) in diagonal.iter().enumerate() {
            let coupling = if k > 0 { off[k - 1].powi(2) } else { 0.0 };
            pivot = x - alpha - coupling / pivot;
            if pivot <= 0.0 {
                return false;
            }
            sum += pivot.ln();
        }
        sum - betas > depth
    };
    let (mut low, mut high) = (0.0, ritz.abs() * 1e-14);
    while !beyond(ritz + high) {
        if !high.is_finite() {
            return f64::INFINITY;
        }
        low = high;
        high *= 2.0;
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if beyond(ritz + middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    ritz + high
}

fn scale(x: &mut [f64], factor: f64) {
    x.iter_mut().for_each(|x| *x *= factor);
}

/// Returns the largest eigenvalue of a symmetric tridiagonal matrix, by bisection.
fn largest_eigenvalue(diagonal: &[f64], off: &[f64]) -> f64 {
    let n = diagonal.len();
    let coupling = |k: usize| off.get(k).copied().unwrap_or(0.0);
    let radius = |k: usize| {
        let before = if k > 0 { coupling(k - 1).abs() } else { 0.0 };
        let after = if k + 1 < n { coupling(k).abs() } else { 0.0 };
        before + after
    };
    let mut high = (0..n).fold(f64::NEG_INFINITY, |m, k| m.max(diagonal[k] + radius(k)));
    let mut low = (0..n).fold(f64::NEG_INFINITY, |m, k| m.max(diagonal[k]));
    // Sturm sequence: all pivots of T − x are negative exactly if x is above every eigenvalue.
    let above = |x: f64| {
        let mut pivot = diagonal[0] - x;
        for k in 1..n {
            if pivot >= 0.0 {
                return false;
            }
            pivot = diagonal[k] - x - coupling(k - 1).powi(2) / pivot;
        }
        pivot < 0.0
    };
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if above(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn largest_eigenvalue_of_a_string_matrix_is_exact() {
        // 2 on the diagonal, −1 next to it: eigenvalues 2 − 2 cos(kπ/(n+1)).
        let n = 40;
        let value = largest_eigenvalue(&vec![2.0; n], &vec![-1.0; n - 1]);
        let angle = std::f64::consts::PI / (n + 1) as f64;
        assert!((value - 2.0 - 2.0 * angle.cos()).abs() < 1e-13);
    }

    #[test]
    fn the_bound_is_above_the_largest_eigenvalue_and_converges_to_it() {
        // Diagonal matrices: a uniform spectrum, and one clustered at its upper end.
        let even: fn(f64) -> f64 = |x| x;
        let crowded: fn(f64) -> f64 = |x| 1.0 - (1.0 - x).powi(4);
        for (spectrum, products, above) in [(even, 150, 8e-3), (crowded, 150, 8e-3)] {
            let n = 5000;
            let values: Vec<f64> = (1..=n).map(|k| spectrum(k as f64 / n as f64)).collect();
            let product = |x: &[f64], y: &mut [f64]| {
                for k in 0..n {
                    y[k] = values[k] * x[k];
                }
            };
            let mass = |k: usize| 1.0 + (k % 7) as f64;
            let domain = Domain::alone(n);
            let problem = Problem {
                product: &product,
                mass: &mass,
                domain: &domain,
            };
            let mut lanczos = Lanczos::from_noise(problem, n, 1e-9, |_| ()).unwrap();
            let mut last = f64::INFINITY;
            for k in 1..=products {
                lanczos.advance();
                let found = lanczos.enclosure();
                assert!(found.estimate <= 1.0 + 1e-12, "{k}: {found:?}");
                assert!(found.bound >= 1.0, "{k}: {found:?}");
                last = found.bound;
            }
            assert!(last < 1.0 + above, "{last}");
        }
    }
}
