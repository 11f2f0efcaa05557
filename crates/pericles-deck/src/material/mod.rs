//! `[material]` and `[materials.NAME]`: constants, horizon, influence function and failure.

mod bond_based;
mod check;
mod family;
mod inelastic;
mod scatter;
mod scope;
mod several;
mod shared;
mod softening;
mod solids;
mod table;
mod types;

pub use scatter::{Scatter, ScatteredStrength};
pub use softening::{BondSoftening, FailureSurface};
pub use types::{Material, MaterialModel, NamedMaterial};

pub(crate) use several::{Materials, read};
