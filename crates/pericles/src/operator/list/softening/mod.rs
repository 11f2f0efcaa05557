//! Softening bonds: neighbour lists that store the largest stretch of each bond, and its onset if softening begins where
//! the stress reaches the strength.

mod advance;
mod breaking;
mod curves;
mod force;
mod gate;
mod kernels;
mod operator;
mod stress;

pub use force::SofteningForce;
pub(in crate::operator) use force::no_softening;
pub(in crate::operator) use gate::PointStrengths;
