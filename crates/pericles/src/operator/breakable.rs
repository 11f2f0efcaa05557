//! Bonds that break, or are missing from the start.

use super::CoarseBreak;

/// A force whose bonds may be missing: cut by pre-cracks, or broken since the start.
pub trait Breakable {
    /// Whether anything can break.
    fn can_break(&self) -> bool;

    /// Bonds broken so far, each counted once.
    fn broken_bonds(&self) -> u64;

    /// Points that lost all of their bonds because those that were left determined no deformation; none of forces whose bonds break for their own reasons alone.
    fn dropped_points(&self) -> u64 {
        0
    }

    /// Energy dissipated by breaking so far, and by plastic flow where the material yields, J.
    fn dissipated(&self) -> f64;

    /// Books energy that breaking dissipated beside what was booked when it was decided, J.
    fn dissipate(&mut self, energy: f64);

    /// Takes the bonds broken since this was asked last by steps too coarse for them, each once, in an order that depends on nothing but the bonds.
    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak>;

    /// Damage of each point, 0 … 1: the part of its family that is missing.
    fn damage_into(&self, out: &mut [f64]);

    /// Calls `visit` with the two ends of every bond that is left, once or twice for each.
    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize));

    /// Marks the points with a bond that is left, may break and is stretched beyond `fraction` of the critical stretch.
    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]);
}
