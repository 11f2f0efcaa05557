//! The force of any body by a list of every point's bonds.

mod force;
mod kernels;

pub use force::BondForce;
