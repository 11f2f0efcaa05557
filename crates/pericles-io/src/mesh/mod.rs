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

mod bytes;
mod error;
mod fields;
mod gmsh;
mod obj;
mod off;
mod ply;
mod stl;
mod vtk;
mod vtk_array;
mod words;

pub use error::{MeshError, Place};
pub use fields::{FieldColumn, FieldData, parse_fields, read_fields};

use std::path::Path;

use pericles_manifold::surface::{Surface, SurfaceError};

use crate::whole::read_whole;
use error::Fault;

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
    let format = Format::of(path)?;
    let content = read_whole(path, EXPANSION, memory)?;
    format.surface(path, &content, memory)
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
    Format::of(name)?.surface(name, content, memory)
}

/// A format by its ending.
struct Format {
    parse: fn(&[u8], u64) -> Result<Mesh, Fault>,
    /// Corners are given again for every triangle.
    unwelded: bool,
    /// Vertices may belong to other things than surfaces.
    mixed: bool,
}

impl Format {
    fn of(path: &Path) -> Result<Self, MeshError> {
        let ending = path
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        let parse: fn(&[u8], u64) -> Result<Mesh, Fault> = match ending.as_str() {
            // Only VTK's arrays are compressed: the others take little more than the content.
            "obj" => |content, _| obj::parse(content),
            "ply" => |content, _| ply::parse(content),
            "stl" => |content, _| stl::parse(content),
            "off" => |content, _| off::parse(content),
            "msh" => |content, _| gmsh::parse(content),
            "vtu" | "vtp" => vtk::parse,
            _ => return Err(MeshError::UnknownFormat { path: path.into() }),
        };
        Ok(Self {
            parse,
            unwelded: ending == "stl",
            mixed: matches!(ending.as_str(), "msh" | "vtu" | "vtp"),
        })
    }

    fn surface(&self, path: &Path, content: &[u8], memory: u64) -> Result<Surface, MeshError> {
        let mesh = (self.parse)(content, memory).map_err(|fault| fault.of(path, memory))?;
        self.made(mesh).map_err(|source| MeshError::Surface {
            path: path.into(),
            source,
        })
    }

    fn made(&self, mesh: Mesh) -> Result<Surface, SurfaceError> {
        let surface = Surface::new(mesh.positions, mesh.triangles)?;
        if self.unwelded {
            let [low, high] = surface.bounds();
            let side = (0..3).map(|c| high[c] - low[c]).fold(0.0, f64::max);
            return surface.welded(WELD * side);
        }
        if self.mixed {
            return surface.without_unreferenced();
        }
        Ok(surface)
    }
}

/// Vertices and triangles as they are in a file.
#[derive(Debug, Default, PartialEq)]
struct Mesh {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds the triangles of a polygon's fan.
    fn polygon(&mut self, corners: &[u32]) {
        for pair in corners.windows(2).skip(1) {
            self.triangles.push([corners[0], pair[0], pair[1]]);
        }
    }
}

#[cfg(test)]
mod tests;
