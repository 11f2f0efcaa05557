//! Boundaries that act within an implicit step.

use crate::boundary::ImplicitBoundary;
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
