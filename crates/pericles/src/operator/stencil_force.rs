//! Forces of the stencil kernel as data, for extension crates that evaluate them themselves.

use super::polynomials::{PHI, PSI, REACH};
use crate::neighbourhood::{Lattice, Neighbourhood};

/// The kinematics of the bonds of a stencil: stretch and direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StencilLaw {
    /// [`LinearBond`](crate::material::LinearBond), small displacements.
    Linear,
    /// [`BondStretch`](crate::material::BondStretch), finite displacements.
    BondStretch,
}

impl StencilLaw {
    /// Coefficients of φ(t)/t, ascending, for |t| ≤ [`StencilLaw::REACH`]: φ = 1 − |ξ|/|ξ+η| of a bond with the strain
    /// t = |ξ+η|²/|ξ|² − 1.
    pub const PHI: [f64; 7] = PHI;
    /// Coefficients of ψ(t)/t, likewise: ψ = |ξ+η|/|ξ| − 1.
    pub const PSI: [f64; 7] = PSI;
    /// Largest |t| of these polynomials.
    pub const REACH: f64 = REACH;
}

/// Critical stretches of the bonds of a stencil.
#[derive(Debug, Clone)]
pub enum CriticalStretches {
    /// The same of all bonds; infinite if bonds never break.
    Uniform(f64),
    /// By the materials of the places of both ends.
    Pairs {
        /// Material of each place.
        material: Vec<u8>,
        /// Critical stretch of each pair of materials, row by row.
        table: Vec<f64>,
        /// Factor of each place; a bond has the mean factor of its ends. Empty if strengths do not scatter.
        factors: Vec<f64>,
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

/// What acts in the bonds of a stencil.
#[derive(Debug, Clone)]
pub enum StencilMaterial<'a> {
    /// Σ_j c α κ V_j s n; see [`GridForce`](super::GridForce).
    Bonds {
        /// c α κ V of the offsets of the stencil, N/m³.
        stiffness: Vec<f64>,
        /// Factors of this stiffness; `None` if all bonds have it.
        factors: Option<StiffnessFactors<'a>>,
    },
    /// A linear peridynamic solid; see [`LinearSolidGrid`](super::LinearSolidGrid).
    Solid(StencilSolid<'a>),
}

/// Constants of a linear peridynamic solid on a stencil: of offsets, and of own points.
#[derive(Debug, Clone)]
pub struct StencilSolid<'a> {
    /// ω = w V of the offsets, m³.
    pub weights: Vec<f64>,
    /// D/m: the dilatation is (D/m) Σ ω r e.
    pub dilatation: &'a [f64],
    /// A/m: the pressure p is (A/m) θ.
    pub pressure: &'a [f64],
    /// B/m.
    pub stiffness: &'a [f64],
    /// A/D, Pa.
    pub bulk: &'a [f64],
}

/// A force of the bonds of a lattice as data.
pub struct StencilData<'a> {
    /// The kinematics of bonds.
    pub law: StencilLaw,
    /// The bonds.
    pub bonds: &'a Neighbourhood<Lattice>,
    /// The material.
    pub material: StencilMaterial<'a>,
    /// Critical stretches.
    pub critical: CriticalStretches,
}

/// A force that consists of the bonds of a stencil.
pub trait StencilForce {
    /// Returns the force as data.
    fn data(&self) -> StencilData<'_>;

    /// Returns the bonds for modification.
    fn bonds_mut(&mut self) -> &mut Neighbourhood<Lattice>;
}
