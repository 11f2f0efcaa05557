//! What schemes with several time steps in one body ask of a force.

use super::On;
use crate::step_end::StepEnd;

/// A force made of bonds between points: who is bonded to whom, the part of the force that some neighbours exert, and where bonds are
/// about to break.
///
/// Every method is the same for both ends of a bond, so that zones cut a body without changing the force between its parts.
pub trait ZonedForce {
    /// Calls `visit` for every point that exerts a force on point i, once each. Bonds that broke since the start may be among them: zones are then wider than needed,
    /// never too narrow.
    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize));

    /// [`ForceOperator::add_force`](super::ForceOperator::add_force) of the bonds whose other end is marked in `partners` (one mark per point).
    fn add_force_from(&self, t: f64, u: &[f64], on: On<'_>, partners: &[bool], out: &mut [f64]);

    /// [`ForceOperator::end_step`](super::ForceOperator::end_step) of the bonds whose other end is marked in `partners`; the others are neither
    /// decided nor summed.
    fn end_step_from(&mut self, step: &StepEnd<'_>, on: On<'_>, partners: &[bool], out: &mut [f64]);

    /// Marks the points with a bond that is left, may break and is stretched beyond `fraction` of the critical stretch.
    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]);
}
