//! Capabilities of forces required by multirate schemes.

use super::PointSubset;
use crate::step_end::StepEnd;

/// A force of finite range: the force on a point depends on the displacements of nearby points.
pub trait LocalForce {
    /// Calls `visit` once for each point other than i on whose displacement the force on point i depends. The
    /// relation is symmetric. Bonds broken during the run may be included: zones are then wider than
    /// necessary, never too narrow.
    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize));
}

/// A force that is a sum over bonds, in which the contribution of some neighbours can be computed alone.
///
/// Both ends of a bond are treated alike, so that zones do not change the force between the parts of a body.
pub trait SplitForce {
    /// Adds [`Force::add_force`](super::Force::add_force) of the bonds whose other end is marked in
    /// `partners` (one mark per point).
    fn add_force_from(
        &self,
        t: f64,
        u: &[f64],
        on: PointSubset<'_>,
        partners: &[bool],
        out: &mut [f64],
    );

    /// Applies [`Force::end_step`](super::Force::end_step) to the bonds whose other end is marked in
    /// `partners`; the failure criterion is not applied to other bonds, and their forces are not added.
    fn end_step_from(
        &mut self,
        step: &StepEnd<'_>,
        on: PointSubset<'_>,
        partners: &[bool],
        out: &mut [f64],
    );
}
