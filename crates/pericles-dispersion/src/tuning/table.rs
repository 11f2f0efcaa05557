//! Tuning of a model.

use crate::DispersionError;
use nalgebra::{DMatrix, DVector};

use crate::vector::{Vector, dot};
use pericles::kernel::{ActsOn, ClassTable, Influence, InfluenceFunction};
use pericles::{PericlesError, Result, positive};

use super::absolute::Absolute;
use super::functionals::{Functionals, Quadrature};
use super::method::{Combination, Method, Tuning};
use super::model::{Assessment, BondClass, ScalingModel};
use super::samples::Sample;
use super::solve::Problem;

/// Tuned coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct TunedTable {
    /// Options of the tuning problem.
    pub tuning: Tuning,
    /// Bond classes in the order of the coefficients.
    pub classes: Vec<BondClass>,
    /// Coefficient α of each class.
    pub alpha: Vec<f64>,
    /// Classes at the lower bound.
    pub active: Vec<usize>,
    /// Condition number of the least-squares part (columns scaled to equal length). Round-off in the coefficients
    /// is about this times 1e-16.
    pub condition: f64,
    /// Relative violation of the optimality conditions. For absolute values, whose functional is smoothed, the
    /// larger of it and the relative decrease predicted for one more Newton step.
    pub kkt: f64,
    /// Remaining values of the functionals, one row for each with an entry per branch (pressure, then shear),
    /// divided by V² and with the spacing as unit: (∮ R²)^½ for least squares, ∮ |R| for the absolute method,
    /// otherwise F_m(R) (F_m(|R|) for the absolute combination). Residuals include their weights.
    pub functionals: Vec<Vec<f64>>,
    /// Errors, constraints and stability.
    pub assessment: Assessment,
}

impl TunedTable {
    /// Returns the influence function for a grid of the given spacing, m.
    ///
    /// # Errors
    /// The spacing is not positive.
    pub fn influence(&self, dimension: usize, spacing: f64) -> Result<Influence> {
        let entries: Vec<_> = self
            .classes
            .iter()
            .zip(&self.alpha)
            .map(|(class, alpha)| (class.offset, *alpha))
            .collect();
        Ok(Influence {
            function: InfluenceFunction::Classes(ClassTable::new(dimension, spacing, &entries)?),
            acts_on: ActsOn::Stretch,
        })
    }
}

impl ScalingModel {
    /// Computes the coefficients.
    ///
    /// All problems satisfy the long-wave constraints: Σ i α_i = N²/2 in 1D, otherwise C₁₁₁₁ = V_p² and C₁₁₂₂ =
    /// V_s². Every bond-based lattice has C₁₂₁₂ = C₁₁₂₂; with C₁₁₁₁ = 3 C₁₁₂₂ long waves are isotropic.
    ///
    /// # Errors
    /// Unsupported combinations of options, weights that are not positive, a lattice that cannot be isotropic, an
    /// infeasible bound.
    pub fn tune(&self, tuning: Tuning) -> Result<TunedTable> {
        self.check(&tuning)?;
        let absolute =
            tuning.method == Method::Absolute || tuning.combination == Combination::Absolute;
        let quadrature = if absolute {
            Quadrature::Kinks
        } else {
            Quadrature::Smooth
        };
        let mut functionals = Functionals::new(self, tuning.method, quadrature);
        for sample in &mut functionals.samples {
            weigh(sample, &tuning);
        }
        let solution = if absolute {
            Absolute::new(&functionals, self.classes().len())
                .minimise(&self.problem(Vec::new(), &tuning), self.horizon_ratio())?
        } else if tuning.method == Method::LeastSquares {
            let rows = functionals.samples.iter().zip(&functionals.weights[0]);
            let root = |(sample, weight): (&Sample, &f64)| scaled(sample, weight.sqrt());
            self.problem(rows.flat_map(root).collect(), &tuning)
                .solution(self.horizon_ratio())?
        } else {
            self.problem(integrated(&functionals, tuning.combination), &tuning)
                .solution(self.horizon_ratio())?
        };
        let alpha: Vec<f64> = solution.alpha.iter().copied().collect();
        Ok(TunedTable {
            tuning,
            classes: self.classes().to_vec(),
            functionals: residuals(&functionals, &tuning, &alpha),
            assessment: self.assess(&alpha)?,
            alpha,
            active: solution.active,
            condition: solution.condition,
            kkt: solution.kkt,
        })
    }

    /// As [`ScalingModel::tune`]. If there is no bound and the coefficients make the lattice unstable, the problem
    /// is solved again with the bound zero: without negative coefficients no wave is unstable.
    ///
    /// In 3D signed coefficients are unstable for most horizons, in 2D for some horizons of four spacings and more.
    ///
    /// # Errors
    /// As [`ScalingModel::tune`].
    pub fn tune_stable(&self, tuning: Tuning) -> Result<TunedTable> {
        let free = self.tune(tuning)?;
        if free.assessment.stability.is_stable() || tuning.lower_bound.is_some() {
            return Ok(free);
        }
        let bounded = self.tune(Tuning {
            lower_bound: Some(0.0),
            ..tuning
        });
        // Without a bounded solution the caller finds the instability in the assessment.
        Ok(bounded.unwrap_or(free))
    }

