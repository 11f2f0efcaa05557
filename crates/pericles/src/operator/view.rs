//! Access to bonds, dilatations and plastic strains for output fields.

use crate::domain::{Domain, Field};

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
    /// Whether the law is linearised for small strains, with forces along ξ: the deformed body is not distinguished from the
    /// reference body.
    pub small_strain: bool,
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
            small_strain: false,
        }
    }

    /// Returns the bond with a law of small strains or not.
    pub fn of_small_strain(self, small_strain: bool) -> Self {
        Self {
            small_strain,
            ..self
        }
    }

    /// Creates an undeformed bond without a force.
    pub fn undeformed<const D: usize>(neighbour: usize, xi: [f64; D]) -> Self {
        Self::new(neighbour, xi, [0.0; D], [0.0; D])
    }
}

/// Displacements, and the values that the forces of bonds read at both ends, for [`BondView::for_each_bond`].
#[derive(Debug, Clone, Default)]
pub struct BondValues {
    /// Displacement of own points, m.
    pub u: Vec<f64>,
    /// Displacement of ghosts, m.
    pub ghosts: Vec<f64>,
    /// Values of own points, component-major, if the force of a bond depends on other bonds of its ends.
    pub of_points: Vec<f64>,
    /// These values of ghosts.
    pub of_ghosts: Vec<f64>,
    /// Values of bonds by entry, if both ends of a bond read them.
    pub of_bonds: Vec<f64>,
    /// The views of the forces of which a force consists.
    pub parts: Vec<BondValues>,
}

impl BondValues {
    /// Values of a force whose bonds depend on the displacements of their ends only.
    pub fn of_displacement(u: Field<'_>) -> Self {
        Self {
            u: u.owned.to_vec(),
            ghosts: u.ghosts.to_vec(),
            ..Self::default()
        }
    }

    /// Values of a force whose bonds read values of both ends. All processes must call it together.
    pub fn of_points(u: Field<'_>, values: Vec<f64>, domain: &Domain) -> Self {
        Self {
            of_ghosts: domain.ghosts(&values),
            of_points: values,
            ..Self::of_displacement(u)
        }
    }

    /// Displacement, m.
    pub fn displacement(&self) -> Field<'_> {
        Field::new(&self.u, &self.ghosts)
    }

    /// Values of points.
    pub fn points(&self) -> Field<'_> {
        Field::new(&self.of_points, &self.of_ghosts)
    }
}

/// An operator with access to individual bonds. The access is slow and meant for output.
pub trait BondView: Sync {
    /// Returns the values that the forces of bonds read at a displacement of own points and ghosts. All processes must call it
    /// together.
    fn values_at(&self, u: Field<'_>) -> BondValues {
        BondValues::of_displacement(u)
    }

    /// Calls `visit` for each intact bond of own point i, with values of [`BondView::values_at`].
    fn for_each_bond(&self, values: &BondValues, i: usize, visit: &mut dyn FnMut(BondAt));

    /// Calls `visit` for each intact bond of own point i, undeformed and without its force.
    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt));
}

/// An operator whose points can yield.
pub trait PlasticView: Sync {
    /// Sets the equivalent plastic strain of each point.
    fn plastic_strain_into(&self, out: &mut [f64]);
}

/// An operator whose material has a stress at every point.
pub trait StressView: Sync {
    /// Returns the Cauchy stress of each own point, Pa; missing components are zero. All processes must call it together.
    fn stresses(&self, u: &[f64]) -> Vec<[[f64; 3]; 3]>;
}

/// An operator with dilatations of points.
pub trait DilatationView: Sync {
    /// Sets the dilatation of each point, dimensionless: the relative change of volume in 3D, of area in 2D,
    /// of length in 1D.
    fn dilatation_into(&self, t: f64, u: &[f64], out: &mut [f64]);
}
