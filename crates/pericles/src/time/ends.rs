//! Boundaries that are part of the step to be found.

use crate::boundary::WithinStep;
use crate::system::System;

/// The boundaries' parts in a step; each has one where a scheme needs [`BoundariesWithinStep`](crate::Need::BoundariesWithinStep).
fn parts(system: &System) -> impl Iterator<Item = &dyn WithinStep> {
    system
        .boundaries()
        .filter_map(|boundary| boundary.within_step())
}

/// Adds what boundaries give at the middle of the coming step to a body displaced by `u` there.
pub(super) fn add_middle(system: &System, u: &[f64], out: &mut [f64]) {
    parts(system).for_each(|part| part.add_middle(u, out));
}

/// Adds the stiffness of boundaries over density, times u.
pub(super) fn add_stiffness(system: &System, u: &[f64], out: &mut [f64]) {
    parts(system).for_each(|part| part.add_stiffness(u, out));
}

/// `a` without what boundaries are part of it.
pub(super) fn without_present(system: &System, a: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    parts(system).for_each(|part| part.add_present(out));
    for (out, a) in out.iter_mut().zip(a) {
        *out = a - *out;
    }
}
