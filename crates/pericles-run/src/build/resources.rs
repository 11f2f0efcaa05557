//! What a model is built with besides its deck.

use std::path::{Path, PathBuf};

use pericles::cache::{Cache, NoCache};
use pericles::space::ListedPoints;
use pericles_deck::Fault;
use pericles_manifold::surface::Surface;
use pericles_mesh::RawMesh;

/// Why a file beside a deck gives nothing, in words, with the file and the place in it.
#[derive(Debug, Clone, PartialEq)]
pub enum FileError {
    /// It cannot be read, or its content is wrong.
    Wrong(String),
    /// Its content takes more memory than it may.
    TooLarge(String),
}

impl From<String> for FileError {
    fn from(reason: String) -> Self {
        Self::Wrong(reason)
    }
}

impl FileError {
    /// The fault of the entry that names the file; `wrong` makes that of a wrong file.
    pub(super) fn fault(self, wrong: impl FnOnce(String) -> Fault) -> Fault {
        match self {
            Self::Wrong(reason) => wrong(reason),
            Self::TooLarge(reason) => Fault::LargeFile { reason },
        }
    }
}

/// Reads a surface from a file; its content may take so many bytes of memory.
pub type SurfaceReader<'a> = dyn Fn(&Path, u64) -> Result<Surface, FileError> + Sync + 'a;

/// Reads the points of a body of a dimension from a file; its content may take so many bytes of memory.
pub type PointsReader<'a> =
    dyn Fn(&Path, usize, u64) -> Result<ListedPoints, FileError> + Sync + 'a;

/// Reads a mesh or a surface of triangles with its sets, in the file's unit of length; its content may take so many bytes of memory.
pub type MeshReader<'a> = dyn Fn(&Path, u64) -> Result<RawMesh, FileError> + Sync + 'a;

/// The corners of polygons.
pub type Polygons = Vec<Vec<[f64; 2]>>;

/// Reads the polygons of an outline, in the file's unit of length; its content may take so many bytes of memory.
pub type OutlineReader<'a> = dyn Fn(&Path, u64) -> Result<Polygons, FileError> + Sync + 'a;

/// Reads a table of numbers from a file: so many rows of columns with these names, row by row; its content may take so many bytes of memory.
pub type TableReader<'a> =
    dyn Fn(&Path, usize, &[&str], u64) -> Result<Vec<f64>, FileError> + Sync + 'a;

/// What a model is built with besides its deck. Decks know no files but themselves: who builds a model hands in what reads others.
#[derive(Clone, Copy)]
pub struct Resources<'a> {
    /// Where results that are dear to compute are kept.
    pub cache: &'a dyn Cache,
    /// The reader of bodies with `shape = "surface"`.
    pub read_surface: &'a SurfaceReader<'a>,
    /// The reader of bodies with `shape = "points"`.
    pub read_points: &'a PointsReader<'a>,
    /// The reader of bodies with `shape = "mesh"` and `"solid"`, and of pre-cracks from files.
    pub read_mesh: &'a MeshReader<'a>,
    /// The reader of bodies with `shape = "outline"`.
    pub read_outline: &'a OutlineReader<'a>,
    /// The reader of files of `[[initial]]`.
    pub read_table: &'a TableReader<'a>,
    /// The folder where relative paths of the model start; empty for the present folder.
    pub folder: &'a Path,
    /// Bytes that the model may take: one that is estimated to need more is refused before anything of its size is allocated.
    pub memory: u64,
}

impl Resources<'_> {
    /// Where a file is that the model names.
    pub(super) fn beside(&self, path: &Path) -> PathBuf {
        self.folder.join(path)
    }
}

impl Default for Resources<'_> {
    /// No cache, no reader of files, and memory without end.
    fn default() -> Self {
        Self {
            cache: &NoCache,
            read_surface: &|_, _| Err(no_reader("surfaces")),
            read_points: &|_, _, _| Err(no_reader("points")),
            read_mesh: &|_, _| Err(no_reader("meshes")),
            read_outline: &|_, _| Err(no_reader("outlines")),
            read_table: &|_, _, _, _| Err(no_reader("tables")),
            folder: Path::new(""),
            memory: u64::MAX,
        }
    }
}

fn no_reader(what: &str) -> FileError {
    FileError::Wrong(format!("nothing that reads {what} was handed in"))
}
