//! Files of Pericles.

mod atomic;
mod checkpoint;
mod csv;
mod error;
mod folder;
mod vtk;

pub use atomic::write_atomically;
pub use checkpoint::{CheckpointFolder, Container, LatestCheckpoint, Section};
pub use csv::{Cell, Column, CsvData, CsvTable, read_csv};
pub use error::IoError;
pub use folder::OutputFolder;
pub use vtk::{PvdSeries, VtkField, VtuFile};
