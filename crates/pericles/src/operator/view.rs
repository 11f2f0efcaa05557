//! Access to bonds, dilatations and plastic strains for output fields.

use crate::domain::Field;

/// A bond seen from one of its ends; missing components are zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondAt {
    /// The other end; ghosts are numbered after own points.
    pub neighbour: usize,
    /// Whether the other end is a ghost of a surface layer ([`GhostForce`](super::GhostForce)); `neighbour`
    /// is then the nearest point of the body.
    pub to_ghost: bool,
    /// Reference vector ξ to the other end, m.
    pub xi: [f64; 3],
    /// Relative displacement η, m.
    pub eta: [f64; 3],
    /// Force density of the bond on this end, N/m³, including the partial volume and the volume of the other
    /// end.
    pub force: [f64; 3],
}

impl BondAt {
    /// Creates a bond of a body with D dimensions.
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
            to_ghost: false,
            xi: spatial(xi),
            eta: spatial(eta),
            force: spatial(force),
        }
    }

    /// Creates an undeformed bond without a force.
    pub fn undeformed<const D: usize>(neighbour: usize, xi: [f64; D]) -> Self {
        Self::new(neighbour, xi, [0.0; D], [0.0; D])
    }
}

/// An operator with access to individual bonds. The access is slow and meant for output.
pub trait BondView: Sync {
    /// Returns whether the forces of bonds are known: on a divided body not if they depend on the bonds of ghosts.
    fn has_forces(&self) -> bool {
        true
    }

    /// Calls `visit` for each intact bond of point i at displacement u; requires [`BondView::has_forces`].
    fn for_each_bond(&self, u: Field<'_>, i: usize, visit: &mut dyn FnMut(BondAt));

    /// Calls `visit` for each intact bond of own point i, undeformed and without its force. It reads the bonds of this
    /// point only, so that it is available for every body divided among processes.
    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt));
}

/// An operator whose points can yield.
pub trait PlasticView: Sync {
    /// Sets the equivalent plastic strain of each point.
    fn plastic_strain_into(&self, out: &mut [f64]);
}

/// An operator with dilatations of points.
pub trait DilatationView: Sync {
    /// Sets the dilatation of each point, dimensionless: the relative change of volume in 3D, of area in 2D,
    /// of length in 1D.
    fn dilatation_into(&self, t: f64, u: &[f64], out: &mut [f64]);
}
