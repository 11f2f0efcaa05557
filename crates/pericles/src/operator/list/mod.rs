//! The force of any body by a list of every point's bonds.

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
mod springs;
pub(super) mod stiffness;
mod zoned;

pub use force::BondForce;
