//! Forces with bonds that break or were removed by pre-cracks.

use super::CoarseBreak;
use crate::neighbourhood::BondSet;

/// Failure criterion of bonds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Breaking<'a> {
    /// Critical stretch s₀; infinite if bonds never break.
    pub critical_stretch: f64,
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
}

/// A force whose bonds can be cut by pre-cracks or break during the run.
pub trait Breakable {
    /// Returns the bonds.
    fn bonds(&self) -> &dyn BondSet;

    /// Returns the bonds for modification.
    fn bonds_mut(&mut self) -> &mut dyn BondSet;

    /// Returns whether any bond can break.
    fn can_break(&self) -> bool;

    /// Returns whether the failure criterion accumulates along the deformation, as the work of a bond does. Schemes then
    /// end a step at each accepted state, even if no bond breaks.
    fn accumulates(&self) -> bool {
        false
    }

    /// Returns the number of points that lost all bonds because the remaining bonds did not determine a
    /// deformation gradient; zero for forces whose bonds break independently of each other.
    fn dropped_points(&self) -> u64 {
        0
    }

    /// Returns the largest factor by which the highest frequency of the body may grow when bonds break.
    fn stiffening(&self) -> f64 {
        1.0
    }

    /// Sets the damage of each point, 0 … 1: the missing fraction of its family.
    fn damage_into(&self, out: &mut [f64]) {
        self.bonds().damage_into(out);
    }

    /// Returns and clears the bonds that broke, since the last call, in steps too large for them; each once,
    /// in an order that depends on the bonds only.
    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak>;

    /// Marks the points with an intact breakable bond whose stretch exceeds `fraction` of the critical
    /// stretch. Points that are already marked are skipped.
    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]);
}
