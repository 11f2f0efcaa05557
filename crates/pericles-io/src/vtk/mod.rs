//! VTK files of fields on points, for ParaView, VisIt, PyVista and meshio.
//!
//! * `.vtu` ([`VtuFile`]): one output. An unstructured grid with one vertex cell per point; point data as
//!   appended raw binary, little-endian, in zlib-compressed blocks; the time as field data `TimeValue`.
//!   Vectors have three components, missing ones are zero. The bytes depend on the data alone.
//! * `.pvd` ([`PvdSeries`]): the collection that assigns a time to every `.vtu`. Open this file in a viewer.
//!
//! Arrays are passed in component-major layout (`u[c * n + i]`) and are interleaved during writing.
//! Reference: the VTK XML file formats, <https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html>.
//!
//! ```
//! use pericles_io::{PvdSeries, VtkField, VtuFile};
//! let folder = tempfile::tempdir().unwrap();
//! std::fs::create_dir(folder.path().join("fields")).unwrap();
//! let x = [0.0, 1.0, 2.0, 0.5, 0.5, 0.5]; // three points in the plane: x of all, then y of all
//! let damage = [0.0, 0.25, 1.0];
//! let mut series = PvdSeries::create(folder.path().join("fields.pvd")).unwrap();
//! let file = PvdSeries::field_file(0);
//! VtuFile::new(2, &x)
//!     .time(1e-6)
//!     .field(VtkField::scalar("Damage", &damage))
//!     .write(folder.path().join(&file))
//!     .unwrap();
//! series.push(1e-6, &file).unwrap();
//! ```

mod blocks;
mod cells;
#[cfg(test)]
pub(crate) mod decode;
mod field;
mod pvd;
mod vtp;
mod vtu;

pub use cells::VtuCells;
pub use field::VtkField;
pub use pvd::PvdSeries;
pub(crate) use vtp::{read_polydata, write_polydata};
pub use vtu::VtuFile;
