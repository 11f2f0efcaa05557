//! Acceleration of fixed-point iterations.

use pericles::domain::Domain;

use crate::sparse::add_multiple;

/// Anderson mixing of a fixed-point iteration x ← g(x): the next iterate is the combination of the last ones whose
/// residuals g(x) − x are least in the Euclidean norm (Walker & Ni, SIAM J. Numer. Anal. 49, 2011).
///
/// Combinations are affine, so that linear constraints of g hold for them too.
pub(crate) struct Mixing {
    depth: usize,
    /// The last value g(x) and its residual.
    last: Option<Iterate>,
    /// Differences of successive iterates, oldest first.
    changes: Vec<Iterate>,
}

/// A value g(x), a scalar that is combined like it, and the residual g(x) − x.
struct Iterate {
    value: Vec<f64>,
    scalar: f64,
    residual: Vec<f64>,
}

impl Iterate {
    fn less(&self, other: &Self) -> Self {
        let change = |new: &[f64], old: &[f64]| -> Vec<f64> {
            new.iter().zip(old).map(|(new, old)| new - old).collect()
        };
        Self {
            value: change(&self.value, &other.value),
            scalar: self.scalar - other.scalar,
            residual: change(&self.residual, &other.residual),
        }
    }
}

impl Mixing {
    /// Combines up to `depth + 1` iterates.
    pub fn new(depth: usize) -> Self {
        Self {
            depth,
            last: None,
            changes: Vec::new(),
        }
    }

    /// Returns the next iterate after x with the value g(x), and the scalar that belongs to it. All processes must call it
    /// together.
    pub fn next(
        &mut self,
        domain: &Domain,
        x: &[f64],
        (value, scalar): (Vec<f64>, f64),
    ) -> (Vec<f64>, f64) {
        let residual = value.iter().zip(x).map(|(g, x)| g - x).collect();
        let here = Iterate {
            value,
            scalar,
            residual,
        };
        if let Some(before) = &self.last {
            if self.changes.len() == self.depth {
                self.changes.remove(0);
            }
            self.changes.push(here.less(before));
        }
        let mut next = (here.value.clone(), here.scalar);
        let weights = self.weights(domain, &here.residual);
        for (change, weight) in self.changes.iter().zip(weights) {
            add_multiple(&mut next.0, -weight, &change.value);
            next.1 -= weight * change.scalar;
        }
        self.last = Some(here);
        next
    }

    /// Returns the coefficients of the differences of residuals whose combination is closest to a residual: the solution of
    /// the normal equations by Cholesky factorisation, in which differences that depend on later ones are left out.
    fn weights(&self, domain: &Domain, residual: &[f64]) -> Vec<f64> {
        let n = self.changes.len();
        let of = |k: usize| &self.changes[k].residual[..];
        // From the newest to the oldest.
        let order: Vec<usize> = (0..n).rev().collect();
        let mut factor = vec![vec![0.0; n]; n];
        let mut right = vec![0.0; n];
        /// Squared sine of the angle below which a difference depends on the others.
        const DEPENDENT: f64 = 1e-12;
        for (row, &k) in order.iter().enumerate() {
            let square = domain.dot(of(k), of(k));
            let mut rest = square;
            for column in 0..row {
                let mut product = domain.dot(of(k), of(order[column]));
                for c in 0..column {
                    product -= factor[row][c] * factor[column][c];
                }
                let pivot = factor[column][column];
                factor[row][column] = if pivot > 0.0 { product / pivot } else { 0.0 };
                rest -= factor[row][column] * factor[row][column];
            }
            factor[row][row] = if rest > DEPENDENT * square {
                rest.sqrt()
            } else {
                0.0
            };
            let mut product = domain.dot(of(k), residual);
            for c in 0..row {
                product -= factor[row][c] * right[c];
            }
            let pivot = factor[row][row];
            right[row] = if pivot > 0.0 { product / pivot } else { 0.0 };
        }
        let mut weights = vec![0.0; n];
        for row in (0..n).rev() {
            let mut value = right[row];
            for below in row + 1..n {
                value -= factor[below][row] * weights[order[below]];
            }
            let pivot = factor[row][row];
            weights[order[row]] = if pivot > 0.0 { value / pivot } else { 0.0 };
        }
        weights
    }
}
