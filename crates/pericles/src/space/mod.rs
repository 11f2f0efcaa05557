//! Points in space: clouds, regular grids, regions and named sets.
//!
//! A body is a set of points with volumes. [`PointCloud`] holds it as structure of arrays; [`Grid`] makes clouds of cell
//! centres, [`GradedGrid`] those with smaller cells in parts, [`rectangular_cells`] those of cells longer along one axis than along another, [`ListedPoints`] those of points given one by one; [`Sites`] are the places that bonds lead to; [`Region`] says which points of space belong to a hole, a set or a layer.
//!
//! Lengths are in metres. Bodies have dimension 1, 2 or 3; coordinates handed to regions always have three components,
//! the missing ones zero.

mod cloud;
mod curve;
mod graded;
mod grid;
mod lattice;
mod listed;
mod quadrature;
mod rectangular;
mod region;
mod set;
mod sites;

pub use cloud::{PointCloud, PointSet};
pub use curve::hilbert_order;
pub use graded::{Division, Finer, GradedCell, GradedCloud, GradedGrid};
pub use grid::{Grid, Shape};
pub use lattice::Lattice;
pub use listed::ListedPoints;
pub use quadrature::gauss_bar;
pub use rectangular::{idle_holes, rectangular_cells};
pub use region::{Face, Region};
pub use set::{check_length, check_points, check_set};
pub use sites::Sites;

/// A point or vector in space; components beyond the body's dimension are zero.
pub type Point = [f64; 3];
