//! Meshes and surfaces: read, turned into points with volumes and sets, filled with lattices or random points; results as Exodus II and VTKHDF files.
//!
//! | what | entry |
//! |---|---|
//! | a mesh as it is in a file (Gmsh, Abaqus, Exodus II, VTK, STL, OBJ, PLY, OFF) | [`Format::parse`] → [`RawMesh`] |
//! | volume and centroid of an element | [`element::measure`] |
//!
//! Positions have three coordinates, plane meshes the same z everywhere. This crate reads no files but writes some: readers take the content of a file.

mod cell;
pub mod element;
mod fault;
pub mod fill;
mod format;
mod netcdf;
mod points;
pub mod random;
mod raw;
pub mod results;
mod scan;

pub use cell::{CellKind, Facet};
pub use fault::{Fault, Place};
pub use format::{FieldColumn, FieldData, Format, Include, parse_fields};
pub use points::{
    ElementSize, MeshPoints, PointOptions, PointSet, Problem, SetKind, SetSummary, Summary,
};
pub use raw::{Cells, FaceSet, InvalidMesh, NamedList, RawMesh};
