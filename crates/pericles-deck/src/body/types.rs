//! What `[body]` describes.

use std::path::{Path, PathBuf};

use pericles::material::StressState;
use pericles::space::{Finer, Grid, Region};
use serde::{Deserialize, Serialize};

use super::positions::Positions;
use super::sources::{FilledShape, MeshFile};
use super::surface::{SurfaceShape, VertexAreas};
use crate::region::Frame;

/// Where the points of a body are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SolidShape {
    /// In the cells of a grid.
    Lattice(Lattice),
    /// As a file lists them.
    Points(PointsFile),
    /// In the elements of a mesh.
    Mesh(MeshFile),
    /// In a closed surface or an outline.
    Filled(FilledShape),
}

/// A body on a grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lattice {
    /// Shape, spacing, section and holes.
    #[serde(with = "crate::form")]
    pub grid: Grid,
    /// Parts with smaller cells and horizon, later ones before earlier ones.
    #[serde(default, rename = "refine", with = "crate::form")]
    pub finer: Vec<Finer>,
    /// Whether opposite faces are one.
    #[serde(default)]
    pub periodic: bool,
    /// Where the points of a cell are.
    #[serde(default)]
    pub quadrature: Quadrature,
    /// Spacing along each axis, m, of a box whose cells are no squares or cubes; the grid's is then the largest.
    #[serde(default)]
    pub rectangular: Option<Vec<f64>>,
    /// How points are arranged.
    #[serde(default)]
    pub positions: Positions,
}

impl From<Grid> for Lattice {
    /// One point in the middle of each cell of a grid.
    fn from(grid: Grid) -> Self {
        Self {
            grid,
            finer: Vec::new(),
            periodic: false,
            quadrature: Quadrature::Midpoint,
            rectangular: None,
            positions: Positions::Lattice,
        }
    }
}

impl SolidShape {
    /// The grid of an analytic shape, if it is one.
    pub fn lattice(&self) -> Option<&Lattice> {
        match self {
            Self::Lattice(lattice) => Some(lattice),
            Self::Points(_) | Self::Mesh(_) | Self::Filled(_) => None,
        }
    }

    /// The grid of an analytic shape, if it is one, to change it.
    pub fn lattice_mut(&mut self) -> Option<&mut Lattice> {
        match self {
            Self::Lattice(lattice) => Some(lattice),
            Self::Points(_) | Self::Mesh(_) | Self::Filled(_) => None,
        }
    }

    /// Whether points are given one by one, by a file, a mesh or random numbers, instead of by the nodes of a lattice.
    pub fn is_listed(&self) -> bool {
        match self {
            Self::Lattice(lattice) => lattice.positions.are_random(),
            Self::Points(_) | Self::Mesh(_) => true,
            Self::Filled(filled) => !filled.is_on_lattice(),
        }
    }

    /// Dimension of the body.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Lattice(lattice) => lattice.grid.dimension(),
            Self::Points(file) => file.dimension,
            Self::Mesh(mesh) => mesh.dimension,
            Self::Filled(filled) => filled.boundary.dimension(),
        }
    }

    /// Spacing of the points, m: the largest one of a grid; none of a mesh whose elements give it.
    pub fn spacing(&self) -> Option<f64> {
        match self {
            Self::Lattice(lattice) => Some(lattice.grid.spacing),
            Self::Points(file) => Some(file.spacing),
            Self::Mesh(mesh) => mesh.spacing,
            Self::Filled(filled) => Some(filled.spacing),
        }
    }

    /// Area of a bar (m²), thickness of a body in two dimensions (m), 1 in three dimensions.
    pub fn section(&self) -> f64 {
        match self {
            Self::Lattice(lattice) => lattice.grid.section,
            Self::Points(file) => file.section,
            Self::Mesh(mesh) => mesh.section,
            Self::Filled(filled) => filled.section,
        }
    }

    /// The file that the points come from.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Lattice(_) => None,
            Self::Points(file) => Some(&file.path),
            Self::Mesh(mesh) => Some(&mesh.path),
            Self::Filled(filled) => filled.boundary.file(),
        }
    }

    /// Whether opposite faces are one.
    pub fn is_periodic(&self) -> bool {
        self.lattice().is_some_and(|lattice| lattice.periodic)
    }

    /// Whether parts have smaller cells.
    pub fn is_refined(&self) -> bool {
        !self.finer().is_empty()
    }

    /// The parts with smaller cells.
    pub fn finer(&self) -> &[Finer] {
        match self {
            Self::Lattice(lattice) => &lattice.finer,
            Self::Filled(filled) => &filled.finer,
            Self::Points(_) | Self::Mesh(_) => &[],
        }
    }

    /// Whether the points are Gauss nodes.
    pub fn has_gauss_nodes(&self) -> bool {
        let lattice = self.lattice();
        lattice.is_some_and(|lattice| lattice.quadrature == Quadrature::Gauss)
    }

    /// The regions without points.
    pub fn holes(&self) -> &[Region] {
        match self {
            Self::Lattice(lattice) => &lattice.grid.holes,
            Self::Filled(filled) => &filled.holes,
            Self::Points(_) | Self::Mesh(_) => &[],
        }
    }

    /// Spacing along each axis, m, of a box whose cells are no squares or cubes.
    pub fn rectangular(&self) -> Option<&[f64]> {
        self.lattice()?.rectangular.as_deref()
    }
}

/// Where the points of a cell are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quadrature {
    /// One in its middle.
    #[default]
    Midpoint,
    /// The two Gauss nodes of a bar's cell.
    Gauss,
}

/// What other tables need of a body, as far as it could be read.
pub(crate) struct BodyRead {
    pub(crate) shape: Option<SolidShape>,
    pub(crate) frame: Frame,
    pub(crate) state: Option<StressState>,
    /// The body if it is a surface.
    pub(crate) surface: Option<SurfaceRead>,
}

/// A surface, as far as it could be read.
pub(crate) struct SurfaceRead {
    pub(crate) shape: Option<SurfaceShape>,
    pub(crate) areas: Option<VertexAreas>,
}

/// The file that lists a body's points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointsFile {
    /// The file; a relative path starts at the folder of the deck.
    #[serde(rename = "file")]
    pub path: PathBuf,
    /// Dimension of the body.
    pub dimension: usize,
    /// Their spacing, m.
    pub spacing: f64,
    /// Area of a bar (m²), thickness of a body in two dimensions (m), 1 in three dimensions.
    pub section: f64,
}
