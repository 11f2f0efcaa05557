//! Work of changing temperatures within a step.
//!
//! Heating is the change of the energy with time at fixed displacements, averaged over both ends of a step: one rule
//! for all forces whose energy depends on time through the temperature only.

use crate::step_end::{Path, StepEnd};
use crate::thermal::ThermalExpansion;

/// Returns the change of an energy, a function of time and displacement, with the temperature at fixed displacements,
/// averaged over both ends of a step, J; see [`Force::heating`](super::Force::heating).
pub(super) fn heating_of(
    thermal: Option<&ThermalExpansion>,
    step: &StepEnd<'_>,
    energy: &dyn Fn(f64, &[f64]) -> f64,
) -> f64 {
    let Some(before) = thermal.and_then(|_| step.displacement_before()) else {
        return 0.0;
    };
    // The path to the first static state starts at the unheated body.
    let first = matches!(step.path, Path::Chord { first: true, .. });
    let cold = match first {
        true => f64::NEG_INFINITY,
        false => step.t - step.dt,
    };
    let steady = thermal.is_none_or(|thermal| thermal.is_steady());
    if !first && (steady || step.dt == 0.0) {
        return 0.0;
    }
    let gain = |u: &[f64]| energy(step.t, u) - energy(cold, u);
    let mean = 0.5 * (gain(&before) + gain(step.u));
    match first {
        // The energy of the state before is computed for the heated body.
        true => mean + energy(cold, &before) - energy(step.t - step.dt, &before),
        false => mean,
    }
}
