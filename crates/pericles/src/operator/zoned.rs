//! What schemes with several time steps in one body ask of a force.

use super::On;
use crate::step_end::StepEnd;

/// A force of finite reach: the force on a point depends on the displacements of points nearby.
pub trait LocalForce {
    /// Calls `visit` for every point but i on whose displacement the force on point i depends, once each; i is among those of every such point. Bonds that broke since the start may count among them: zones are
    /// then wider than needed, never too narrow.
    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize));
}

/// A force made of bonds between points, of which the part that some neighbours exert can be computed alone.
///
/// Every method is the same for both ends of a bond, so that zones cut a body without changing the force between its parts.
pub trait SplitForce {
    /// [`Force::add_force`](super::Force::add_force) of the bonds whose other end is marked in `partners` (one mark per point).
    fn add_force_from(&self, t: f64, u: &[f64], on: On<'_>, partners: &[bool], out: &mut [f64]);

    /// [`Force::end_step`](super::Force::end_step) of the bonds whose other end is marked in `partners`; the others are neither
    /// decided nor summed.
    fn end_step_from(&mut self, step: &StepEnd<'_>, on: On<'_>, partners: &[bool], out: &mut [f64]);
}
