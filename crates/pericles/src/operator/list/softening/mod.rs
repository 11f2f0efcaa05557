//! Softening bonds: neighbour lists that store the largest stretch of each bond.

mod advance;
mod breaking;
mod curves;
mod force;
mod kernels;
mod operator;

pub use force::SofteningForce;
pub(in crate::operator) use force::no_softening;
