//! Materials: from engineering constants to bond constants.
//!
//! A bond of reference length r and stretch s exerts the pairwise force density c α(r) s (N/m⁶) between its
//! end points. The constant c follows from one elastic modulus, the critical stretch s₀ from the fracture
//! energy, both through the moments m_q = ∫₀^δ α r^q dr of the influence function (Alebrahim et al. 2022,
//! eqs. 5 and 52, written for any α):
//!
//! | | c | fixed ν | G₀ |
//! |---|---|---|---|
//! | bar, section area A | E/(A m₁) | – | ½ A c s₀² m₂ |
//! | plane stress, thickness h | 3E/(π h m₂) | 1/3 | h c s₀² m₃ |
//! | plane strain, thickness h | 16E/(5π h m₂) | 1/4 | h c s₀² m₃ |
//! | 3D | 9K/(2π m₃), K = 2E/3 | 1/4 | (π/2) c s₀² m₄ |
//!
//! On a grid, sums over the bonds of a point can replace the integrals: see [`Calibration`] for c and
//! [`FractureCalibration`] for s₀.
//!
//! Units: E, K in Pa; c in N/m⁶ for a dimensionless α; G₀ in J/m².

mod approximation;
mod bond_material;
mod composite;
mod constants;
mod crack_planes;
mod criterion;
mod interface;
mod lattice;
mod law;
mod modulus;
mod pair_force;
mod polynomial;
mod scatter;
mod softening;
mod state_based;
mod strength;
mod strength_surface;
mod surface_correction;
mod waves;

pub use approximation::{
    Approximated, Approximation, CubicBond, CubicFactor, SecondOrder, Trapezoidal,
};
pub use bond_material::{BondMaterial, Calibration, Fracture, FractureCalibration, Modulus};
pub use composite::{InterfaceRule, MaterialPairs, check_materials};
pub use constants::BondConstants;
pub use crack_planes::{CrackPlane, LayerMoments};
pub use criterion::{
    BondCriterion, BondPlace, BondState, Criterion, PairCriteria, PrincipalStress,
};
pub use interface::{InterfaceStiffness, MaterialInterface};
pub use law::{BondStretch, CubicLaw, LinearBond, PairLaw};
pub use modulus::{ElasticModulus, StressState};
pub use pair_force::PairForce;
pub use polynomial::{CubicSofteningBond, GreenBond};
pub use scatter::{Factors, Scattered, StrengthScatter};
pub use softening::{Softening, SofteningCurve, SofteningLaw};
pub use state_based::{
    BondFailure, BondLimits, BondStrength, ElasticConstants, GivenConstants, IsotropicInfluence,
    LatticeShear, LinearSolid, LinearSolidConstants, Materials, SolidSurface, StateConstants,
    StateInfluence, Strains, StretchDefinition,
};
pub use strength::{HomogeneousBonds, Strengths, TensileStrength};
pub use strength_surface::{Strength, StrengthSurface};
pub use surface_correction::{SurfaceCorrection, SurfaceFactors};
pub use waves::{ElasticWaves, TransverseWaves};
