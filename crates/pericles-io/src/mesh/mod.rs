//! Triangulated surfaces from files.
//!
//! | ending | format | forms |
//! |---|---|---|
//! | `.obj` | Wavefront | text; polygons, negative numbers |
//! | `.ply` | Stanford polygons | text, binary of either byte order |
//! | `.stl` | stereolithography | text, binary; equal corners are welded |
//! | `.off` | Object File Format | text |
//! | `.msh` | Gmsh 2.2 and 4.1 | text, binary; triangles and quadrilaterals, other elements are left out |
//! | `.vtu`, `.vtp` | VTK XML | text, base64, appended, compressed with zlib; triangles, quadrilaterals, polygons |
//!
//! Polygons are cut into the triangles of a fan from their first corner. Vertices that no triangle uses are left out of Gmsh and VTK files, which keep
//! other things than surfaces as well, and so change the numbers of those behind them; elsewhere they stay, to be found by the surface's checks.
//! Counts in a file are compared with what is left of it before anything is allocated. Whether the surface is closed and oriented is not asked here: see
//! [`Surface::checked`].

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

/// Corners of an STL file nearer than this part of the surface's largest side are one vertex.
const WELD: f64 = 1e-9;

/// Memory that a file takes over its size: its content, the numbers in it, and the surface made of them.
const EXPANSION: u64 = 8;

/// The endings of files that are read.
pub const SURFACE_ENDINGS: [&str; 7] = ["obj", "ply", "stl", "off", "msh", "vtu", "vtp"];

/// Reads a surface; the ending of the file's name tells the format.
///
/// # Errors
/// A file that cannot be read or needs more than `memory` bytes, an unknown ending, content that is not what the format says, with its place, and what
/// [`Surface::new`] refuses.
pub fn read_surface(path: impl AsRef<Path>, memory: u64) -> Result<Surface, MeshError> {
    let path = path.as_ref();
    let format = format_of(path)?;
    let content = read_whole(path, EXPANSION, memory)?;
    surface(format, path, &content, memory)
}

/// The endings of files of meshes.
pub const MESH_ENDINGS: [&str; 13] = Format::ENDINGS;

/// Reads a mesh with its sets, in the file's unit of length; the ending of the file's name tells the format. Files that an Abaqus file includes are read from its
/// folder.
///
/// # Errors
/// A file that cannot be read or needs more than `memory` bytes, an unknown ending, content that is not what the format says, with its place.
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

/// The mesh in the content of a file; its name tells the format, and is what messages call it. No other files are read.
///
/// # Errors
/// As [`read_mesh`], but for a file that cannot be read.
pub fn parse_mesh(
    name: impl AsRef<Path>,
    content: &[u8],
    memory: u64,
) -> Result<RawMesh, MeshError> {
    let name = name.as_ref();
    let alone = |included: &str| Err(format!("{included} is included, which is not read here"));
    mesh(mesh_format_of(name)?, name, content, memory, &alone)
}

/// The format of a file of a mesh.
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

/// The surface in the content of a file; its name tells the format, and is what messages call it.
///
/// # Errors
/// As [`read_surface`], but for a file that cannot be read.
pub fn parse_surface(
    name: impl AsRef<Path>,
    content: &[u8],
    memory: u64,
) -> Result<Surface, MeshError> {
    let name = name.as_ref();
    surface(format_of(name)?, name, content, memory)
}

/// The format of a file of a surface.
fn format_of(path: &Path) -> Result<Format, MeshError> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let known = SURFACE_ENDINGS.contains(&ending.to_lowercase().as_str());
    Format::of(path)
        .filter(|_| known)
        .ok_or_else(|| MeshError::UnknownFormat { path: path.into() })
}

fn surface(format: Format, path: &Path, content: &[u8], memory: u64) -> Result<Surface, MeshError> {
    let alone = |name: &str| Err(format!("{name} is not read: surfaces include no files"));
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
