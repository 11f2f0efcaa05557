//! Neighbour-list force kernel for any body.
//!
//! The list stores no number per bond: a neighbour takes two bytes relative to the first one of its group, and a bond
//! one bit. ξ, |ξ|, influence and partial volume are computed from positions, which are stored next to the
//! displacements in rows that one load reads. Stiffnesses without a linear formula take one byte each on lattices (a
//! table of at most 256 values), and eight bytes only where all bonds differ. Clusters of eight points with a mask
//! per partner would need a third of the memory, but compute two lanes per bond.

mod arrays;
mod breaking;
mod damage;
mod force;
mod growing;
mod heat;
mod heated;
mod kernels;
mod operator;
mod packed;
mod softening;
mod springs;
pub(super) mod stiffness;
mod zoned;

pub use force::BondForce;
pub use softening::SofteningForce;
pub(in crate::operator) use softening::{PointStrengths, no_softening};
