//! Stability limits of the coarse step, and growth of short waves with the paper's predictor.
//!
//! All modes of a small clamped plate are excited; growth is that of the square root of its energy per coarse step.
//! The rates depend on the plate and on the position of its fine region.

use pericles::Interrupt;
use pericles_run::{Assembly, RunError};

use super::problem::{Method, Problem};
use crate::data::{Case, Found};

/// Growth per step between two step numbers, for ω dt of the part that limits the coarse step.
fn growth_between(
    case: &Case<'_>,
    choice: &[String],
    omega_dt: f64,
    [from, to]: [u64; 2],
) -> Result<f64, RunError> {
    const BURST: f64 = 1e200;
    let Assembly {
        mut system,
        mut state,
        mut integrator,
        frequency,
        ..
    } = Problem::of(case)?.assembly(Method::of(case, "method")?, choice)?;
    let Some(frequency) = frequency else {
        return Ok(f64::NAN);
    };
    let dt = omega_dt / frequency.estimate;
    integrator.start(&mut system, &mut state);
    let mut energies = [0.0; 2];
    for step in 1..=to {
        let t_next = step as f64 * dt;
        integrator.step(&mut system, &mut state, t_next, Interrupt::never())?;
        for (energy, at) in energies.iter_mut().zip([from, to]) {
            if step == at {
                *energy =
                    system.kinetic_energy(&state.v) + system.operator().energy(state.t, &state.u);
            }
        }
        if step.is_multiple_of(64) && system.kinetic_energy(&state.v) > BURST {
            return Ok(f64::INFINITY);
        }
    }
    Ok(0.5 * (energies[1] / energies[0]).ln() / (to - from) as f64)
}

/// Largest ω dt between 0.8 and 1 times `most` without growth, to three thousandths.
pub(super) fn limit(case: &Case<'_>) -> Result<Found, RunError> {
    /// Threshold above the bounded oscillations of the energy.
    const GROWS: f64 = 2e-4;
    let most = case.number("most")?;
    let (mut low, mut high) = (0.8 * most, most);
    while high - low > 3e-3 * most {
        let middle = 0.5 * (low + high);
        if growth_between(case, &[], middle, [300, 1300])? > GROWS {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(low.into())
}

/// Growth at ω dt = 1 over many steps; 0 for decay.
pub(super) fn growth(case: &Case<'_>) -> Result<Found, RunError> {
    Ok(growth_between(case, &[], 1.0, [500, 20_000])?
        .max(0.0)
        .into())
}

/// Growth at ω dt = `omega` with the overrides `choice`, also relative to the `rate` of the independent code, and
/// without them, up to the stability `limit`.
pub(super) fn rates(case: &Case<'_>) -> Result<Found, RunError> {
    let (omega_dt, rate) = (case.number("omega")?, case.number("rate")?);
    // Slow growth becomes visible late, after the other modes have been damped.
    let span = match rate < 1e-4 {
        true => [100_000, 200_000],
        false => [10_000, 20_000],
    };
    let found = growth_between(case, &case.texts("choice")?, omega_dt, span)?;
    let stable = omega_dt.min(0.98 * case.number("limit")?);
    let ours = growth_between(case, &[], stable, [1_000, 3_000])?;
    Ok([
        ("growth", found),
        ("over rate", found / rate),
        ("ours", ours.max(0.0)),
    ]
    .into())
}
