//! Least squares with bounds, for functions that are expensive to evaluate.
//!
//! The minimum of S = ½ Σ r_i² over a box is found by Levenberg–Marquardt steps of a trust region (Nielsen, Damping parameter
//! in Marquardt's method, IMM-REP-1999-05) that are projected onto the box (Kanzow, Yamashita & Fukushima, J. Comput. Appl.
//! Math. 172, 2004). Derivatives are differences to one side; their evaluations are independent and are requested together. At
//! the minimum they are central: errors of the first order in the step would make dependent parameters look independent.

/// Numbers that control the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Control {
    /// Step of the differences, as a fraction of the scale of a parameter.
    pub step: f64,
    /// The search ends when no parameter changes by more than this fraction of its scale.
    pub tolerance: f64,
    /// Maximum number of evaluations.
    pub most: usize,
}

/// A parameter: where its search starts, its bounds, and the size of its changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    pub start: f64,
    pub low: f64,
    pub high: f64,
    pub scale: f64,
}

/// The best values found.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Minimum {
    pub values: Vec<f64>,
    pub residuals: Vec<f64>,
    /// ∂r_i/∂p_j at the values, a row per residual; a column is zero if its parameter does not matter.
    pub jacobian: Vec<Vec<f64>>,
    /// Whether the steps have become smaller than the tolerance.
    pub converged: bool,
    /// Number of evaluations.
    pub evaluations: usize,
}

/// Returns the residuals for each list of values. The evaluation of a trial may fail; its answer is then `None`.
pub(super) type Evaluate<'a, E> =
    dyn FnMut(&[Vec<f64>], Kind) -> Result<Vec<Option<Vec<f64>>>, E> + 'a;

/// The purpose of evaluations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// They are needed: a failure ends the search.
    Needed,
    /// They are tried: after a failed step a shorter one is tried, and differences are taken to the other side.
    Trial,
}

/// Minimises ½ Σ r² over the ranges.
///
/// # Errors
/// Those of the evaluations.
pub(super) fn minimise<E>(
    ranges: &[Range],
    control: &Control,
    evaluate: &mut Evaluate<'_, E>,
) -> Result<Minimum, E> {
    let mut search = Search {
        ranges,
        control,
        evaluate,
        evaluations: 0,
    };
    let start: Vec<f64> = ranges.iter().map(|range| range.start).collect();
    let residuals = search.needed(vec![start.clone()])?.swap_remove(0);
    search.descend(start, residuals)
}

struct Search<'a, 'b, E> {
    ranges: &'a [Range],
    control: &'a Control,
    evaluate: &'a mut Evaluate<'b, E>,
    evaluations: usize,
}

impl<E> Search<'_, '_, E> {
    fn needed(&mut self, lists: Vec<Vec<f64>>) -> Result<Vec<Vec<f64>>, E> {
        self.evaluations += lists.len();
        let found = (self.evaluate)(&lists, Kind::Needed)?;
        // Evaluations that are needed return an error instead of None.
        Ok(found.into_iter().flatten().collect())
    }

    fn trial(&mut self, values: &[f64]) -> Result<Option<Vec<f64>>, E> {
        self.evaluations += 1;
        let found = (self.evaluate)(&[values.to_vec()], Kind::Trial)?;
        Ok(found.into_iter().next().flatten())
    }

