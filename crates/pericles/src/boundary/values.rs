//! Values of loads and prescribed motions that are computed for all points at once.

use std::fmt;

/// A vector field of time on the points of a load or prescribed motion, computed for all points in one call.
///
/// A program that evaluates whole arrays, such as an interpreter, answers one call per time instead of one call per
/// point and component. The order of evaluations follows the time integrator: several stages may ask for the same
/// time, and a subset of the points is read from the same values, so that an implementation should keep its last values.
pub trait PointValues: fmt::Debug + Send + Sync {
    /// Returns the number of values: points times dimension.
    fn len(&self) -> usize;

    /// Returns whether there are no values.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Passes the values at time `t` (s), or their time derivative of order `order`, to `read`: component c of the
    /// k-th point of the set is entry c · (points of the set) + k. Loads ask for order 0 (N/m³); prescribed motions for
    /// displacements (order 0, m), velocities (order 1, m/s) and accelerations (order 2, m/s²).
    fn at(&self, order: usize, t: f64, read: &mut dyn FnMut(&[f64]));

    /// Returns whether an evaluation may fail, such as the evaluation of a user's function. The time loop then copies state and
    /// system before every step, so that a step with a failed evaluation is undone.
    fn can_fail(&self) -> bool {
        false
    }

    /// Returns whether an evaluation has failed. The run then stops as if it had been interrupted: before the step of
    /// the failed evaluation, from where it can be continued. The values passed on do not matter.
    fn has_failed(&self) -> bool {
        false
    }
}
