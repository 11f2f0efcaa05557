//! The commands on files of meshes and of results.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::Length;
use super::Memory;
use super::values::{LengthUnit, length, length_unit};

/// `mesh`
#[derive(Debug, Args)]
pub(crate) struct MeshArgs {
    /// A mesh (.msh, .inp, .e, .exo, .g, .vtu) or a surface of triangles (.stl, .obj, .ply, .off, .vtp)
    pub(crate) file: PathBuf,
    /// The file's unit of length, such as mm
    #[arg(long, value_name = "UNIT", default_value = "m", value_parser = length_unit)]
    pub(crate) unit: LengthUnit,
    /// The thickness of a plane mesh
    #[arg(long, value_name = "LENGTH", default_value = "1 m", value_parser = length)]
    pub(crate) thickness: Length,
    /// The groups whose elements are the body, with commas between them [default: all elements of the highest dimension]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) blocks: Vec<String>,
    /// Write the results as JSON, in SI units, to a file; `-` is the standard output, which then holds nothing else
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) memory: Memory,
}

/// `export`
#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    /// The folder of a run
    pub(crate) dir: PathBuf,
    /// The format
    #[arg(long, value_enum)]
    pub(crate) to: ExportFormat,
    /// The file; for csv a folder; must not exist [default: fields with the format's ending in the folder of the run]
    #[arg(long, value_name = "PATH")]
    pub(crate) out: Option<PathBuf>,
}

/// A format of exported fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExportFormat {
    /// One Exodus II file, for ParaView, VisIt and SEACAS
    Exodus,
    /// One VTKHDF file, for ParaView 5.12 and later
    Vtkhdf,
    /// One table for each output, for spreadsheets
    Csv,
    /// One archive of NumPy arrays
    Npz,
}
