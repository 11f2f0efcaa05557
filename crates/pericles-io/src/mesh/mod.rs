//! Reading of triangulated surfaces and meshes.
//!
//! | extension | format | variants |
//! |---|---|---|
//! | `.obj` | Wavefront | text; polygons, negative indices |
//! | `.ply` | Stanford polygons | text, binary of either byte order |
//! | `.stl` | stereolithography | text, binary; coincident corners are merged |
//! | `.off` | Object File Format | text |
//! | `.msh` | Gmsh 2.2 and 4.1 | text, binary; triangles and quadrilaterals, other elements are ignored |
//! | `.vtu`, `.vtp` | VTK XML | text, base64, appended, compressed with zlib; triangles, quadrilaterals, polygons |
//!
//! Polygons are split into triangle fans from their first corner. Vertices without triangles are removed from
//! Gmsh and VTK files, which may contain more than a surface, so that later vertices are renumbered; in other
//! formats they are kept and reported by the checks of the surface. Counts in a file are compared with its
//! remaining length before memory is allocated. Whether the surface is closed and consistently oriented is
//! checked by [`Surface::checked`].

mod error;
mod fields;

pub use error::MeshError;
pub use fields::{parse_fields, read_fields};
pub use pericles_mesh::{FieldColumn, FieldData, Place};

use std::path::Path;

use pericles_manifold::surface::{Surface, SurfaceError};
use pericles_mesh::{Format, Include, RawMesh};

use crate::whole::read_whole;
use error::fault_of;

/// Corners of an STL file closer than this fraction of the largest side of the surface are merged into one
/// vertex.
const WELD: f64 = 1e-9;

/// Memory relative to the file size: the content, the parsed numbers and the surface.
const EXPANSION: u64 = 8;

/// File extensions of surfaces.
pub const SURFACE_ENDINGS: [&str; 7] = ["obj", "ply", "stl", "off", "msh", "vtu", "vtp"];

/// Reads a surface; the file extension selects the format.
///
/// # Errors
/// Returns an error if the file cannot be read or exceeds `memory` bytes, for an unknown extension, for
/// invalid content (with its location), and for surfaces that [`Surface::new`] rejects.
pub fn read_surface(path: impl AsRef<Path>, memory: u64) -> Result<Surface, MeshError> {
    let path = path.as_ref();
    let format = format_of(path)?;
    let content = read_whole(path, EXPANSION, memory)?;
    surface(format, path, &content, memory)
}

/// File extensions of meshes.
pub const MESH_ENDINGS: [&str; 13] = Format::ENDINGS;

/// Reads a mesh with its sets, in the length unit of the file; the file extension selects the format. Files
/// included by an Abaqus file are read from its folder.
///
/// # Errors
/// Returns an error if the file cannot be read or exceeds `memory` bytes, for an unknown extension, and for
/// invalid content (with its location).
pub fn read_mesh(path: impl AsRef<Path>, memory: u64) -> Result<RawMesh, MeshError> {
    let path = path.as_ref();
    let format = mesh_format_of(path)?;
    let content = read_whole(path, EXPANSION, memory)?;
    let include = |name: &str| {
        let included = path.with_file_name(name);
        read_whole(&included, EXPANSION, memory).map_err(|error| error.to_string())
    };
    mesh(format, path, &content, memory, &include)
}

/// Parses the content of a mesh file; `name` selects the format and is used in messages. Included files are
/// not read.
///
/// # Errors
/// As [`read_mesh`], except for errors of reading the file.
pub fn parse_mesh(
    name: impl AsRef<Path>,
    content: &[u8],
    memory: u64,
) -> Result<RawMesh, MeshError> {
    let name = name.as_ref();
    let alone = |included: &str| Err(format!("the included file {included} is not read here"));
    mesh(mesh_format_of(name)?, name, content, memory, &alone)
}

/// Returns the format of a mesh file.
fn mesh_format_of(path: &Path) -> Result<Format, MeshError> {
    Format::of(path).ok_or_else(|| MeshError::UnknownMeshFormat { path: path.into() })
}

fn mesh(
    format: Format,
    path: &Path,
    content: &[u8],
    memory: u64,
    include: &Include<'_>,
) -> Result<RawMesh, MeshError> {
    format
        .parse(content, memory, include)
        .map_err(|fault| fault_of(fault, path, memory))
}

/// Parses the content of a surface file; `name` selects the format and is used in messages.
///
/// # Errors
/// As [`read_surface`], except for errors of reading the file.
pub fn parse_surface(
    name: impl AsRef<Path>,
    content: &[u8],
    memory: u64,
) -> Result<Surface, MeshError> {
    let name = name.as_ref();
    surface(format_of(name)?, name, content, memory)
}

/// Returns the format of a surface file.
fn format_of(path: &Path) -> Result<Format, MeshError> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let known = SURFACE_ENDINGS.contains(&ending.to_lowercase().as_str());
    Format::of(path)
        .filter(|_| known)
        .ok_or_else(|| MeshError::UnknownFormat { path: path.into() })
}

fn surface(format: Format, path: &Path, content: &[u8], memory: u64) -> Result<Surface, MeshError> {
    let alone = |name: &str| {
        Err(format!(
            "{name} is not read: surface files cannot include other files"
        ))
    };
    let mesh = format
        .parse(content, memory, &alone)
        .map_err(|fault| fault_of(fault, path, memory))?;
    made(format, mesh).map_err(|source| MeshError::Surface {
        path: path.into(),
        source,
    })
}

fn made(format: Format, mesh: RawMesh) -> Result<Surface, SurfaceError> {
    let triangles = mesh.triangles();
    let surface = Surface::new(mesh.nodes, triangles)?;
    if format.repeats_corners() {
        let [low, high] = surface.bounds();
        let side = (0..3).map(|c| high[c] - low[c]).fold(0.0, f64::max);
        return surface.welded(WELD * side);
    }
    if format.is_mixed() {
        return surface.without_unreferenced();
    }
    Ok(surface)
}

#[cfg(test)]
mod tests;
