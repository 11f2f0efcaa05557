//! Coupling of the two steps of multirate schemes: predicted fine points for coarse stages, interpolated coarse
//! points for fine stages.

use super::Tableau;
use super::runge_kutta::Stages;
use super::zone::Sum;
use crate::archive::{Archive, Checkpointed, Layout, Values};
use crate::error::Result;

/// Prediction of the displacements of fine points at the stages of the coarse step. For order r an error of O(dt^r)
/// is sufficient.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Predictor {
    /// u + x v + x²/2 a (+ x³/6 (a − a₋₁)/dt for order four), with the known acceleration at the start of the step.
    /// Stable up to the full limit of the method.
    #[default]
    Structured,
    /// Derivatives of the velocity from backward differences, as in the original method (Liu, Sun, Tian, Don & Ju
    /// 2024). Weakly unstable: keep ω dt below 0.5 and do not use it for long runs.
    BackwardDifference,
}

/// Interpolation of the displacements of coarse points at the stages of fine steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Interpolant {
    /// The cubic through displacements and velocities at both ends.
    #[default]
    Hermite,
    /// The stages of the coarse step, weighted to give intermediate values of the order of the method, as in the
    /// original method. Growth below the stability limit was observed on one of two bodies with stiffer fine points
    /// (RK4, M = 4, sixteen-fold stiffness, at ω dt = 2.4 of 2.83).
    Stages,
}

impl Predictor {
    /// Name in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Structured => "structured",
            Self::BackwardDifference => "backward-difference",
        }
    }

    /// Number of earlier levels that are needed.
    pub(super) fn levels(self, order: u32) -> usize {
        match self {
            Self::Structured => order as usize - 3,
            Self::BackwardDifference => order as usize - 2,
        }
    }

    /// Returns u(x) − u for a time x after the start of a step, from the state there and from history.
    pub(super) fn at<'a>(
        self,
        order: u32,
        x: f64,
        v: &'a [f64],
        a: &'a [f64],
        history: &'a History,
    ) -> Sum<'a> {
        let sum = Sum::new().plus(x, v);
        let (square, cube) = (0.5 * x * x, x * x * x / 6.0);
        let past = &history.levels;
        match (self, order) {
            (Self::Structured, 3) => sum.plus(square, a),
            (Self::Structured, _) => {
                let slope = cube / past[0].dt;
                sum.plus(square + slope, a).plus(-slope, &past[0].array)
            }
            (Self::BackwardDifference, 3) => {
                let slope = square / past[0].dt;
                sum.plus(slope, v).plus(-slope, &past[0].array)
            }
            (Self::BackwardDifference, _) => {
                // Newton's form, for steps of any length: v' = [n,n−1] + h₁ [n,n−1,n−2], v'' = 2 [n,n−1,n−2].
                let (h1, h2) = (past[0].dt, past[1].dt);
                let second = (square * h1 + 2.0 * cube) / (h1 + h2);
                sum.plus((square + second) / h1, v)
                    .plus(-(square + second) / h1 - second / h2, &past[0].array)
                    .plus(second / h2, &past[1].array)
            }
        }
    }
}

impl Interpolant {
    /// Name in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hermite => "hermite",
            Self::Stages => "stages",
        }
    }
}

/// A coarse step from (u, v) to (u_next, v_next) with the accelerations of its stages.
pub(super) struct CoarseStep<'a> {
    pub(super) dt: f64,
    pub(super) u: &'a [f64],
    pub(super) v: &'a [f64],
    pub(super) u_next: &'a [f64],
    pub(super) v_next: &'a [f64],
    pub(super) a: Stages<'a>,
}

/// Interpolation within a coarse step.
pub(super) struct Inside {
    kind: Interpolant,
    tableau: Tableau,
}

impl Inside {
    pub(super) fn new(kind: Interpolant, tableau: &Tableau) -> Self {
        Self {
            kind,
            tableau: tableau.clone(),
        }
    }

    /// Returns β(θ): u(θ) = u + dt Σ β_i K_i with the velocities K_i of the stages.
    fn weights(&self, theta: f64) -> [f64; 4] {
        let square = theta * theta;
        match (&self.tableau.weights[..], self.tableau.order) {
            (&[_, b2, b3], _) => [theta - 0.75 * square, b2 * square, b3 * square, 0.0],
            _ => {
                let cube = 2.0 / 3.0 * square * theta;
                [
                    theta - 1.5 * square + cube,
                    square - cube,
                    square - cube,
                    -0.5 * square + cube,
                ]
            }
        }
    }

    /// Returns u(θ) − u.
    pub(super) fn at<'a>(&self, theta: f64, step: &CoarseStep<'a>) -> Sum<'a> {
        let dt = step.dt;
        match self.kind {
            Interpolant::Hermite => {
                let weight = theta * theta * (3.0 - 2.0 * theta);
                let slope = dt * theta * (1.0 - theta);
                // −w u first: at θ = 1 it cancels u exactly and leaves the end of the coarse step.
                Sum::new()
                    .plus(-weight, step.u)
                    .plus(weight, step.u_next)
                    .plus(slope * (1.0 - theta), step.v)
                    .plus(-slope * theta, step.v_next)
            }
            Interpolant::Stages => {
                let weights = &self.weights(theta)[..self.tableau.len()];
                let (mut accelerations, mut velocity) = ([0.0; 4], 0.0);
                for (i, weight) in weights.iter().enumerate() {
                    velocity += weight;
                    for (j, coefficient) in self.tableau.stages[i].iter().enumerate() {
                        accelerations[j] += weight * coefficient;
                    }
                }
                Sum::new().plus(dt * velocity, step.v).plus_all(
                    dt * dt,
                    &accelerations[..weights.len()],
                    |j| step.a.at(j),
                )
            }
        }
    }
}

