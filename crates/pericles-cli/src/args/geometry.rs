//! Arguments of `mesh`, `export` and `view`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use pericles_run::{Selection, machine};

use super::Length;
use super::Memory;
use super::values::{LengthUnit, length, length_unit};

/// Arguments of `mesh`.
#[derive(Debug, Args)]
pub(crate) struct MeshArgs {
    /// A mesh (.msh, .inp, .e, .exo, .g, .vtu) or a triangulated surface (.stl, .obj, .ply, .off, .vtp)
    pub(crate) file: PathBuf,
    /// Length unit of the file, such as mm
    #[arg(long, value_name = "UNIT", default_value = "m", value_parser = length_unit)]
    pub(crate) unit: LengthUnit,
    /// Thickness of a 2D mesh
    #[arg(long, value_name = "LENGTH", default_value = "1 m", value_parser = length)]
    pub(crate) thickness: Length,
    /// Comma-separated groups whose elements form the body [default: all elements of the highest dimension]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) blocks: Vec<String>,
    /// Write the results as JSON, in SI units, to a file; `-` writes to standard output and suppresses other output
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) memory: Memory,
}

/// Arguments of `export`.
#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    /// The output folder of a run
    pub(crate) dir: PathBuf,
    /// The format
    #[arg(long, value_enum)]
    pub(crate) to: ExportFormat,
    /// The file to write, or the folder for csv, which must not exist [default: fields with the format's extension in
    /// the output folder]
    #[arg(long, value_name = "PATH")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) selection: SelectionArgs,
}

/// Arguments of `view`.
#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    /// The output folder of a run
    pub(crate) dir: PathBuf,
    /// The file to write; an existing one is replaced [default: fields.html in the output folder]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Write the page without opening it
    #[arg(long)]
    pub(crate) no_open: bool,
    #[command(flatten)]
    pub(crate) selection: SelectionArgs,
}

/// Selection of output times and fields.
#[derive(Debug, Args)]
pub(crate) struct SelectionArgs {
    /// Use every N-th output time, and the last one [default: all]
    #[arg(long, value_name = "N")]
    pub(crate) every: Option<NonZeroUsize>,
    /// Largest size of the fields of a page, such as 20MB: a page of a larger series has fewer output times [default: 200MB]
    #[arg(long, value_name = "SIZE", value_parser = machine::size, conflicts_with = "every")]
    pub(crate) max_size: Option<u64>,
    /// Comma-separated names of the fields, such as Damage,Velocity,Stress [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) fields: Vec<String>,
}

impl SelectionArgs {
    pub(crate) fn selection(&self) -> Selection {
        Selection {
            every: self.every,
            size: self.max_size,
            fields: self.fields.clone(),
        }
    }
}

/// Formats of exported fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExportFormat {
    /// One Exodus II file, for ParaView, VisIt and SEACAS
    Exodus,
    /// One VTKHDF file, for ParaView 5.12 and later
    Vtkhdf,
    /// One CSV table per output time
    Csv,
    /// One NumPy archive
    Npz,
    /// One page for browsers, which shows the fields over time, as `pericles view` does
    Html,
}
