//! Solvers for implicit schemes: conjugate gradients, Newton–Krylov, Anderson acceleration, banded Cholesky
//! factorisation, and principal axes and inverses of 3 × 3 matrices.
//!
//! A linear system is given by its matrix–vector products, a nonlinear one by its residual and the products with
//! its derivative ([`Nonlinear`]). Both must be symmetric and positive definite, as the matrices M + β dt² K of
//! implicit schemes are, with positive mass M and stiffness K = −f′.
//!
//! Sums have a fixed order, so that results do not depend on the number of threads. Solvers keep their vectors in
//! [`Work`], which is allocated once.
//!
//! References: Hestenes & Stiefel, J. Res. NBS 49 (1952); Eisenstat & Walker, SIAM J. Sci. Comput. 17 (1996).
//!
//! ```
//! use pericles::solve::{SolveLimits, Work, conjugate_gradient};
//! // −x″ = 1 on a line of points with both ends fixed
//! let n = 50;
//! let mut apply = |x: &[f64], out: &mut [f64]| {
//!     for i in 0..n {
//!         let left = if i > 0 { x[i - 1] } else { 0.0 };
//!         let right = if i + 1 < n { x[i + 1] } else { 0.0 };
//!         out[i] = 2.0 * x[i] - left - right;
//!     }
//! };
//! let mut x = vec![0.0; n];
//! let solved = conjugate_gradient(&mut apply, &vec![1.0; n], &mut x, &SolveLimits::default(), &mut Work::new(n)).unwrap();
//! assert!((x[0] - 25.0).abs() < 1e-10 && solved.iterations <= n);
//! ```

mod anderson;
mod axes;
mod cholesky;
mod conjugate_gradient;
mod newton;

pub use anderson::Anderson;
pub use axes::{inverse, principal_axes};
pub use cholesky::BandedCholesky;
pub use conjugate_gradient::conjugate_gradient;
pub use newton::{Nonlinear, newton_krylov};

use crate::domain::Domain;
use crate::interrupt::Interrupt;

/// Stopping criteria of an iteration.
#[derive(Debug, Clone, Copy)]
pub struct SolveLimits<'a> {
    /// Largest norm of the residual relative to that of the right-hand side (conjugate gradients) or to the given
    /// scale (Newton).
    pub relative: f64,
    /// Largest norm of the residual independent of the right-hand side.
    pub absolute: f64,
    /// Largest number of iterations.
    pub iterations: usize,
    /// Polled in every iteration; the solver fails with
    /// [`PericlesError::Interrupted`](crate::PericlesError::Interrupted) if a stop is requested.
    pub interrupt: Interrupt<'a>,
}

impl Default for SolveLimits<'_> {
    /// A residual of 1e-12 in at most 1000 iterations.
    fn default() -> Self {
        Self {
            relative: 1e-12,
            absolute: 0.0,
            iterations: 1000,
            interrupt: Interrupt::never(),
        }
    }
}

impl SolveLimits<'_> {
    fn tolerance(&self, scale: f64) -> f64 {
        self.absolute.max(self.relative * scale)
    }
}

/// Statistics of a solution.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Solved {
    /// Iterations of Newton's method, or of conjugate gradients if used alone.
    pub iterations: usize,
    /// Number of products with the matrix or derivative.
    pub products: usize,
    /// Norm of the last residual.
    pub residual: f64,
}

/// Work vectors of solvers, allocated once for systems of one size.
#[derive(Debug, Clone)]
pub struct Work {
    /// Domain over which sums are taken.
    domain: Domain,
    /// Conjugate gradients: residual, direction, product.
    krylov: [Vec<f64>; 3],
    /// Newton: residual, right-hand side, correction, trial point.
    newton: [Vec<f64>; 4],
}

impl Work {
    /// Makes work vectors for `n` unknowns, all owned by this process.
    pub fn new(n: usize) -> Self {
        Self::on(&Domain::alone(n), n)
    }

    /// Makes work vectors for the `n` unknowns that this process owns.
    pub fn on(domain: &Domain, n: usize) -> Self {
        Self {
            domain: domain.clone(),
            krylov: std::array::from_fn(|_| vec![0.0; n]),
            newton: std::array::from_fn(|_| vec![0.0; n]),
        }
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> usize {
        (self.krylov.len() + self.newton.len()) * self.krylov[0].len() * size_of::<f64>()
    }
}

/// y += factor x
fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}
