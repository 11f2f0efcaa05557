//! What can be wrong with a file of a surface.

use std::path::{Path, PathBuf};

use pericles_manifold::surface::SurfaceError;
use pericles_mesh::{Fault, Format, Place};

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
    /// An ending that belongs to no format of meshes.
    #[error("{}: meshes are read from files that end in .{}", path.display(), Format::ENDINGS.join(", ."))]
    UnknownMeshFormat {
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

/// The error of a file, read with so many bytes of memory.
pub(super) fn fault_of(fault: Fault, path: &Path, memory: u64) -> MeshError {
    let path = match fault.included {
        Some(name) => path.with_file_name(name),
        None => path.to_path_buf(),
    };
    match fault.needed {
        Some(needed) => MeshError::Io(IoError::TooLarge {
            path,
            needed,
            memory,
        }),
        None => MeshError::Content {
            path,
            place: fault.place,
            reason: fault.reason,
        },
    }
}
