//! Errors of reading surfaces and meshes.

use std::path::{Path, PathBuf};

use pericles_manifold::surface::SurfaceError;
use pericles_mesh::{Fault, Format, Place};

use super::SURFACE_ENDINGS;
use crate::IoError;

/// Errors of reading a surface or mesh file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The file cannot be read.
    #[error(transparent)]
    Io(#[from] IoError),
    /// An unknown file extension for a surface.
    #[error("{}: unknown surface format; allowed file extensions: .{}", path.display(), SURFACE_ENDINGS.join(", ."))]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// An unknown file extension for a mesh.
    #[error("{}: unknown mesh format; allowed file extensions: .{}", path.display(), Format::ENDINGS.join(", ."))]
    UnknownMeshFormat {
        /// The file.
        path: PathBuf,
    },
    /// Content that violates the format.
    #[error("{}{place}: {reason}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Location in the file.
        place: Place,
        /// What is wrong and what is allowed.
        reason: String,
    },
    /// Vertices and triangles that do not form a surface.
    #[error("{}: {source}", path.display())]
    Surface {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: SurfaceError,
    },
}

/// Converts a fault of a file that was read with a memory limit in bytes.
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
