//! What a model is built with besides its deck.

use std::path::Path;

use pericles::cache::{Cache, NoCache};
use pericles::space::ListedPoints;
use pericles::space::surface::Surface;

/// Reads a surface from a file; the error says in words what is wrong, with the file and the place in it.
pub type SurfaceReader<'a> = dyn Fn(&Path) -> Result<Surface, String> + Sync + 'a;

/// Reads the points of a body of a dimension from a file; the error says in words what is wrong, with the file and the place in it.
pub type PointsReader<'a> = dyn Fn(&Path, usize) -> Result<ListedPoints, String> + Sync + 'a;

/// What a model is built with besides its deck. Decks know no files but themselves: who builds a model hands in what reads others.
#[derive(Clone, Copy)]
pub struct Resources<'a> {
    /// Where results that are dear to compute are kept.
    pub cache: &'a dyn Cache,
    /// The reader of bodies with `shape = "surface"`.
    pub read_surface: &'a SurfaceReader<'a>,
    /// The reader of bodies with `shape = "points"`.
    pub read_points: &'a PointsReader<'a>,
    /// Bytes that the model may take: one that is estimated to need more is refused before anything of its size is allocated.
    pub memory: u64,
}

impl Default for Resources<'_> {
    /// No cache, no reader of files, and memory without end.
    fn default() -> Self {
        Self {
            cache: &NoCache,
            read_surface: &|_| Err("nothing that reads surfaces was handed in".into()),
            read_points: &|_, _| Err("nothing that reads points was handed in".into()),
            memory: u64::MAX,
        }
    }
}
