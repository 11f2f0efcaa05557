//! Bonds one by one, for fields that are made of them.

use crate::domain::Field;

/// A bond as one of its ends sees it; missing components are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondAt {
    /// The other end; ghosts are counted behind own points.
    pub neighbour: usize,
    /// Reference vector to it ξ, m.
    pub xi: [f64; 3],
    /// Relative displacement η, m.
    pub eta: [f64; 3],
    /// Force density that the bond exerts on this end, N/m³: partial volumes and the other end's volume are part of it.
    pub force: [f64; 3],
}

/// An operator whose bonds can be looked at. Slow beside the operator itself: for output.
pub trait BondView: Sync {
    /// Calls `visit` for every bond of point i that is left, at displacement u.
    fn for_each_bond(&self, u: Field<'_>, i: usize, visit: &mut dyn FnMut(BondAt));
}
