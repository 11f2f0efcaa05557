//! Forces with bonds that break or were removed by pre-cracks.

use std::ops::Range;

use super::CoarseBreak;

/// A force whose bonds can be cut by pre-cracks or break during the run.
pub trait Breakable {
    /// Returns whether any bond can break.
    fn can_break(&self) -> bool;

    /// Returns whether the failure criterion accumulates along the deformation, as the work of a bond does. Schemes then
    /// end a step at each accepted state, even if no bond breaks.
    fn accumulates(&self) -> bool {
        false
    }

    /// Returns the number of broken bonds, each counted once.
    fn broken_bonds(&self) -> u64;

    /// Returns the number of points that lost all bonds because the remaining bonds did not determine a
    /// deformation gradient; zero for forces whose bonds break independently of each other.
    fn dropped_points(&self) -> u64 {
        0
    }

    /// Returns the largest factor by which the highest frequency of the body may grow when bonds break.
    fn stiffening(&self) -> f64 {
        1.0
    }

    /// Returns the energy dissipated by breaking bonds and by plastic flow, J.
    fn dissipated(&self) -> f64;

    /// Adds to the energy dissipated by point i a correction for bonds that are already broken, J.
    fn dissipate(&mut self, i: usize, energy: f64);

    /// Records which points dissipate the energy from now on, for [`Breakable::take_dissipated`].
    fn follow_dissipation(&mut self);

    /// Adds the energy that each point has dissipated since the last call to `out`, J. The sum over all points is the
    /// change of [`Breakable::dissipated`] to rounding.
    fn take_dissipated(&mut self, out: &mut [f64]);

    /// Returns and clears the bonds that broke, since the last call, in steps too large for them; each once,
    /// in an order that depends on the bonds only.
    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak>;

    /// Sets the damage of each point, 0 … 1: the missing fraction of its family.
    fn damage_into(&self, out: &mut [f64]);

    /// Calls `visit` with both ends of each intact bond, once or twice per bond. The first end is an own point; ghosts are
    /// counted after the own points.
    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize));

    /// Calls `visit` with the other end of each intact bond of point i, in any order. Points that other processes own
    /// are counted after the own points, as in [`Domain::number`](crate::domain::Domain::number).
    fn for_each_intact_of(&self, i: usize, visit: &mut dyn FnMut(usize));

    /// Calls `visit` with ranges of points that together contain all points, and the number of directed bonds that
    /// broke so far in each: a changed number shows where bonds broke since an earlier call. The ranges do not change.
    fn for_each_broken_count(&self, visit: &mut dyn FnMut(Range<usize>, u64));

    /// Marks the points with an intact breakable bond whose stretch exceeds `fraction` of the critical
    /// stretch. Points that are already marked are skipped.
    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]);
}
