//! Least squares with linear equations and a lower bound.
//!
//! Minimises ‖A α − b‖² subject to C α = d and α ≥ l. Equations are eliminated by a basis of their null space; the
//! bound leads to a least-distance problem that non-negative least squares solves (Lawson & Hanson 1974, chapters
//! 20 and 23), a finite method for this convex quadratic program. The active bounds are then fixed and the
//! remaining problem is solved again by orthogonal factorisation, so the result has no more error than the
//! equations themselves.

use crate::DispersionError;
use nalgebra::{DMatrix, DVector};

use pericles::Result;

use super::bounded::bounded;
use super::least_squares::{Rejection, least_squares};

/// Least-squares problem in n unknowns.
#[derive(Debug, Clone)]
pub(super) struct Problem {
    /// Matrix A.
    pub rows: DMatrix<f64>,
    /// Right-hand side b.
    pub values: DVector<f64>,
    /// Constraint matrix C.
    pub equations: DMatrix<f64>,
    /// Constraint values d.
    pub targets: DVector<f64>,
    /// Lower bound l.
    pub lower: Option<f64>,
}

/// Solution of a [`Problem`].
#[derive(Debug, Clone)]
pub(super) struct Solution {
    /// The unknowns.
    pub alpha: DVector<f64>,
    /// Unknowns at the bound.
    pub active: Vec<usize>,
    /// Condition number of the least-squares part with columns scaled to equal length; 1 if the equations determine
    /// all unknowns.
    pub condition: f64,
    /// Violation of the optimality conditions relative to ‖b‖ (columns scaled to equal length).
    pub kkt: f64,
}

/// Relative residual above which equations count as inconsistent.
const INCONSISTENT: f64 = 1e-9;

/// Set of solutions of the equations: `origin + basis · y`.
struct Affine {
    origin: DVector<f64>,
    basis: DMatrix<f64>,
}

impl Affine {
    fn new(
        equations: &DMatrix<f64>,
        targets: &DVector<f64>,
    ) -> std::result::Result<Self, Rejection> {
        let n = equations.ncols();
        let mut range: Vec<DVector<f64>> = Vec::new();
        let norms: Vec<f64> = equations.row_iter().map(|row| row.norm()).collect();
        let largest = norms.iter().copied().fold(0.0, f64::max);
        for row in equations.row_iter() {
            push_orthogonal(&mut range, row.transpose(), 1e-10 * largest);
        }
        let rank = range.len();
        let mut all = range;
        // Unit vectors complete the basis, those farthest from its span first.
        while all.len() < n {
            let left = (0..n).map(|c| {
                let covered: f64 = all.iter().map(|q| q[c] * q[c]).sum();
                1.0 - covered
            });
            let farthest = left
                .enumerate()
                .max_by(|a, b| a.1.total_cmp(&b.1))
                .map_or(0, |(c, _)| c);
            let unit = DVector::from_fn(n, |c, _| f64::from(u8::from(c == farthest)));
            push_orthogonal(&mut all, unit, 0.0);
        }
        let columns = |part: &[DVector<f64>]| match part {
            [] => DMatrix::zeros(n, 0),
            _ => DMatrix::from_columns(part),
        };
        let (range, basis) = (columns(&all[..rank]), columns(&all[rank..]));
        let origin = if rank == 0 {
            DVector::zeros(n)
        } else {
            &range * least_squares(&(equations * &range), targets)?.0
        };
        let error = (equations * &origin - targets).norm() / targets.norm().max(f64::MIN_POSITIVE);
        if error > INCONSISTENT {
            return Err(Rejection::Inconsistent(error));
        }
        Ok(Self { origin, basis })
    }
}

/// Appends the part of `vector` orthogonal to the others if it is longer than `shortest`. Two orthogonalisations
/// suffice (Kahan).
fn push_orthogonal(basis: &mut Vec<DVector<f64>>, mut vector: DVector<f64>, shortest: f64) {
    for _ in 0..2 {
        for q in basis.iter() {
            let share = q.dot(&vector);
            vector.axpy(-share, q, 1.0);
        }
    }
    let norm = vector.norm();
    if norm > shortest {
        basis.push(vector / norm);
    }
}