    fn descend(&mut self, mut values: Vec<f64>, mut residuals: Vec<f64>) -> Result<Minimum, E> {
        let count = values.len();
        let mut converged = false;
        let mut jacobian = self.jacobian(&values, &residuals)?;
        let mut damping = None;
        let mut growth = 2.0;
        // A step and the derivatives at its end need one evaluation and two per parameter.
        while !converged && self.evaluations + 1 + 2 * count <= self.control.most {
            let (normal, gradient) = normal_equations(self.ranges, &jacobian, &residuals);
            let largest = (0..count).map(|j| normal[j][j]).fold(0.0, f64::max);
            let free: Vec<usize> = (0..count)
                .filter(|&j| normal[j][j] > 0.0 && !self.is_held(j, values[j], gradient[j]))
                .collect();
            if free.is_empty() {
                converged = true;
                break;
            }
            let mu = *damping.get_or_insert(1e-3 * largest);
            let step = solve(&normal, &gradient, &free, mu);
            let next: Vec<f64> = (0..count)
                .map(|j| {
                    let range = &self.ranges[j];
                    (values[j] + step[j] * range.scale).clamp(range.low, range.high)
                })
                .collect();
            let moved = |j: usize| (next[j] - values[j]) / self.ranges[j].scale;
            let longest = (0..count).map(|j| moved(j).abs()).fold(0.0, f64::max);
            if longest <= self.control.tolerance {
                converged = true;
                break;
            }
            let promised: f64 = (0..count)
                .map(|j| {
                    let curved: f64 = (0..count).map(|k| normal[j][k] * moved(k)).sum();
                    -moved(j) * (gradient[j] + 0.5 * curved)
                })
                .sum();
            let trial = self.trial(&next)?;
            let gained = |trial: &Vec<f64>| half_square(&residuals) - half_square(trial);
            match trial.filter(|trial| gained(trial) > 0.0) {
                Some(better) => {
                    let ratio = gained(&better) / promised.max(f64::MIN_POSITIVE);
                    damping = Some(mu * (1.0 - (2.0 * ratio - 1.0).powi(3)).max(1.0 / 3.0));
                    growth = 2.0;
                    (values, residuals) = (next, better);
                    jacobian = self.jacobian(&values, &residuals)?;
                }
                None => {
                    damping = Some(mu * growth);
                    growth *= 2.0;
                }
            }
        }
        let jacobian = self.centred(&values, &residuals, jacobian)?;
        Ok(Minimum {
            values,
            residuals,
            jacobian,
            converged,
            evaluations: self.evaluations,
        })
    }

    /// Returns the step of the differences of a parameter, to the side within the bounds.
    fn step(&self, j: usize, value: f64) -> f64 {
        let range = &self.ranges[j];
        let step = self.control.step * range.scale;
        match value + step <= range.high {
            true => step,
            false => -step,
        }
    }

    /// Returns ∂r/∂p by differences to the side within the bounds.
    fn jacobian(&mut self, values: &[f64], residuals: &[f64]) -> Result<Vec<Vec<f64>>, E> {
        let changed: Vec<Vec<f64>> = (0..values.len())
            .map(|j| {
                let mut moved = values.to_vec();
                moved[j] += self.step(j, values[j]);
                moved
            })
            .collect();
        let found = self.needed(changed.clone())?;
        let row = |i: usize| {
            let entry = |j: usize| (found[j][i] - residuals[i]) / (changed[j][j] - values[j]);
            (0..values.len()).map(entry).collect()
        };
        Ok((0..residuals.len()).map(row).collect())
    }

    /// Returns ∂r/∂p by central differences, from those to one side. Parameters at bounds, and those whose evaluation fails,
    /// keep theirs.
    fn centred(
        &mut self,
        values: &[f64],
        residuals: &[f64],
        mut jacobian: Vec<Vec<f64>>,
    ) -> Result<Vec<Vec<f64>>, E> {
        let mirrored = (0..values.len()).map(|j| (j, values[j] - self.step(j, values[j])));
        let within: Vec<(usize, f64)> = mirrored
            .filter(|&(j, value)| (self.ranges[j].low..=self.ranges[j].high).contains(&value))
            .collect();
        let lists: Vec<Vec<f64>> = within
            .iter()
            .map(|&(j, value)| {
                let mut moved = values.to_vec();
                moved[j] = value;
                moved
            })
            .collect();
        self.evaluations += lists.len();
        let found = (self.evaluate)(&lists, Kind::Trial)?;
        for ((j, value), found) in within.into_iter().zip(found) {
            let Some(found) = found else { continue };
            for (i, row) in jacobian.iter_mut().enumerate() {
                row[j] = 0.5 * (row[j] + (found[i] - residuals[i]) / (value - values[j]));
            }
        }
        Ok(jacobian)
    }

    /// Returns whether a parameter is at a bound beyond which the sum decreases.
    fn is_held(&self, j: usize, value: f64, slope: f64) -> bool {
        let range = &self.ranges[j];
        (value <= range.low && slope > 0.0) || (value >= range.high && slope < 0.0)
    }
}

