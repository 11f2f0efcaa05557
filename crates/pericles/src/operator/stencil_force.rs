//! Forces of the stencil kernel as data, for extension crates that evaluate them themselves.

use crate::neighbourhood::{Lattice, Neighbourhood};

/// The pair force of a stencil.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StencilLaw {
    /// [`LinearBond`](crate::material::LinearBond).
    Linear,
    /// [`BondStretch`](crate::material::BondStretch).
    BondStretch,
}

/// Critical stretches of the bonds of a stencil.
#[derive(Debug, Clone, Copy)]
pub enum CriticalStretches<'a> {
    /// The same of all bonds; infinite if bonds never break.
    Uniform(f64),
    /// By the materials of the places of both ends.
    Pairs {
        /// Material of each place.
        material: &'a [u8],
        /// Critical stretch of each pair of materials, row by row.
        table: &'a [f64],
        /// Factor of each place; a bond has the mean factor of its ends. Empty if strengths do not scatter.
        factors: &'a [f64],
    },
}

/// Factors of the stiffness of bonds, in rows of eight numbers per offset.
#[derive(Debug, Clone, Copy)]
pub struct StiffnessFactors<'a> {
    /// Row of each chunk of the layout.
    pub rows: &'a [u32],
    /// All rows; those of row 0 are one.
    pub values: &'a [f64],
}

/// A force Σ_j c α κ V_j s n of the bonds of a lattice as data; see [`GridForce`](super::GridForce).
pub struct StencilData<'a> {
    /// The pair force.
    pub law: StencilLaw,
    /// The bonds.
    pub bonds: &'a Neighbourhood<Lattice>,
    /// c α κ V of the offsets of the stencil, N/m³.
    pub stiffness: Vec<f64>,
    /// Factors of this stiffness; `None` if all bonds have it.
    pub factors: Option<StiffnessFactors<'a>>,
    /// Critical stretches.
    pub critical: CriticalStretches<'a>,
}

/// A force that consists of the bonds of a stencil.
pub trait StencilForce {
    /// Returns the force as data.
    fn data(&self) -> StencilData<'_>;

    /// Returns the bonds for modification.
    fn bonds_mut(&mut self) -> &mut Neighbourhood<Lattice>;
}
