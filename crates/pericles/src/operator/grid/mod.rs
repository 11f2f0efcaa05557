//! The force of a lattice body by one stencil for all nodes.

mod arrays;
mod block;
mod breaking;
mod build;
mod damage;
mod factors;
mod force;
mod kernels;
mod layout;
mod numbers;
mod operator;
mod padded;
mod rows;
mod stencil;
mod thresholds;
mod view;
mod wanted;
mod working;
mod zoned;

pub use force::GridForce;