    fn check(&self, tuning: &Tuning) -> Result<()> {
        positive("the weight of pressure waves", tuning.weights.pressure)?;
        positive("the weight of shear waves", tuning.weights.shear)?;
        if let Some(decay) = tuning.weights.decay {
            positive("the wavenumber of the weight's decay", decay)?;
        }
        if tuning.lower_bound.is_some_and(|bound| !bound.is_finite()) {
            return Err(PericlesError::OutOfRange {
                quantity: "the lower bound of the coefficients",
                value: tuning.lower_bound.unwrap_or(f64::NAN),
                allowed: "a finite number (usually 0.5)",
            });
        }
        let reject = |choice, with, allowed| {
            Err(DispersionError::TuningChoice {
                choice,
                with,
                allowed,
            }
            .into())
        };
        let plain = tuning.combination == Combination::Separated;
        match tuning.method {
            Method::LiteralGalerkin if self.state().dimension() > 1 => reject(
                "the literal Galerkin method",
                "in two and three dimensions",
                "allowed there: least-squares, point-collocation, subdomain-collocation, galerkin, absolute",
            ),
            Method::LeastSquares if !plain => reject(
                "the least-squares method",
                "with this combination of branches",
                "allowed: separated",
            ),
            Method::Absolute if tuning.combination == Combination::SignedSum => reject(
                "the absolute method",
                "with signed sums",
                "allowed: separated, absolute (equivalent here)",
            ),
            _ => Ok(()),
        }
    }

    fn problem(&self, rows: Vec<Row>, tuning: &Tuning) -> Problem {
        let (equations, targets) = self.equations();
        let unknowns = self.classes().len();
        Problem {
            rows: DMatrix::from_fn(rows.len(), unknowns, |r, c| rows[r].0[c]),
            values: DVector::from_fn(rows.len(), |r, _| rows[r].1),
            equations: equations.clone(),
            targets: targets.clone(),
            lower: tuning.lower_bound,
        }
    }
}

/// Equation row · α = value.
struct Row(Vec<f64>, f64);

fn scaled(sample: &Sample, factor: f64) -> Vec<Row> {
    let rows = sample.rows.iter().zip(&sample.values);
    rows.map(|(row, value)| Row(row.iter().map(|x| x * factor).collect(), value * factor))
        .collect()
}

/// Functionals of each branch, or of the sum of the branches.
fn integrated(functionals: &Functionals, combination: Combination) -> Vec<Row> {
    let mut all = Vec::new();
    for weights in &functionals.weights {
        let mut sums: Vec<Row> = Vec::new();
        for (sample, weight) in functionals.samples.iter().zip(weights) {
            for (branch, row) in scaled(sample, *weight).into_iter().enumerate() {
                let place = if combination == Combination::SignedSum {
                    0
                } else {
                    branch
                };
                match sums.get_mut(place) {
                    Some(sum) => {
                        sum.0.iter_mut().zip(&row.0).for_each(|(s, x)| *s += x);
                        sum.1 += row.1;
                    }
                    None => sums.push(row),
                }
            }
        }
        all.extend(sums);
    }
    all
}

/// Remaining value of each functional, branch by branch.
fn residuals(functionals: &Functionals, tuning: &Tuning, alpha: &[f64]) -> Vec<Vec<f64>> {
    let squares = tuning.method == Method::LeastSquares;
    let absolute = tuning.method == Method::Absolute || tuning.combination == Combination::Absolute;
    let branches = functionals.samples.first().map_or(0, |s| s.rows.len());
    let value = |weights: &[f64], branch: usize| -> f64 {
        let terms = functionals.samples.iter().zip(weights).map(|(sample, w)| {
            let row = sample.rows[branch].iter().zip(alpha);
            let residual = row.map(|(b, a)| b * a).sum::<f64>() - sample.values[branch];
            match (squares, absolute) {
                (true, _) => w * residual * residual,
                (_, true) => w * residual.abs(),
                _ => w * residual,
            }
        });
        let sum: f64 = terms.sum();
        if squares { sum.max(0.0).sqrt() } else { sum }
    };
    let rows = functionals.weights.iter();
    rows.map(|weights| (0..branches).map(|b| value(weights, b)).collect())
        .collect()
}

/// Multiplies the residuals by their weights.
fn weigh(sample: &mut Sample, tuning: &Tuning) {
    let weights = tuning.weights;
    let near = weights.decay.map_or(1.0, |decay| decayed(sample.k, decay));
    for branch in 0..sample.rows.len() {
        let factor = near
            * if branch == 0 {
                weights.pressure
            } else {
                weights.shear
            };
        sample.rows[branch].iter_mut().for_each(|x| *x *= factor);
        sample.values[branch] *= factor;
    }
}

fn decayed(k: Vector, decay: f64) -> f64 {
    (-dot(k, k) / (decay * decay)).exp()
}
