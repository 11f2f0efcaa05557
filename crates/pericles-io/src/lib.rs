//! File input and output of Pericles.
//!
//! | what | for whom | entry |
//! |---|---|---|
//! | output folder | one run at a time, locked | [`OutputFolder`] |
//! | `.vtu` and `.pvd` | ParaView and other viewers | [`VtuFile`], [`PvdSeries`]; read back by [`read_fields`] |
//! | Exodus II and VTKHDF | ParaView, VisIt, scripts; all outputs in one file | [`observers::ResultFile`] |
//! | `.npz` archives | NumPy | [`NpzWriter`] |
//! | `.csv` tables | spreadsheets, scripts | [`CsvTable`], [`read_csv`] |
//! | PNG pictures | people | [`FieldPicture`], [`LineChart`] |
//! | surfaces: `.obj`, `.ply`, `.stl`, `.off`, `.msh`, `.vtu`, `.vtp` | bodies that are closed surfaces | [`read_surface`] |
//! | meshes: all of these, Abaqus `.inp`, Exodus II | points and sets from elements, bodies in closed surfaces | [`read_mesh`] |
//! | text `x y z block volume` | bodies given by a list of points | [`read_points`] |
//! | text with a line `x y` for each corner | plane bodies given by outlines | [`read_outline`] |
//! | text with a line of numbers for each point | initial states | [`read_rows`] |
//! | stand-alone HTML pages of field series | browsers | [`viewer`] |
//! | checkpoints | resuming a run bit for bit | [`CheckpointFolder`], [`Container`] |
//! | cached results | reused by all runs of a user | [`DiskCache`] |
//! | all of these except checkpoints | output during a simulation | [`observers`] |
//!
//! Except for the observers, all functions take plain slices in SI units, in the component-major layout of
//! Pericles (`u[c * n + i]`), and do not depend on the physics. Field files, pictures and checkpoints are
//! written atomically ([`write_atomically`]), and their bytes depend on the data alone: not on the clock,
//! path or number of threads. Readers take a `memory` limit in bytes and reject content that would exceed it.
//! [`IoError`] classifies errors by what the user can do about them.
//!
//! Readers of external data have entry points that take bytes, which fuzz targets, tests and file input share.
//!
//! ```
//! use pericles_io::{CheckpointFolder, Column, CsvTable, OutputFolder, PvdSeries, VtkField, VtuFile};
//! # fn main() -> Result<(), pericles_io::IoError> {
//! # let place = tempfile::tempdir().unwrap();
//! # let stem = place.path().join("branching");
//! let folder = OutputFolder::create_numbered(stem)?;
//! let mut history = CsvTable::create(folder.file("history.csv"), &[Column::real("time", "s")])?;
//! let mut series = PvdSeries::create(folder.file("fields.pvd"))?;
//! folder.subfolder("fields")?;
//!
//! let (x, damage) = ([0.0, 1e-3], [0.0, 0.5]);
//! let file = PvdSeries::field_file(series.len());
//! VtuFile::new(1, &x).field(VtkField::scalar("Damage", &damage)).write(folder.file(&file))?;
//! series.push(0.0, &file)?;
//! history.append(&[0.0.into()])?;
//! history.sync()?; // what a checkpoint records must be on disk
//! let checkpoints = CheckpointFolder::new(folder.file("checkpoints"));
//! # drop(checkpoints);
//! # Ok(())
//! # }
//! ```

mod atomic;
mod cache;
mod checkpoint;
mod csv;
mod error;
mod file_stem;
mod folder;
mod mesh;
mod npz;
mod numbering;
pub mod observers;
mod outline;
mod picture;
mod points;
mod result_body;
mod rows;
mod text_error;
pub mod viewer;
mod vtk;
mod whole;
mod xml;

pub use atomic::write_atomically;
pub use cache::DiskCache;
pub use checkpoint::{
    CheckpointFolder, Container, DividedCheckpoint, LatestCheckpoint, Section, write_divided,
};
pub use csv::{Cell, Column, CsvData, CsvTable, csv_row, read_csv};
pub use error::IoError;
pub use file_stem::file_stem;
pub use folder::OutputFolder;
pub use mesh::{
    FieldColumn, FieldData, MESH_ENDINGS, MeshError, Place, SURFACE_ENDINGS, parse_fields,
    parse_mesh, parse_surface, read_fields, read_mesh, read_surface,
};
pub use npz::NpzWriter;
pub use numbering::in_user_order;
pub use outline::{parse_outline, read_outline};
pub use picture::{
    Axis, Backdrop, CellSize, ColourMap, Curve, Extent, FieldPicture, LineChart, PictureStyle,
    Polygon, Polygons, Print, quantity, write_animation,
};
pub use points::{parse_points, read_points};
pub use result_body::{ResultBody, write_error};
pub use rows::{parse_rows, read_rows};
pub use text_error::TextError;
pub use vtk::{PvdSeries, VtkField, VtuCells, VtuFile};
pub use xml::escaped;
