//! Minimisation of functionals of absolute residuals.
//!
//! Σ_m (Σ_i w_mi |R_i|)² with w ≥ 0 is convex in the coefficients but not differentiable where a residual vanishes.
//! |R| is replaced by √(R² + ε²), which is still convex, and Newton's method with a line search follows the minimum
//! as ε decreases; each step is a quadratic program with the constraints and the bound.

use nalgebra::{DMatrix, DVector};

use pericles::Result;

use super::functionals::Functionals;
use super::solve::{Problem, Solution};

/// Reduction factor of ε per stage, and its first and last value relative to the largest residual. The last value
/// makes kinks narrower than the distance of quadrature nodes.
const SHRINK: f64 = 0.2;
const FIRST: f64 = 0.1;
const LAST: f64 = 1e-7;
const STEPS: usize = 40;

pub(super) struct Absolute<'a> {
    functionals: &'a Functionals,
    rows: DMatrix<f64>,
    values: DVector<f64>,
    branches: usize,
}

/// Second-order expansion of the functional at a point.
struct Expansion {
    value: f64,
    gradient: DVector<f64>,
    hessian: DMatrix<f64>,
}

impl<'a> Absolute<'a> {
    pub fn new(functionals: &'a Functionals, unknowns: usize) -> Self {
        let all = || {
            functionals
                .samples
                .iter()
                .flat_map(|sample| sample.rows.iter().zip(&sample.values))
        };
        let count = all().count();
        Self {
            functionals,
            rows: DMatrix::from_row_iterator(
                count,
                unknowns,
                all().flat_map(|(row, _)| row.iter().copied()),
            ),
            values: DVector::from_iterator(count, all().map(|(_, value)| *value)),
            branches: count.checked_div(functionals.samples.len()).unwrap_or(1),
        }
    }

    /// Minimises the functional; `problem` contains constraints and bound.
    pub fn minimise(&self, problem: &Problem, ratio: f64) -> Result<Solution> {
        let start = Problem {
            rows: self.rows.clone(),
            values: self.values.clone(),
            ..problem.clone()
        };
        let mut solution = start.solution(ratio)?;
        if self.rows.nrows() == 0 {
            return Ok(solution);
        }
        let largest = (&self.rows * &solution.alpha - &self.values).amax();
        let mut epsilon = FIRST * largest;
        while epsilon >= LAST * largest && largest > 0.0 {
            for _ in 0..STEPS {
                let here = self.expand(&solution.alpha, epsilon);
                let next = newton(problem, &solution.alpha, &here).solution(ratio)?;
                let step = &next.alpha - &solution.alpha;
                let promise = -here.gradient.dot(&step);
                let kkt = next.kkt.max(promise.max(0.0) / here.value);
                let mut length = 1.0;
                while self.value(&(&solution.alpha + length * &step), epsilon)
                    > here.value - 1e-4 * length * promise
                    && length > 1e-10
                {
                    length *= 0.5;
                }
                let alpha = &solution.alpha + length * step;
                solution = Solution { alpha, kkt, ..next };
                if kkt < 1e-14 {
                    break;
                }
            }
            epsilon *= SHRINK;
        }
        Ok(solution)
    }

    /// Returns R/√(R² + ε²) and √(R² + ε²) for every row.
    fn smoothed(&self, alpha: &DVector<f64>, epsilon: f64) -> (DVector<f64>, DVector<f64>) {
        let mut residual = -self.values.clone();
        residual.gemv(1.0, &self.rows, alpha, 1.0);
        let absolute = residual.map(|r| r.hypot(epsilon));
        (residual.component_div(&absolute), absolute)
    }

    /// Value F_m of every functional.
    fn functional(&self, absolute: &DVector<f64>) -> Vec<f64> {
        let places: Vec<f64> = absolute
            .as_slice()
            .chunks(self.branches)
            .map(|place| place.iter().sum())
            .collect();
        let sum = |weights: &Vec<f64>| weights.iter().zip(&places).map(|(w, r)| w * r).sum();
        self.functionals.weights.iter().map(sum).collect()
    }

    fn value(&self, alpha: &DVector<f64>, epsilon: f64) -> f64 {
        let (_, absolute) = self.smoothed(alpha, epsilon);
        self.functional(&absolute).iter().map(|f| f * f).sum()
    }

    fn expand(&self, alpha: &DVector<f64>, epsilon: f64) -> Expansion {
        let n = alpha.len();
        let (slope, absolute) = self.smoothed(alpha, epsilon);
        let sums = self.functional(&absolute);
        let mut gradient = DVector::<f64>::zeros(n);
        let mut hessian = DMatrix::<f64>::zeros(n, n);
        let mut bend = vec![0.0; slope.len()];
        for (weights, f) in self.functionals.weights.iter().zip(&sums) {
            let tilt = DVector::from_fn(slope.len(), |r, _| weights[r / self.branches] * slope[r]);
            let own = self.rows.tr_mul(&tilt);
            gradient.axpy(2.0 * f, &own, 1.0);
            hessian.ger(2.0, &own, &own, 1.0);
            for r in 0..bend.len() {
                bend[r] += 2.0 * f * weights[r / self.branches];
            }
        }
        let mut bent = self.rows.clone();
        for r in 0..bend.len() {
            let curvature = bend[r] * epsilon * epsilon / absolute[r].powi(3);
            bent.row_mut(r).scale_mut(curvature);
        }
        hessian += self.rows.tr_mul(&bent);
        Expansion {
            value: sums.iter().map(|f| f * f).sum(),
            gradient,
            hessian,
        }
    }
}

/// Quadratic program of a Newton step from α: minimise ½ (x−α)·H(x−α) + g·(x−α), written as least squares with the
/// Cholesky factor of H.
fn newton(problem: &Problem, alpha: &DVector<f64>, here: &Expansion) -> Problem {
    let n = alpha.len();
    let mut ridge = 1e-14 * here.hessian.diagonal().amax();
    let factor = loop {
        let raised = &here.hessian + DMatrix::identity(n, n) * ridge;
        if let Some(factor) = raised.cholesky() {
            break factor.unpack();
        }
        ridge = (10.0 * ridge).max(f64::MIN_POSITIVE);
    };
    let rows = factor.transpose();
    let right = factor
        .solve_lower_triangular(&here.gradient)
        .unwrap_or_else(|| DVector::zeros(n));
    Problem {
        values: &rows * alpha - right,
        rows,
        ..problem.clone()
    }
}
