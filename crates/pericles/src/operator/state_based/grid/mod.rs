//! Linear peridynamic solids on a lattice by one stencil for all nodes.

mod arrays;
mod breaking;
mod force;
mod kernels;
mod passes;
mod tangent;
mod view;

pub use force::LinearSolidGrid;