impl Problem {
    /// Solves the problem.
    pub fn solve(&self) -> std::result::Result<Solution, Rejection> {
        let affine = Affine::new(&self.equations, &self.targets)?;
        let rows = &self.rows * &affine.basis;
        let values = &self.values - &self.rows * &affine.origin;
        let (y, condition) = least_squares(&rows, &values)?;
        let alpha = &affine.origin + &affine.basis * &y;
        let violated = |lower: &f64| !alpha.iter().all(|a| a >= lower);
        let (alpha, active, condition) = match self.lower.filter(violated) {
            None => (alpha, Vec::new(), condition),
            Some(_) if affine.basis.ncols() == 0 => return Err(Rejection::Infeasible),
            Some(lower) => {
                let margin = affine.origin.map(|a| lower - a);
                let (y, active) = bounded(&rows, &values, &affine.basis, &margin)?;
                let found = &affine.origin + &affine.basis * y;
                let (alpha, condition) = self
                    .with_fixed(&active, lower)
                    .unwrap_or((found, condition));
                (alpha, active, condition)
            }
        };
        let kkt = self.kkt(&alpha, &active);
        Ok(Solution {
            alpha,
            active,
            condition,
            kkt,
        })
    }

    /// Returns the solution with some unknowns fixed at the bound; `None` if it violates the bound elsewhere.
    fn with_fixed(&self, fixed: &[usize], lower: f64) -> Option<(DVector<f64>, f64)> {
        let n = self.rows.ncols();
        let free: Vec<usize> = (0..n).filter(|c| !fixed.contains(c)).collect();
        let mut alpha = DVector::zeros(n);
        for c in fixed {
            alpha[*c] = lower;
        }
        let equations = self.equations.select_columns(&free);
        let targets = &self.targets - &self.equations * &alpha;
        let affine = Affine::new(&equations, &targets).ok()?;
        let rows = self.rows.select_columns(&free);
        let values = &self.values - &self.rows * &alpha - &rows * &affine.origin;
        let (y, condition) = least_squares(&(&rows * &affine.basis), &values).ok()?;
        let part = &affine.origin + &affine.basis * y;
        for (k, c) in free.iter().enumerate() {
            alpha[*c] = part[k];
        }
        let slack = 1e-10 * alpha.amax();
        alpha
            .iter()
            .all(|a| *a >= lower - slack)
            .then_some((alpha, condition))
    }

    /// Returns the violation of Aᵀ(Aα − b) + Cᵀλ − μ = 0, with μ ≥ 0 on active bounds and zero elsewhere, and of
    /// α ≥ l.
    fn kkt(&self, alpha: &DVector<f64>, active: &[usize]) -> f64 {
        let n = alpha.len();
        let gradient = self.rows.transpose() * (&self.rows * alpha - &self.values);
        // In unknowns scaled such that every column of A has length one.
        let scale = DVector::from_iterator(
            n,
            self.rows
                .column_iter()
                .map(|c| if c.norm() > 0.0 { 1.0 / c.norm() } else { 1.0 }),
        );
        let gradient = gradient.component_mul(&scale);
        let equations = self.equations.nrows();
        let mut normals = DMatrix::zeros(n, equations + active.len());
        for e in 0..equations {
            for c in 0..n {
                normals[(c, e)] = self.equations[(e, c)] * scale[c];
            }
        }
        for (k, c) in active.iter().enumerate() {
            normals[(*c, equations + k)] = -1.0;
        }
        let reference = self.values.norm().max(f64::MIN_POSITIVE);
        let right = -&gradient;
        let Ok(multipliers) = normals.clone().svd(true, true).solve(&right, 1e-12) else {
            return f64::NAN;
        };
        let stationary = (gradient + normals * &multipliers).amax() / reference;
        let sign = (equations..equations + active.len())
            .map(|k| -multipliers[k] / reference)
            .fold(0.0, f64::max);
        let below = self.lower.map_or(0.0, |lower| {
            alpha.iter().map(|a| lower - a).fold(0.0, f64::max) / alpha.amax()
        });
        stationary.max(sign).max(below)
    }

