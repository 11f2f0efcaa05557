//! Queries of the bonds of a force.

use std::ops::Range;

/// The bonds of a force: which are intact, and the energy that broken ones have dissipated.
pub trait BondSet {
    /// Returns the number of broken bonds, each counted once.
    fn broken_bonds(&self) -> u64;

    /// Returns the energy dissipated by breaking bonds and by plastic flow, J.
    fn dissipated(&self) -> f64;

    /// Adds to the energy dissipated by point i a correction for bonds that are already broken, J.
    fn dissipate(&mut self, i: usize, energy: f64);

    /// Records which points dissipate the energy from now on, for [`BondSet::take_dissipated`].
    fn follow_dissipation(&mut self);

    /// Adds the energy that each point has dissipated since the last call to `out`, J. The sum over all points is the
    /// change of [`BondSet::dissipated`] to rounding.
    fn take_dissipated(&mut self, out: &mut [f64]);

    /// Sets the missing fraction of the family of each point, 0 … 1.
    fn damage_into(&self, out: &mut [f64]);

    /// Calls `visit` with both ends of each intact bond, once or twice per bond. The first end is an own point; ghosts are
    /// counted after the own points.
    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize));

    /// Calls `visit` with the other end of each intact bond of point i, in any order. Points that other processes own
    /// are counted after the own points, as in [`Domain::number`](crate::domain::Domain::number).
    fn for_each_intact_of(&self, i: usize, visit: &mut dyn FnMut(usize));

    /// Calls `visit` with ranges of points that together contain all points, and the number of directed bonds that
    /// broke or came into being so far in each: a changed number shows where bonds changed since an earlier call. The
    /// ranges do not change.
    fn for_each_change_count(&self, visit: &mut dyn FnMut(Range<usize>, u64));
}
