//! Points of a body: clouds, regular and graded grids, regions and point sets.
//!
//! A body is a set of points with volumes, stored in a [`PointCloud`]. [`Grid`] makes clouds of cell centres,
//! [`GradedGrid`] grids with smaller cells in some regions, [`rectangular_cells`] grids with anisotropic spacing,
//! and [`ListedPoints`] clouds from lists of points. A [`PointSource`] creates the points of one of several processes. [`Sites`] are the positions to which bonds lead, including
//! periodic images. A [`Region`] selects the points of holes, sets and layers.
//!
//! Lengths are in metres. Bodies have dimension 1, 2 or 3; coordinates passed to regions always have three
//! components, of which missing ones are zero.

mod cell_count;
mod cloud;
mod curve;
mod graded;
mod grid;
mod lattice;
mod lattice_body;
mod listed;
mod pieces;
mod quadrature;
mod rectangular;
mod region;
mod set;
mod sites;
mod source;

pub use cloud::{PointCloud, PointSet};
pub use curve::hilbert_order;
pub use graded::{Division, Finer, GradedCell, GradedCloud, GradedGrid};
pub use grid::{Grid, Shape};
pub use lattice::Lattice;
pub use lattice_body::LatticeBody;
pub use listed::ListedPoints;
pub use quadrature::gauss_bar;
pub use rectangular::{idle_holes, rectangular_body, rectangular_cells};
pub use region::{Face, Region};
pub use set::{check_length, check_points, check_set};
pub use sites::Sites;
pub use source::PointSource;

/// A point or vector in space; components beyond the dimension of the body are zero.
pub type Point = [f64; 3];
