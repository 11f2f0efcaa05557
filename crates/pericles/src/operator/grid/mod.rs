//! Stencil force kernel for lattice bodies.

mod arrays;
pub(in crate::operator) mod block;
mod breaking;
pub(in crate::operator) mod build;
mod damage;
mod factors;
pub(in crate::operator) mod families;
mod force;
mod heated;
mod kernels;
pub(in crate::operator) mod layout;
mod numbers;
mod operator;
pub(in crate::operator) mod padded;
mod rows;
mod runs;
pub(in crate::operator) mod stencil;
pub(in crate::operator) mod stored;
mod thresholds;
mod view;
pub(in crate::operator) mod wanted;
mod working;
mod zoned;

pub use force::GridForce;
