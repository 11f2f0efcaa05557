//! State-based materials: the force of a bond depends on all bonds of both end points, so that Poisson's ratio is free.

mod classes;
mod elastic;
mod failure;
mod inelastic;
mod interface;
mod isotropic;
mod linear_solid;
mod surface;

pub use classes::SolidClasses;
pub use elastic::{ElasticConstants, GivenConstants};
pub use failure::{BondFailure, BondLimits, StretchDefinition};
pub use inelastic::{Inelasticity, MOST_TERMS, ViscousTerm, Yield};
pub use isotropic::{IsotropicInfluence, LatticeShear};
pub use linear_solid::{LinearSolid, LinearSolidConstants, StateInfluence, Strains};
pub use surface::SolidSurface;
