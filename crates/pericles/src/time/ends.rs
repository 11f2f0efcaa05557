//! Boundaries that act within an implicit step, and the rounding errors of its equation.

use crate::boundary::ImplicitBoundary;
use crate::noise::noise_on;
use crate::system::System;

/// Actions of the boundaries within a step; all have one if the scheme requires
/// [`BoundariesWithinStep`](crate::Need::BoundariesWithinStep).
fn parts(system: &System) -> impl Iterator<Item = &dyn ImplicitBoundary> {
    system
        .boundaries()
        .filter_map(|boundary| boundary.within_step())
}

/// Adds the acceleration by boundaries at the middle of the next step, where the displacement is `u`.
pub(super) fn add_middle(system: &System, u: &[f64], out: &mut [f64]) {
    parts(system).for_each(|part| part.add_middle(u, out));
}

/// Adds the stiffness of boundaries over density, times u.
pub(super) fn add_stiffness(system: &System, u: &[f64], out: &mut [f64]) {
    parts(system).for_each(|part| part.add_stiffness(u, out));
}

/// Computes `a` without the part of the boundaries.
pub(super) fn without_present(system: &System, a: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    parts(system).for_each(|part| part.add_present(out));
    for (out, a) in out.iter_mut().zip(a) {
        *out = a - *out;
    }
}

/// Sets `out` to the rounding errors of the positions of the points at the displacement `u`: forces depend on distances between
/// positions, so that they have rounding errors at rest, too. All processes must call it together.
pub(super) fn rounding_into(system: &System, u: &[f64], out: &mut [f64]) {
    const SEED: u64 = 1;
    let spacing = system.cloud().spacing();
    let noise = noise_on(system.domain(), system.dimension(), SEED);
    for ((out, u), noise) in out.iter_mut().zip(u).zip(noise) {
        *out = f64::EPSILON * noise * (u.abs() + spacing);
    }
}
