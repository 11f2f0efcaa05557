//! Bodies that come from files of meshes, surfaces and outlines.

use std::path::{Path, PathBuf};

use pericles::space::{Finer, Region};
use serde::{Deserialize, Serialize};

use super::positions::Positions;

/// A mesh in a file: each element of the highest dimension is a point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshFile {
    /// The file; a relative path starts at the folder of the deck.
    #[serde(rename = "file")]
    pub path: PathBuf,
    /// The file's unit of length, m.
    pub unit: f64,
    /// Dimension of the body, 2 or 3.
    pub dimension: usize,
    /// The groups whose elements are the body; all elements of the highest dimension if there are none.
    #[serde(default)]
    pub blocks: Vec<String>,
    /// The spacing of the points, m; the mean size of the elements if it is not given.
    #[serde(default)]
    pub spacing: Option<f64>,
    /// Thickness of a body in two dimensions (m), 1 in three dimensions.
    pub section: f64,
}

/// The inside of a closed surface or of an outline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FilledShape {
    /// What is filled.
    pub boundary: Boundary,
    /// Spacing of the lattice, m.
    pub spacing: f64,
    /// Thickness of a body in two dimensions (m), 1 in three dimensions.
    pub section: f64,
    /// Regions without material.
    #[serde(default, rename = "hole", with = "crate::form")]
    pub holes: Vec<Region>,
    /// Parts with smaller cells and horizon, later ones before earlier ones.
    #[serde(default, rename = "refine", with = "crate::form")]
    pub finer: Vec<Finer>,
    /// Which cells are points.
    #[serde(default)]
    pub cells: FilledCells,
    /// How points are arranged.
    #[serde(default)]
    pub positions: Positions,
}

/// What is filled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Boundary {
    /// A surface of triangles in a file.
    Surface {
        /// The file; a relative path starts at the folder of the deck.
        #[serde(rename = "file")]
        path: PathBuf,
        /// The file's unit of length, m.
        unit: f64,
        /// Whether the surface may have gaps: the inside is then where its winding number is above ½.
        open: bool,
    },
    /// Polygons in the plane, m: places that an odd number of them surround are inside.
    Polygons(Vec<Vec<[f64; 2]>>),
    /// The same from a file with a line `x y` for each corner and blank lines between polygons.
    PolygonFile {
        /// The file; a relative path starts at the folder of the deck.
        #[serde(rename = "file")]
        path: PathBuf,
        /// The file's unit of length, m.
        unit: f64,
    },
}

impl Boundary {
    /// Dimension of the body: 3 in a surface, 2 in polygons.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Surface { .. } => 3,
            Self::Polygons(_) | Self::PolygonFile { .. } => 2,
        }
    }

    /// The file that it is read from.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Surface { path, .. } | Self::PolygonFile { path, .. } => Some(path),
            Self::Polygons(_) => None,
        }
    }
}

/// Which cells of a filled lattice are points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FilledCells {
    /// Those whose centres are inside, whole.
    #[default]
    Whole,
    /// All that are partly inside, with the volume of that part; cells below a tenth give it to their neighbours.
    Partial,
}

impl FilledShape {
    /// Whether its points lie on a lattice and have equal volumes.
    pub fn is_on_lattice(&self) -> bool {
        self.cells == FilledCells::Whole && !self.positions.are_random()
    }
}
