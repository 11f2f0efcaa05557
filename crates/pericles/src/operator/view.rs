//! Bonds one by one and dilatations, for fields.

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

impl BondAt {
    /// A bond of a body with D dimensions.
    pub fn new<const D: usize>(
        neighbour: usize,
        xi: [f64; D],
        eta: [f64; D],
        force: [f64; D],
    ) -> Self {
        let spatial =
            |vector: [f64; D]| std::array::from_fn(|c| vector.get(c).copied().unwrap_or(0.0));
        Self {
            neighbour,
            xi: spatial(xi),
            eta: spatial(eta),
            force: spatial(force),
        }
    }
}

/// An operator whose bonds can be looked at. Slow beside the operator itself: for output.
pub trait BondView: Sync {
    /// Calls `visit` for every bond of point i that is left, at displacement u.
    fn for_each_bond(&self, u: Field<'_>, i: usize, visit: &mut dyn FnMut(BondAt));
}

/// An operator whose points yield.
pub trait PlasticView: Sync {
    /// Sets the equivalent plastic strain of every point.
    fn plastic_strain_into(&self, out: &mut [f64]);
}

/// An operator whose force on a bond depends on the dilatations of its ends.
pub trait DilatationView: Sync {
    /// Sets the dilatation of every point, dimensionless: the relative change of volume in three dimensions, of area in the plane, of length in a bar.
    fn dilatation_into(&self, t: f64, u: &[f64], out: &mut [f64]);
}
