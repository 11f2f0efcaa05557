//! Materials: from engineering constants to bond constants.
//!
//! A bond of reference length r pulls its ends together with the force density (per volume squared) c α(r) s, where s is its stretch. The
//! constant c follows from one elastic modulus, the critical stretch s₀ from the fracture energy, both through the moments
//! m_q = ∫₀^δ α r^q dr of the influence function (Alebrahim et al. 2022, eqs. 5 and 52, written for any α):
//!
//! | | c | fixed ν | G₀ |
//! |---|---|---|---|
//! | bar, section area A | E/(A m₁) | – | ½ A c s₀² m₂ |
//! | plane stress, thickness h | 3E/(π h m₂) | 1/3 | h c s₀² m₃ |
//! | plane strain, thickness h | 16E/(5π h m₂) | 1/4 | h c s₀² m₃ |
//! | 3D | 9K/(2π m₃), K = 2E/3 | 1/4 | (π/2) c s₀² m₄ |
//!
//! On a grid sums over a point's bonds take the place of the integrals if asked for: [`Calibration`] for c, [`FractureCalibration`] for s₀.
//!
//! Units: E, K in Pa; c in N/m⁶ for a dimensionless α; G₀ in J/m².

mod bond_material;
mod composite;
mod constants;
mod crack_planes;
mod interface;
mod lattice;
mod law;
mod modulus;
mod pair_force;
mod polynomial;
mod scatter;
mod state_based;
mod surface_correction;
mod treatment;
mod waves;

pub use bond_material::{BondMaterial, Calibration, Fracture, FractureCalibration, Modulus};
pub(crate) use composite::check_materials;
pub use composite::{InterfaceRule, PairClasses};
pub use constants::BondConstants;
pub use crack_planes::{CrackPlane, LayerMoments};
pub use interface::{InterfaceStiffness, MaterialInterface};
pub use law::{BondStretch, CubicLaw, LinearBond, PairLaw};
pub use modulus::{ElasticModulus, StressState};
pub use pair_force::PairForce;
pub use polynomial::{GreenBond, LiteralBond};
pub(crate) use scatter::Factors;
pub use scatter::{Scattered, StrengthScatter};
pub use state_based::{
    BondFailure, BondLimits, ElasticConstants, GivenConstants, Inelasticity, IsotropicInfluence,
    LatticeShear, LinearSolid, LinearSolidConstants, MOST_TERMS, SolidClasses, SolidSurface,
    StateInfluence, Strains, StretchDefinition, ViscousTerm, Yield,
};
pub use surface_correction::{SurfaceCorrection, SurfaceFactors};
pub use treatment::{CubicBond, CubicFactor, SecondOrder, Trapezoidal, Treated, Treatment};
pub use waves::{ElasticWaves, TransverseWaves};
