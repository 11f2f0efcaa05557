//! What can be wrong with a file of a surface.

use std::fmt;
use std::path::{Path, PathBuf};

use pericles_manifold::surface::SurfaceError;

use super::SURFACE_ENDINGS;
use crate::IoError;

/// Why a file gives no surface.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The file cannot be read.
    #[error(transparent)]
    Io(#[from] IoError),
    /// An ending that belongs to no format.
    #[error("{}: surfaces are read from files that end in .{}", path.display(), SURFACE_ENDINGS.join(", ."))]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// Content that is not what the format says.
    #[error("{}{place}: {reason}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// Vertices and triangles that make no surface.
    #[error("{}: {source}", path.display())]
    Surface {
        /// The file.
        path: PathBuf,
        /// Why.
        source: SurfaceError,
    },
}

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// A line of text, from 1.
    Line(usize),
    /// A byte, from 0.
    Byte(usize),
    /// The file as a whole.
    File,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, ":{line}"),
            Self::Byte(byte) => write!(f, ", byte {byte}"),
            Self::File => Ok(()),
        }
    }
}

/// What is wrong, before the path is known.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fault {
    pub(super) place: Place,
    pub(super) reason: String,
    /// Bytes that the content would take, where these are too many.
    pub(super) needed: Option<u64>,
}

impl Fault {
    pub(super) fn at_line(line: usize, reason: impl Into<String>) -> Self {
        Self {
            place: Place::Line(line),
            reason: reason.into(),
            needed: None,
        }
    }

    pub(super) fn at_byte(byte: usize, reason: impl Into<String>) -> Self {
        Self {
            place: Place::Byte(byte),
            reason: reason.into(),
            needed: None,
        }
    }

    pub(super) fn of_file(reason: impl Into<String>) -> Self {
        Self {
            place: Place::File,
            reason: reason.into(),
            needed: None,
        }
    }

    /// Content that would take so many bytes, more than there may be.
    pub(super) fn too_large(needed: u64) -> Self {
        Self {
            needed: Some(needed),
            ..Self::of_file("too large")
        }
    }

    /// The error of this file, read with so many bytes of memory.
    pub(super) fn of(self, path: &Path, memory: u64) -> MeshError {
        let path = path.to_path_buf();
        match self.needed {
            Some(needed) => MeshError::Io(IoError::TooLarge {
                path,
                needed,
                memory,
            }),
            None => MeshError::Content {
                path,
                place: self.place,
                reason: self.reason,
            },
        }
    }
}
