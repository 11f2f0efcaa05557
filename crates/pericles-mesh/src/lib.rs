//! Meshes and surfaces: reading, points with volumes and sets, filling with lattices or random points, and
//! result files in Exodus II and VTKHDF.
//!
//! | task | entry |
//! |---|---|
//! | mesh of a file (Gmsh, Abaqus, Exodus II, VTK, STL, OBJ, PLY, OFF) | [`Format::parse`] → [`RawMesh`] |
//! | points with volumes and sets from elements | [`RawMesh::points`] → [`MeshPoints`], [`Summary`] |
//! | volume and centroid of an element | [`element::measure`] |
//! | lattices in closed surfaces and outlines | [`fill`] |
//! | points with random positions | [`random`] |
//! | results as Exodus II and VTKHDF | [`results`] |
//!
//! ```
//! use pericles_mesh::{Format, PointOptions};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let file = b"*NODE\n1, 0\n2, 10\n3, 0, 10\n4, 0, 0, 10\n*ELEMENT, TYPE=C3D4, ELSET=steel\n1, 1, 2, 3, 4\n";
//! let mesh = Format::Abaqus.parse(file, 1 << 20, &|name| Err(format!("{name} does not exist")))?;
//! // The file is in millimetres.
//! let points = mesh.points(&PointOptions { unit: 1e-3, ..Default::default() })?;
//! assert!((points.volumes[0] - 1e-6 / 6.0).abs() < 1e-20);
//! assert_eq!(points.set("steel").unwrap().points, [0]);
//! # Ok(())
//! # }
//! ```
//!
//! Positions have three coordinates; plane meshes have constant z. Readers take the content of a file; only
//! result files are written by this crate.

mod cell;
mod digits;
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
