//! Stencil force kernel for lattice bodies.
//!
//! Eight nodes of a row are in the lanes, offsets are the inner loop, and forces stay in registers. Small strains use
//! a polynomial, large ones the exact law; the choice depends on the bonds of the point only. Bond failure and
//! dissipated energy are identical to those of the neighbour-list kernel.
//!
//! Single precision is used inside the loops only: they read a copy of the displacements in floats, while states,
//! energies and tangents are doubles. Layout, bits and blocks are the same for both precisions.

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