    /// Finds the largest feasible bound by bisection.
    fn largest_bound(&self) -> f64 {
        let feasible = |lower: f64| {
            let n = self.rows.ncols();
            let nearest = Self {
                rows: DMatrix::identity(n, n),
                values: DVector::zeros(n),
                lower: Some(lower),
                ..self.clone()
            };
            nearest.solve().is_ok()
        };
        let (mut low, mut high) = (-1.0, 1.0);
        while !feasible(low) && low > -1e12 {
            (low, high) = (2.0 * low, low);
        }
        while feasible(high) && high < 1e12 {
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if feasible(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Converts a rejection to an error message.
    pub fn rejected(&self, rejection: Rejection, ratio: f64) -> DispersionError {
        let classes = self.rows.ncols();
        match rejection {
            Rejection::Inconsistent(error) => DispersionError::Anisotropic {
                classes,
                ratio,
                error,
            },
            Rejection::Undetermined { rank, unknowns } => {
                DispersionError::Undetermined { rank, unknowns }
            }
            Rejection::Infeasible => DispersionError::InfeasibleBound {
                bound: self.lower.unwrap_or(f64::NEG_INFINITY),
                classes,
                largest: self.largest_bound(),
            },
        }
    }

    /// Solves the problem; failures are converted to an error message.
    pub fn solution(&self, ratio: f64) -> Result<Solution> {
        Ok(self
            .solve()
            .map_err(|rejection| self.rejected(rejection, ratio))?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn problem(seed: &[f64], n: usize, lower: f64) -> Problem {
        let entry = |k: usize| seed[k % seed.len()] * (1.0 + (k as f64 * 0.7).sin());
        Problem {
            rows: DMatrix::from_fn(n + 3, n, |r, c| {
                entry(r * n + c) + f64::from(u8::from(r == c))
            }),
            values: DVector::from_fn(n + 3, |r, _| entry(7 * r + 1)),
            equations: DMatrix::from_fn(1, n, |_, c| 1.0 + 0.1 * c as f64),
            targets: DVector::from_element(1, 3.0),
            lower: Some(lower),
        }
    }

    proptest! {
        /// Compares with the best of all active sets.
        #[test]
        fn bounded_solution_is_the_best_of_all_active_sets(seed in prop::collection::vec(-2.0f64..2.0, 41), n in 2usize..6, lower in -0.5f64..0.3) {
            let problem = problem(&seed, n, lower);
            let Ok(found) = problem.solve() else { return Ok(()); };
            let cost = |alpha: &DVector<f64>| (&problem.rows * alpha - &problem.values).norm();
            let best = (0..1usize << n)
                .filter_map(|set| {
                    let fixed: Vec<usize> = (0..n).filter(|c| set >> c & 1 == 1).collect();
                    let (alpha, _) = if fixed.len() < n { problem.with_fixed(&fixed, lower)? } else { return None };
                    Some(cost(&alpha))
                })
                .fold(f64::INFINITY, f64::min);
            prop_assert!(cost(&found.alpha) <= best * (1.0 + 1e-9), "{} {}", cost(&found.alpha), best);
            prop_assert!(found.alpha.iter().all(|a| *a >= lower - 1e-9));
            prop_assert!(found.kkt < 1e-9, "{}", found.kkt);
            prop_assert!((&problem.equations * &found.alpha - &problem.targets).amax() < 1e-12);
        }
    }

    #[test]
    fn infeasible_bounds_report_the_largest_feasible_one() {
        // α₀ + 1.1 α₁ = 3 and both at least l: l ≤ 3/2.1.
        let problem = problem(&[0.3, -0.7, 1.1], 2, 1.5);
        let Err(rejection) = problem.solve() else {
            panic!("1.5 is too large")
        };
        let error = problem.rejected(rejection, 1.0);
        let DispersionError::InfeasibleBound { largest, .. } = error else {
            panic!("{error}")
        };
        assert!((largest - 3.0 / 2.1).abs() < 1e-8, "{largest}");
    }

    #[test]
    fn inconsistent_equations_are_detected() {
        let mut problem = problem(&[0.3, -0.7, 1.1], 3, 0.0);
        problem.equations = DMatrix::from_row_slice(2, 3, &[1.0, 1.0, 0.0, 2.0, 2.0, 0.0]);
        problem.targets = DVector::from_row_slice(&[1.0, 1.0]);
        assert!(matches!(problem.solve(), Err(Rejection::Inconsistent(_))));
    }
}