/// Returns JᵀJ and Jᵀr for parameters in units of their scales.
fn normal_equations(
    ranges: &[Range],
    jacobian: &[Vec<f64>],
    residuals: &[f64],
) -> (Vec<Vec<f64>>, Vec<f64>) {
    let count = ranges.len();
    let scaled = |i: usize, j: usize| jacobian[i][j] * ranges[j].scale;
    let sum = |j: usize, k: usize| {
        (0..residuals.len())
            .map(|i| scaled(i, j) * scaled(i, k))
            .sum()
    };
    let normal = (0..count).map(|j| (0..count).map(|k| sum(j, k)).collect());
    let slope = |j: usize| {
        (0..residuals.len())
            .map(|i| scaled(i, j) * residuals[i])
            .sum()
    };
    (normal.collect(), (0..count).map(slope).collect())
}

/// Returns ½ Σ r².
fn half_square(residuals: &[f64]) -> f64 {
    0.5 * residuals.iter().map(|r| r * r).sum::<f64>()
}

/// Solves (JᵀJ + μ) d = −Jᵀr for the free parameters; the others do not move.
fn solve(normal: &[Vec<f64>], gradient: &[f64], free: &[usize], mu: f64) -> Vec<f64> {
    let matrix: Vec<Vec<f64>> = free
        .iter()
        .map(|&j| {
            let entry = |&k: &usize| normal[j][k] + if j == k { mu } else { 0.0 };
            free.iter().map(entry).collect()
        })
        .collect();
    let right: Vec<f64> = free.iter().map(|&j| -gradient[j]).collect();
    let mut step = vec![0.0; gradient.len()];
    for (&j, value) in free.iter().zip(solved(matrix, right)) {
        step[j] = value;
    }
    step
}

/// Solves a symmetric positive definite system by elimination.
fn solved(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for pivot in 0..n {
        for row in pivot + 1..n {
            let factor = matrix[row][pivot] / matrix[pivot][pivot];
            for column in pivot..n {
                matrix[row][column] -= factor * matrix[pivot][column];
            }
            right[row] -= factor * right[pivot];
        }
    }
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|k| matrix[row][k] * right[k]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    right
}

