//! File formats of meshes and surfaces.
//!
//! | extension | format | variants |
//! |---|---|---|
//! | `.obj` | Wavefront | text; polygons, negative indices |
//! | `.ply` | Stanford polygons | text, binary of either byte order |
//! | `.stl` | stereolithography | text, binary |
//! | `.off` | Object File Format | text |
//! | `.msh` | Gmsh 2.2 and 4.1 | text, binary; physical groups |
//! | `.vtu`, `.vtp` | VTK XML | text, base64, appended, compressed with zlib |
//! | `.inp` | Abaqus | text; parts, instances, sets, surfaces |
//! | `.e`, `.exo`, `.ex2`, `.g`, `.gen` | Exodus II | classic netCDF (CDF-1, CDF-2, CDF-5); netCDF-4 (HDF5) with the feature `netcdf4` |
//!
//! A polygon with more than four corners is split into a triangle fan from its first corner. Counts in a file
//! are compared with its remaining length before memory is allocated.

mod abaqus;
mod exodus;
mod gmsh;
mod obj;
mod off;
mod ply;
mod stl;
mod vtk;

pub use vtk::{FieldColumn, FieldData, parse_fields};

use std::path::Path;

use crate::fault::Fault;
use crate::raw::RawMesh;

/// Reads an included file by the name given in the mesh file; returns its content or an error message.
pub type Include<'a> = dyn Fn(&str) -> Result<Vec<u8>, String> + 'a;

/// A file format of meshes or surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY.
    Ply,
    /// Stereolithography.
    Stl,
    /// Object File Format.
    Off,
    /// Gmsh 2.2 and 4.1.
    Gmsh,
    /// VTK XML: `UnstructuredGrid` or `PolyData`.
    Vtk,
    /// Abaqus input file.
    Abaqus,
    /// Exodus II.
    Exodus,
}

impl Format {
    /// File extensions.
    pub const ENDINGS: [&str; 13] = [
        "obj", "ply", "stl", "off", "msh", "vtu", "vtp", "inp", "e", "exo", "ex2", "g", "gen",
    ];

    /// Returns the format by the file extension.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_string_lossy().to_lowercase();
        Some(match ending.as_str() {
            "obj" => Self::Obj,
            "ply" => Self::Ply,
            "stl" => Self::Stl,
            "off" => Self::Off,
            "msh" => Self::Gmsh,
            "vtu" | "vtp" => Self::Vtk,
            "inp" => Self::Abaqus,
            "e" | "exo" | "ex2" | "g" | "gen" => Self::Exodus,
            _ => return None,
        })
    }

    /// Returns whether the format repeats the corners of every triangle, so that equal ones must be merged.
    pub fn repeats_corners(self) -> bool {
        self == Self::Stl
    }

    /// Returns whether a file may have nodes that do not belong to its surfaces.
    pub fn is_mixed(self) -> bool {
        !matches!(self, Self::Obj | Self::Ply | Self::Stl | Self::Off)
    }

    /// Parses the content of a mesh file. `include` reads files included by an Abaqus file. Arrays of VTK and
    /// netCDF-4 files may be compressed and may take up to `memory` bytes; files of other formats take little
    /// more than the content.
    ///
    /// # Errors
    /// Returns an error for content that violates the format, with its location.
    pub fn parse(
        self,
        content: &[u8],
        memory: u64,
        include: &Include<'_>,
    ) -> Result<RawMesh, Fault> {
        // Windows editors write a byte order mark before text. The header of an STL file may contain any bytes.
        let content = match content.strip_prefix(b"\xef\xbb\xbf") {
            Some(text) if self != Self::Stl => text,
            _ => content,
        };
        let mesh = match self {
            Self::Obj => obj::parse(content),
            Self::Ply => ply::parse(content),
            Self::Stl => stl::parse(content),
            Self::Off => off::parse(content),
            Self::Gmsh => gmsh::parse(content),
            Self::Vtk => vtk::parse(content, memory),
            Self::Abaqus => abaqus::parse(content, include),
            Self::Exodus => exodus::parse(content, memory),
        }?;
        let what = match self {
            // An empty file has a cause of its own, which is reported later.
            Self::Gmsh => return Ok(mesh),
            Self::Stl | Self::Obj | Self::Ply | Self::Off => "triangles",
            Self::Vtk => "cells",
            Self::Abaqus | Self::Exodus => "elements",
        };
        match mesh.cells.is_empty() && mesh.left_out.is_empty() {
            true => Err(Fault::of_file(format!("the file contains no {what}"))),
            false => Ok(mesh),
        }
    }
}
