//! Bodies from files of meshes, surfaces and outlines.

use std::path::{Path, PathBuf};

use pericles::space::{Finer, Region};
use serde::{Deserialize, Serialize};

use super::positions::Positions;

/// A mesh file: each element of the highest dimension is a point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshFile {
    /// Path of the file; a relative path starts at the deck's folder.
    #[serde(rename = "file")]
    pub path: PathBuf,
    /// Unit of length of the file, m.
    pub unit: f64,
    /// Dimension of the body, 2 or 3.
    pub dimension: usize,
    /// Groups whose elements form the body; if empty, all elements of the highest dimension.
    #[serde(default)]
    pub blocks: Vec<String>,
    /// Spacing of the points, m; if none, the mean element size.
    #[serde(default)]
    pub spacing: Option<f64>,
    /// Thickness of a 2D body (m); 1 in 3D.
    pub section: f64,
}

/// The interior of a closed surface or an outline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FilledShape {
    /// The boundary of the interior.
    pub boundary: Boundary,
    /// Spacing of the lattice, m.
    pub spacing: f64,
    /// Thickness of a 2D body (m); 1 in 3D.
    pub section: f64,
    /// Regions without material.
    #[serde(default, rename = "hole", with = "crate::form")]
    pub holes: Vec<Region>,
    /// Refined parts with smaller cells and horizon; where they overlap, the last one counts.
    #[serde(default, rename = "refine", with = "crate::form")]
    pub finer: Vec<Finer>,
    /// Selection of cells.
    #[serde(default)]
    pub cells: FilledCells,
    /// Positions of the points.
    #[serde(default)]
    pub positions: Positions,
}

/// The boundary of the interior.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Boundary {
    /// A triangulated surface in a file.
    Surface {
        /// Path of the file; a relative path starts at the deck's folder.
        #[serde(rename = "file")]
        path: PathBuf,
        /// Unit of length of the file, m.
        unit: f64,
        /// Whether the surface may have gaps; points with a winding number above ½ are then inside.
        open: bool,
    },
    /// Polygons in the plane, m: points enclosed by an odd number of polygons are inside.
    Polygons(Vec<Vec<[f64; 2]>>),
    /// Polygons from a file with one line `x y` per corner and blank lines between polygons.
    PolygonFile {
        /// Path of the file; a relative path starts at the deck's folder.
        #[serde(rename = "file")]
        path: PathBuf,
        /// Unit of length of the file, m.
        unit: f64,
    },
}

impl Boundary {
    /// Returns the dimension of the body: 3 for a surface, 2 for polygons.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Surface { .. } => 3,
            Self::Polygons(_) | Self::PolygonFile { .. } => 2,
        }
    }

    /// Returns the path of the file, if there is one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Surface { path, .. } | Self::PolygonFile { path, .. } => Some(path),
            Self::Polygons(_) => None,
        }
    }
}

/// Selection of cells in a filled shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FilledCells {
    /// Cells whose centres are inside, with their full volume.
    #[default]
    Whole,
    /// All cells that are partly inside, with the volume of that part; cells below a tenth are merged with
    /// their neighbours.
    Partial,
}

impl FilledShape {
    /// Returns whether its points lie on a lattice and have equal volumes.
    pub fn is_on_lattice(&self) -> bool {
        self.cells == FilledCells::Whole && !self.positions.are_random()
    }
}
