//! State-based materials: the force of a bond depends on all bonds of both end points, so that Poisson's ratio is free.

mod elastic;
mod failure;
mod interface;
mod isotropic;
mod linear_solid;
mod materials;
mod surface;

pub use elastic::{ElasticConstants, GivenConstants};
pub use failure::{BondFailure, BondLimits, StretchDefinition};
pub use isotropic::{IsotropicInfluence, LatticeShear};
pub use linear_solid::{LinearSolid, LinearSolidConstants, StateInfluence, Strains};
pub use materials::{BondStrength, Materials, StateConstants};
pub use surface::SolidSurface;
