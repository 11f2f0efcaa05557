//! Neighbour-list force kernel for any body.

mod arrays;
mod breaking;
mod damage;
mod force;
mod heat;
mod heated;
mod kernels;
mod operator;
pub(super) mod other_ends;
mod packed;
mod softening;
mod springs;
pub(super) mod stiffness;
mod zoned;

pub use force::BondForce;
pub use softening::SofteningForce;
pub(in crate::operator) use softening::no_softening;
