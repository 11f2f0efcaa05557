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
mod gmsh;
mod obj;
mod off;
mod ply;
mod stl;
mod vtk;
mod vtk_array;
mod words;

pub use error::{MeshError, Place};

use std::path::Path;

use pericles::space::surface::{Surface, SurfaceError};

use crate::IoError;
use error::Fault;

/// Corners of an STL file nearer than this part of the surface's largest side are one vertex.
const WELD: f64 = 1e-9;

/// The endings of files that are read.
pub const SURFACE_ENDINGS: [&str; 7] = ["obj", "ply", "stl", "off", "msh", "vtu", "vtp"];

/// Reads a surface; the ending of the file's name tells the format.
///
/// # Errors
/// A file that cannot be read, an unknown ending, content that is not what the format says, with its place, and what [`Surface::new`] refuses.
pub fn read_surface(path: impl AsRef<Path>) -> Result<Surface, MeshError> {
    let path = path.as_ref();
    let ending = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    let parse = match ending.as_str() {
        "obj" => obj::parse,
        "ply" => ply::parse,
        "stl" => stl::parse,
        "off" => off::parse,
        "msh" => gmsh::parse,
        "vtu" | "vtp" => vtk::parse,
        _ => return Err(MeshError::UnknownFormat { path: path.into() }),
    };
    let content = std::fs::read(path).map_err(|source| IoError::reading(path, source))?;
    let mesh = parse(&content).map_err(|Fault { place, reason }| MeshError::Content {
        path: path.into(),
        place,
        reason,
    })?;
    mesh.surface(&ending).map_err(|source| MeshError::Surface {
        path: path.into(),
        source,
    })
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

    fn surface(self, ending: &str) -> Result<Surface, SurfaceError> {
        let surface = Surface::new(self.positions, self.triangles)?;
        match ending {
            "stl" => {
                let [low, high] = surface.bounds();
                let side = (0..3).map(|c| high[c] - low[c]).fold(0.0, f64::max);
                surface.welded(WELD * side)
            }
            "msh" | "vtu" | "vtp" => surface.without_unreferenced(),
            _ => Ok(surface),
        }
    }
}

#[cfg(test)]
mod tests;
