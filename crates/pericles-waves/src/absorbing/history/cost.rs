//! Cost estimates that select the cheapest form of the history.

use crate::absorbing::blocks::BLOCK;
use crate::absorbing::fit::sample_count;
use crate::absorbing::{LatticeStencil, LatticeStep};

/// Estimated cost of one absorbing boundary over a run, in multiply–adds, including the kernels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HistoryCost {
    /// K² N² sums, and the kernels.
    pub direct: f64,
    /// Blocks with Fourier transforms, and the kernels.
    pub blocked: f64,
    /// The fit and its exponentials; infinite where the fit would take too long.
    pub exponentials: f64,
}

/// Forms of the history.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HistoryForm {
    /// [`super::DirectHistory`]
    Direct,
    /// [`super::BlockedHistory`]
    Blocked,
    /// [`super::ExponentialHistory`]
    Exponentials,
}

/// Multiply–adds per entry of a transform and halving: 2.5 floating-point operations and their memory traffic.
const TRANSFORM: f64 = 3.0;
/// Multiply–adds of a complex product with operands from memory.
const PRODUCT: f64 = 4.0;

/// Limit on retained singular values; larger fits take tens of seconds.
const MOST_VALUES: f64 = 700.0;

impl HistoryCost {
    /// Estimates the cost for N steps with kernels of reach K.
    pub fn estimate(stencil: &LatticeStencil, step: LatticeStep, steps: usize) -> Self {
        let (reach, n) = (stencil.reach() as f64, steps as f64);
        let square = reach * reach;
        // Every block size of a run processes each step once, in lines of twice its length.
        let online = |near: f64, lines: f64, products: f64| {
            let mut cost = near * n * BLOCK as f64 / 2.0;
            let mut size = BLOCK as f64;
            while size < n {
                cost += n * (2.0 * lines * TRANSFORM * (2.0 * size).log2() + products * PRODUCT);
                size *= 2.0;
            }
            cost
        };
        // Three points of the upper half circle per step, each with an elimination of K + 1 complex unknowns.
        let elimination = (reach + 1.0).powi(3) / 3.0 + 4.0 * square;
        let kernels = 3.0 * n * PRODUCT * elimination;
        let points = sample_count(stencil, step, steps) as f64;
        let branches = stencil.stationary_frequencies().len() as f64;
        // Retained singular values, measured for one to twenty branches; half of them are exponentials, the others
        // their conjugates.
        let rank = 0.3 * points * branches.sqrt();
        let exponentials = if rank > MOST_VALUES {
            f64::INFINITY
        } else {
            // Crosses, singular values and eigenvalues; least squares.
            let fit = 35.0 * rank.powi(3) + 16.0 * points * rank * rank;
            fit + n * 0.5 * rank * (4.0 * reach + 4.0)
        };
        Self {
            direct: kernels + 0.5 * square * n * n,
            blocked: kernels + online(square, 3.0 * reach - 1.0, square),
            exponentials,
        }
    }

    /// Returns the cheapest form; exponentials only if an error is allowed.
    pub fn cheapest(&self, exact: bool) -> HistoryForm {
        if !exact && self.exponentials < self.direct.min(self.blocked) {
            HistoryForm::Exponentials
        } else if self.direct < self.blocked {
            HistoryForm::Direct
        } else {
            HistoryForm::Blocked
        }
    }
}
