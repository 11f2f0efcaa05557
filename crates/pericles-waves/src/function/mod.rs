//! Functions of the stiffness operator applied to vectors: the exact flow of a linear body.
//!
//! With A = M⁻¹K (symmetric in the inner product of the masses, eigenvalues ω² ≥ 0) and W = A^½, free motion over a
//! time τ is u′ = cos(τW) u + τ sinc(τW) v, v′ = −W sin(τW) u + cos(τW) v. All functions here are entire functions
//! of A, so no square root of a matrix is computed and zero modes (rigid motion) are exact.
//!
//! | [`WaveFunction`] | as a function of ω² | limit at ω = 0 |
//! |---|---|---|
//! | `Cosine` | cos τω | 1 |
//! | `Sine` | sin(τω)/ω = τ sinc τω | τ |
//! | `Slope` | −ω sin τω | 0 |
//! | `Versine` | (1 − cos τω)/ω² | τ²/2 |
//!
//! | engine | requires | products with A for accuracy 1e-15 | use |
//! |---|---|---|---|
//! | [`Chebyshev`] | a bound of ω² | about τω/2 + 6 (τω)^⅓ + 12 | the default: any operator, any τ |
//! | [`Diagonal`](pericles::operator::Diagonal) | a periodic homogeneous body | two transforms | the fastest where available ([`LinearOperator::as_diagonal`](pericles::operator::LinearOperator::as_diagonal)) |
//! | [`Lanczos`] | an inner product | about the same degree, with m stored vectors and O(m² n) additional work | if no bound is known |
//! | [`Eigenvectors`] | O(n²) memory, O(n³) time once | n once | reference, n up to some thousand |
//!
//! Sources: N. J. Higham, Functions of Matrices (SIAM 2008), ch. 13; M. Hochbruck & A. Ostermann, Exponential
//! integrators, Acta Numerica 19 (2010); the coefficients from cos(a cos φ) = J₀(a) + 2 Σ (−1)^k J_2k(a) cos 2kφ
//! (DLMF 10.12.3).
//!
//! ```
//! use pericles::Interrupt;
//! use pericles_waves::function::{Chebyshev, MatrixFunction, Term, WaveFunction};
//! // One oscillator, ω = 2: cos(2 · 1.5).
//! let mut apply = |x: &[f64], out: &mut [f64]| out[0] = 4.0 * x[0];
//! let mut u = [0.0];
//! let terms = &mut [Term::new(WaveFunction::Cosine, 1.5, &mut u)];
//! Chebyshev::new(5.0, 1).add(&mut apply, &[1.0], terms, Interrupt::never()).unwrap();
//! assert!((u[0] - 3.0f64.cos()).abs() < 1e-15);
//! ```

mod bessel;
mod chebyshev;
mod eigenvectors;
mod lanczos;

pub use bessel::bessel_into;
pub use chebyshev::Chebyshev;
pub use eigenvectors::Eigenvectors;
pub use lanczos::Lanczos;

use pericles::{Interrupt, Result};

/// Entire function of A = W² for a time τ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WaveFunction {
    /// cos τW
    Cosine,
    /// τ sinc τW
    Sine,
    /// −W sin τW
    Slope,
    /// (1 − cos τW) W⁻²: response at τ to a constant acceleration
    Versine,
    /// (τ − sin(τW) W⁻¹) W⁻²: response to the acceleration s at the time s
    Ramp,
    /// (τ²/2 − (1 − cos τW) W⁻²) W⁻²: response to s²/2
    Parabola,
    /// (τ³/6 − (τ − sin(τW) W⁻¹) W⁻²) W⁻²: response to s³/6
    Cubic,
}

impl WaveFunction {
    /// Number of integrations over τ that give the function from cos τW; `None` for the slope, its derivative.
    pub(crate) fn integrations(self) -> Option<usize> {
        match self {
            Self::Slope => None,
            Self::Cosine => Some(0),
            Self::Sine => Some(1),
            Self::Versine => Some(2),
            Self::Ramp => Some(3),
            Self::Parabola => Some(4),
            Self::Cubic => Some(5),
        }
    }

    /// Value at an eigenvalue ω²; values made negative by round-off count as zero.
    pub fn value(self, tau: f64, square: f64) -> f64 {
        let omega = square.max(0.0).sqrt();
        let angle = tau * omega;
        match self {
            Self::Cosine => angle.cos(),
            Self::Sine if angle.abs() < 1e-4 => tau * (1.0 - angle * angle / 6.0),
            Self::Sine => angle.sin() / omega,
            Self::Slope => -omega * angle.sin(),
            // 2 sin²(a/2)/ω² avoids cancellation.
            Self::Versine if angle.abs() < 1e-4 => 0.5 * tau * tau * (1.0 - angle * angle / 12.0),
            Self::Versine => 2.0 * ((0.5 * angle).sin() / omega).powi(2),
            Self::Ramp => response(Self::Sine, tau, omega, 3),
            Self::Parabola => response(Self::Versine, tau, omega, 4),
            Self::Cubic => response(Self::Ramp, tau, omega, 5),
        }
    }
}

/// The n-th integral of cos τω over τ, (τ^(n−2)/(n−2)! − the integral n − 2)/ω²; by its power series where the difference
/// cancels.
fn response(lower: WaveFunction, tau: f64, omega: f64, n: u32) -> f64 {
    let factorial = |n: u32| (1..=n).map(f64::from).product::<f64>();
    let angle = tau * omega;
    if angle > 2.0 {
        let first = tau.powi(n as i32 - 2) / factorial(n - 2);
        return (first - lower.value(tau, omega * omega)) / (omega * omega);
    }
    let (mut term, mut sum) = (tau.powi(n as i32) / factorial(n), 0.0);
    for j in (1..).step_by(2) {
        let next = sum + term;
        if next == sum {
            break;
        }
        sum = next;
        term *= -angle * angle / (f64::from(n + j) * f64::from(n + j + 1));
    }
    sum
}

/// Requested contribution `out` += factor · g(A) x.
pub struct Term<'a> {
    /// Function g.
    pub function: WaveFunction,
    /// Time τ ≥ 0, s.
    pub tau: f64,
    /// The factor.
    pub factor: f64,
    /// Vector to which the result is added.
    pub out: &'a mut [f64],
}

impl<'a> Term<'a> {
    /// Creates a term with factor 1.
    pub fn new(function: WaveFunction, tau: f64, out: &'a mut [f64]) -> Self {
        Self::times(1.0, function, tau, out)
    }

    /// Creates a term with a given factor.
    pub fn times(factor: f64, function: WaveFunction, tau: f64, out: &'a mut [f64]) -> Self {
        Self {
            function,
            tau,
            factor,
            out,
        }
    }

    /// Value of factor · g at an eigenvalue.
    pub fn value(&self, square: f64) -> f64 {
        self.factor * self.function.value(self.tau, square)
    }
}

/// Operator x ↦ A x.
pub type Product<'a> = dyn FnMut(&[f64], &mut [f64]) + 'a;

/// Engine that computes functions of an operator given by its products with vectors.
pub trait MatrixFunction: Send {
    /// Adds g(A) x for every term.
    ///
    /// # Errors
    /// Iterative engines return an error if they do not converge, and check `interrupt` before every product.
    fn add(
        &mut self,
        apply: &mut Product<'_>,
        x: &[f64],
        terms: &mut [Term<'_>],
        interrupt: Interrupt<'_>,
    ) -> Result<()>;
}
