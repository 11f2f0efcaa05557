//! Resources for building a model: cache, memory limit, readers of files.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pericles::cache::{Cache, NoCache};
use pericles::domain::Comm;
use pericles::space::ListedPoints;
use pericles_deck::Fault;
use pericles_manifold::surface::Surface;
use pericles_mesh::RawMesh;

use crate::origin::InitialState;

/// Error of an input file, as a message with the file and the location in it.
#[derive(Debug, Clone, PartialEq)]
pub enum FileError {
    /// The file cannot be read, or its content is invalid.
    Wrong(String),
    /// The content exceeds the memory limit.
    TooLarge(String),
}

impl From<String> for FileError {
    fn from(reason: String) -> Self {
        Self::Wrong(reason)
    }
}

impl FileError {
    /// Converts the error to the fault of the key of the file; `wrong` creates the fault of an invalid file.
    pub(super) fn fault(self, wrong: impl FnOnce(String) -> Fault) -> Fault {
        match self {
            Self::Wrong(reason) => wrong(reason),
            Self::TooLarge(reason) => Fault::LargeFile { reason },
        }
    }
}

/// Reads a surface from a file, with a memory limit in bytes.
pub type SurfaceReader<'a> = dyn Fn(&Path, u64) -> Result<Surface, FileError> + Sync + 'a;

/// Reads the points of a body of a given dimension from a file, with a memory limit in bytes.
pub type PointsReader<'a> =
    dyn Fn(&Path, usize, u64) -> Result<ListedPoints, FileError> + Sync + 'a;

/// Reads a mesh or a triangulated surface with its sets, in the length unit of the file, with a memory limit in bytes.
pub type MeshReader<'a> = dyn Fn(&Path, u64) -> Result<RawMesh, FileError> + Sync + 'a;

/// The vertices of polygons.
pub type Polygons = Vec<Vec<[f64; 2]>>;

/// Reads the polygons of an outline, in the length unit of the file, with a memory limit in bytes.
pub type OutlineReader<'a> = dyn Fn(&Path, u64) -> Result<Polygons, FileError> + Sync + 'a;

/// Reads a table of numbers from a file, given the column names and the number of rows, if it is known, row by row, with a
/// memory limit in bytes.
pub type TableReader<'a> =
    dyn Fn(&Path, Option<usize>, &[&str], u64) -> Result<Vec<f64>, FileError> + Sync + 'a;

/// Resources for building a model besides its deck. Decks do not read other files: the caller provides the readers.
#[derive(Clone, Copy)]
pub struct Resources<'a> {
    /// The cache for expensive results.
    pub cache: &'a dyn Cache,
    /// The reader of bodies with `shape = "surface"`.
    pub read_surface: &'a SurfaceReader<'a>,
    /// The reader of bodies with `shape = "points"`.
    pub read_points: &'a PointsReader<'a>,
    /// The reader of bodies with `shape = "mesh"` and `"solid"`, and of pre-cracks from files.
    pub read_mesh: &'a MeshReader<'a>,
    /// The reader of bodies with `shape = "outline"`.
    pub read_outline: &'a OutlineReader<'a>,
    /// The reader of files of `[[initial]]`, `[thermal]` and `[[activation]]`.
    pub read_table: &'a TableReader<'a>,
    /// The base folder of relative paths of the model; empty for the current folder.
    pub folder: &'a Path,
    /// Communication with the processes among which the body is divided; `None` for a single process.
    pub comm: Option<&'a Arc<dyn Comm>>,
    /// Where the initial state comes from.
    pub start: InitialState<'a>,
    /// Memory limit in bytes: models with a larger estimate are rejected before large allocations.
    pub memory: u64,
}

impl Resources<'_> {
    /// Returns the communication with the other processes, if there are several.
    pub(super) fn several(&self) -> Option<&Arc<dyn Comm>> {
        self.comm.filter(|comm| comm.size() > 1)
    }

    /// Returns the path of an input file.
    pub(super) fn beside(&self, path: &Path) -> PathBuf {
        self.folder.join(path)
    }
}

impl Default for Resources<'_> {
    /// No cache, no readers, and no memory limit.
    fn default() -> Self {
        Self {
            cache: &NoCache,
            read_surface: &|_, _| Err(no_reader("surfaces")),
            read_points: &|_, _, _| Err(no_reader("points")),
            read_mesh: &|_, _| Err(no_reader("meshes")),
            read_outline: &|_, _| Err(no_reader("outlines")),
            read_table: &|_, _, _, _| Err(no_reader("tables")),
            folder: Path::new(""),
            comm: None,
            start: InitialState::Model,
            memory: u64::MAX,
        }
    }
}

fn no_reader(what: &str) -> FileError {
    FileError::Wrong(format!("no reader for {what} is available"))
}
