//! Convergence of conjugate gradients, which shows when the preconditioner is outdated.

use crate::krylov::{End, Solution};

/// Convergence of the linear problems of a load step with one preconditioner.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Convergence {
    /// Least number of products by which a residual fell by a factor of ten.
    least: Option<f64>,
    /// Number of products in excess of the least number.
    excess: f64,
}

impl Convergence {
    /// Adds a solution.
    pub fn note(&mut self, solved: &Solution) {
        /// The first products of a solution are not typical.
        const SHORTEST: f64 = 0.5;
        let decades = (solved.first / solved.residual).log10();
        if solved.end != End::Reached || !decades.is_finite() || decades < SHORTEST {
            return;
        }
        let products = solved.products as f64;
        let rate = products / decades;
        let least = self.least.map_or(rate, |least| least.min(rate));
        self.least = Some(least);
        self.excess += products - least * decades;
    }

    /// Returns whether the preconditioner has become so inaccurate that a new one takes less time.
    pub fn is_outdated(&self) -> bool {
        /// Number of products, with the preconditioner, that take as long as a new preconditioner.
        const COST: f64 = 40.0;
        self.excess > COST
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn preconditioner_is_outdated_when_solutions_take_many_more_products_than_the_best_one() {
        let solution = |products, decades: i32| Solution {
            products,
            residual: 10f64.powi(-decades),
            first: 1.0,
            end: End::Reached,
        };
        let mut convergence = Convergence::default();
        for _ in 0..20 {
            convergence.note(&solution(15, 6));
            convergence.note(&solution(5, 2));
        }
        assert!(!convergence.is_outdated());
        for _ in 0..3 {
            convergence.note(&solution(30, 6));
        }
        assert!(convergence.is_outdated());
    }
}