/// Returns the standard errors of the parameters: the square roots of the diagonal of s² (JᵀJ)⁻¹, with the variance
/// s² = Σ r²/(N − n) of N residuals and n parameters. NaN for parameters that the residuals do not determine, or if
/// N ≤ n. `step` is that of the differences.
pub(super) fn standard_errors(minimum: &Minimum, ranges: &[Range], step: f64) -> Vec<f64> {
    let (rows, count) = (minimum.residuals.len(), ranges.len());
    if rows <= count {
        return vec![f64::NAN; count];
    }
    let variance = 2.0 * half_square(&minimum.residuals) / (rows - count) as f64;
    let (normal, _) = normal_equations(ranges, &minimum.jacobian, &minimum.residuals);
    let error = |j: usize| {
        let unit = (0..count).map(|k| if j == k { 1.0 } else { 0.0 }).collect();
        let inverse = solved(normal.clone(), unit)[j];
        // The sine of the angle between a column and the others; central differences have errors of the order step².
        let is_determined = inverse > 0.0 && (inverse * normal[j][j]).sqrt() * step < 1.0;
        match is_determined {
            true => (variance * inverse).sqrt() * ranges[j].scale,
            false => f64::NAN,
        }
    };
    (0..count).map(error).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONTROL: Control = Control {
        step: 1e-4,
        tolerance: 1e-8,
        most: 400,
    };

    fn range(start: f64, low: f64, high: f64) -> Range {
        Range {
            start,
            low,
            high,
            scale: start.abs(),
        }
    }

    fn minimum(ranges: &[Range], residuals: impl Fn(&[f64]) -> Option<Vec<f64>>) -> Minimum {
        let mut evaluate = |lists: &[Vec<f64>], kind: Kind| {
            let found: Vec<Option<Vec<f64>>> = lists.iter().map(|list| residuals(list)).collect();
            let failed = kind == Kind::Needed && found.iter().any(Option::is_none);
            if failed { Err("failed") } else { Ok(found) }
        };
        minimise(ranges, &CONTROL, &mut evaluate).unwrap()
    }

    #[test]
    fn the_valley_of_rosenbrock_is_followed_to_its_end() {
        let rosenbrock = |p: &[f64]| Some(vec![10.0 * (p[1] - p[0] * p[0]), 1.0 - p[0]]);
        let found = minimum(&[range(-1.2, -5.0, 5.0), range(1.0, -5.0, 5.0)], rosenbrock);
        assert!(found.converged);
        assert!((found.values[0] - 1.0).abs() < 1e-6, "{found:?}");
        assert!((found.values[1] - 1.0).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn a_minimum_on_a_bound_is_found_along_it() {
        // Without bounds the minimum is (3, 1); on p₀ ≤ 2 it is p₁ = 3/2 because of the coupling.
        let linear = |p: &[f64]| Some(vec![p[0] - 3.0, p[0] + p[1] - 4.0, p[1] - 1.0]);
        let found = minimum(&[range(1.0, 0.0, 2.0), range(0.5, 0.0, 9.0)], linear);
        assert!(found.converged);
        assert_eq!(found.values[0], 2.0);
        assert!((found.values[1] - 1.5).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn failed_trials_shorten_the_step() {
        let narrow = |p: &[f64]| (p[0] < 1.5).then(|| vec![p[0].ln() - 1.4_f64.ln()]);
        let found = minimum(&[range(0.1, 0.01, 100.0)], narrow);
        assert!((found.values[0] - 1.4).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn standard_errors_are_those_of_a_straight_line() {
        // y = a + b x through (0, 0), (1, 1), (2, 1): b = 1/2, a = 1/6, s² = 1/6, var b = s²/2, var a = s² 5/6.
        let points = [(0.0, 0.0), (1.0, 1.0), (2.0, 1.0)];
        let line = |p: &[f64]| {
            let residual = |(x, y): &(f64, f64)| p[0] + p[1] * x - y;
            Some(points.iter().map(residual).collect())
        };
        let ranges = [range(1.0, -9.0, 9.0), range(2.0, -9.0, 9.0)];
        let found = minimum(&ranges, line);
        assert!((found.values[0] - 1.0 / 6.0).abs() < 1e-8, "{found:?}");
        let errors = standard_errors(&found, &ranges, CONTROL.step);
        assert!(
            (errors[0] - (5.0_f64 / 36.0).sqrt()).abs() < 1e-6,
            "{errors:?}"
        );
        assert!(
            (errors[1] - (1.0_f64 / 12.0).sqrt()).abs() < 1e-6,
            "{errors:?}"
        );
        // A parameter without influence has no error.
        let ranges = [ranges[0], ranges[1], range(1.0, 0.0, 2.0)];
        let found = minimum(&ranges, |p| line(&p[..2]));
        assert_eq!(found.values[2], 1.0);
        let errors = standard_errors(&found, &ranges, CONTROL.step);
        assert!(errors[2].is_nan(), "{errors:?}");
    }

    #[test]
    fn parameters_with_the_same_effect_are_not_determined() {
        // The motion of a bar depends on the ratio of stiffness and density only. Noise of 1e-5 hides what differences leave.
        let ranges = [range(210.0, 21.0, 2100.0), range(7.85, 0.785, 78.5)];
        let motion = |values: &[f64], offset: f64| -> Vec<f64> {
            let frequency = (values[0] / values[1]).sqrt();
            let times = (0..30).map(|k| 0.1 * f64::from(k));
            times
                .map(|t| (frequency * t).sin() + offset * t + 1e-5 * (1e3 * t).sin())
                .collect()
        };
        let control = Control {
            step: 1e-2,
            tolerance: 1e-3,
            most: 60,
        };
        let fitted = |ranges: &[Range], model: &dyn Fn(&[f64]) -> Vec<f64>| {
            let mut evaluate = |lists: &[Vec<f64>], _: Kind| {
                Ok::<_, ()>(lists.iter().map(|list| Some(model(list))).collect())
            };
            let found = minimise(ranges, &control, &mut evaluate).unwrap();
            standard_errors(&found, ranges, control.step)
        };
        let truth = motion(&[190.0, 7.85], 0.0);
        let distance = |found: Vec<f64>| -> Vec<f64> {
            found.iter().zip(&truth).map(|(a, b)| a - b).collect()
        };
        let errors = fitted(&ranges, &|values| distance(motion(values, 0.0)));
        assert!(errors.iter().all(|error| error.is_nan()), "{errors:?}");
        // A term that depends on the stiffness alone separates them.
        let stiffness = |values: &[f64]| motion(values, 190.0 / values[0] - 1.0);
        let errors = fitted(&ranges, &|values| distance(stiffness(values)));
        assert!(errors.iter().all(|error| error.is_finite()), "{errors:?}");
    }
}