/// Accelerations or velocities at the starts of previous coarse steps, the latest first.
pub(super) struct History {
    levels: Vec<Level>,
    known: usize,
}

struct Level {
    array: Vec<f64>,
    /// Length of the step that starts there, s.
    dt: f64,
}

impl History {
    pub(super) fn new(levels: usize, entries: usize) -> Self {
        let level = || Level {
            array: vec![0.0; entries],
            dt: 0.0,
        };
        Self {
            levels: (0..levels).map(|_| level()).collect(),
            known: 0,
        }
    }

    /// Returns whether all levels are known.
    pub(super) fn is_complete(&self) -> bool {
        self.known == self.levels.len()
    }

    /// Adds the level at the start of a step of length dt; swaps its array for an unused one.
    pub(super) fn push(&mut self, array: &mut Vec<f64>, dt: f64) {
        if self.levels.is_empty() {
            return;
        }
        self.levels.rotate_right(1);
        std::mem::swap(&mut self.levels[0].array, array);
        self.levels[0].dt = dt;
        self.known = (self.known + 1).min(self.levels.len());
    }
}

impl Checkpointed for History {
    fn save(&self, archive: &mut Archive) {
        let Self { levels, known } = self;
        archive.put("scheme/levels", Values::U64(vec![*known as u64]));
        for (k, Level { array, dt }) in levels.iter().enumerate() {
            let values = Values::F64(array.clone());
            archive.put_as(format!("scheme/level/{k}"), values, Layout::Points);
            archive.put(format!("scheme/level_step/{k}"), Values::F64(vec![*dt]));
        }
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let Self { levels, known } = self;
        let mut stored = [0];
        archive.u64_into("scheme/levels", &mut stored)?;
        *known = (stored[0] as usize).min(levels.len());
        for (k, Level { array, dt }) in levels.iter_mut().enumerate() {
            archive.f64_into(&format!("scheme/level/{k}"), array)?;
            archive.f64_into(&format!("scheme/level_step/{k}"), std::slice::from_mut(dt))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::zone::Zone;

    /// A polynomial and its derivatives.
    fn course(t: f64, degree: u32) -> [f64; 3] {
        let (mut u, mut v, mut a) = (0.0, 0.0, 0.0);
        for k in 0..=degree {
            let factor = 0.7 - 0.3 * f64::from(k);
            u += factor * t.powi(k as i32);
            if k >= 1 {
                v += factor * f64::from(k) * t.powi(k as i32 - 1);
            }
            if k >= 2 {
                a += factor * f64::from(k * (k - 1)) * t.powi(k as i32 - 2);
            }
        }
        [u, v, a]
    }

    #[test]
    fn predictors_are_exact_for_polynomials_of_their_degree() {
        // Also for steps of different lengths.
        for (predictor, order) in [
            (Predictor::Structured, 3),
            (Predictor::Structured, 4),
            (Predictor::BackwardDifference, 3),
            (Predictor::BackwardDifference, 4),
        ] {
            let degree = order - 1;
            let mut history = History::new(predictor.levels(order), 1);
            let times = [0.1, 0.5, 1.2];
            for k in 0..2 {
                let [_, v, a] = course(times[k], degree);
                let mut level = vec![if predictor == Predictor::Structured {
                    a
                } else {
                    v
                }];
                history.push(&mut level, times[k + 1] - times[k]);
            }
            assert!(history.is_complete());
            let [u, v, a] = course(times[2], degree).map(|x| vec![x]);
            let mut out = vec![0.0];
            predictor
                .at(order, 0.3, &v, &a, &history)
                .onto(&u, &Zone::all(1), 1, &mut out);
            let expected = course(1.5, degree)[0];
            assert!((out[0] - expected).abs() < 1e-13, "{predictor:?} {order}");
        }
    }

    #[test]
    fn interpolants_match_both_ends_of_the_step() {
        for tableau in [Tableau::rk3(0.6).unwrap(), Tableau::rk4()] {
            let inside = Inside::new(Interpolant::Stages, &tableau);
            for (found, expected) in inside.weights(1.0).iter().zip(&tableau.weights) {
                assert!((found - expected).abs() < 1e-15);
            }
            let middle: f64 = inside.weights(0.37).iter().sum();
            assert!((middle - 0.37).abs() < 1e-15);
            assert_eq!(inside.weights(0.0), [0.0; 4]);
        }
        let inside = Inside::new(Interpolant::Hermite, &Tableau::rk4());
        let [u, v] = [[0.3], [0.7]];
        let (u_next, v_next) = ([0.1 + 0.2], [1.3]);
        let step = CoarseStep {
            dt: 0.1,
            u: &u,
            v: &v,
            u_next: &u_next,
            v_next: &v_next,
            a: Stages {
                first: &[],
                later: &[],
            },
        };
        let mut out = [0.0];
        let zone = Zone::all(1);
        inside.at(1.0, &step).onto(&u, &zone, 1, &mut out);
        assert_eq!(out, u_next);
        inside.at(0.0, &step).onto(&u, &zone, 1, &mut out);
        assert_eq!(out, u);
    }
}
