//! Linearisation of a force about a displacement.

use super::{Force, LinearOperator, PointSubset};
use crate::sum::sum;

/// d ↦ f′(u₀) d, the derivative of the force density at u₀. About the reference state it is, for every
/// bond-based law, the operator of the linear law.
///
/// The force is f(u₀) + f′(u₀)(u − u₀) up to an error of second order in the relative displacements, measured
/// by [`Linearisation::model_error`].
pub struct Linearisation<'a> {
    operator: &'a dyn Force,
    about: Vec<f64>,
    force: Vec<f64>,
}

impl<'a> Linearisation<'a> {
    /// Creates the linearisation of a force about the displacement `about`, m.
    pub fn new(operator: &'a dyn Force, about: Vec<f64>) -> Self {
        let mut force = vec![0.0; about.len()];
        operator.add_force(0.0, &about, PointSubset::All, &mut force);
        Self {
            operator,
            about,
            force,
        }
    }

    /// Returns ‖f(u) − f(u₀) − f′(u₀)(u − u₀)‖/‖f(u) − f(u₀)‖ with Euclidean norms; zero if the force does
    /// not change.
    pub fn model_error(&self, u: &[f64]) -> f64 {
        let step: Vec<f64> = u
            .iter()
            .zip(&self.about)
            .map(|(u, about)| u - about)
            .collect();
        let (mut linear, mut force) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        self.apply_into(&step, &mut linear);
        self.operator
            .add_force(0.0, u, PointSubset::All, &mut force);
        let change = |k: usize| force[k] - self.force[k];
        let error = sum(u.len(), |k| (change(k) - linear[k]).powi(2));
        let size = sum(u.len(), |k| change(k).powi(2));
        if size > 0.0 {
            (error / size).sqrt()
        } else {
            0.0
        }
    }
}

impl LinearOperator for Linearisation<'_> {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        self.operator.tangent_into(0.0, &self.about, u, out);
    }
}
