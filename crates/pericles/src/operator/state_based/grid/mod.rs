//! Stencil kernel for linear peridynamic solids on a lattice.

mod arrays;
mod breaking;
mod force;
mod heated;
mod kernels;
mod passes;
mod tangent;
mod view;

pub use force::LinearSolidGrid;
