//! Data types of `[body]`.

use std::path::Path;

use pericles::material::StressState;
use pericles::space::{Finer, Grid, Region};
use serde::{Deserialize, Serialize};

use super::positions::{Positions, Quadrature};
use super::rotation::Rotation;
use super::sources::{FilledShape, MeshFile, PointsFile};
use super::surface::{SurfaceShape, VertexAreas};
use crate::key_path::KeyPath;
use crate::region::Frame;

/// Source of the points of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SolidShape {
    /// Cells of a grid.
    Lattice(Lattice),
    /// Points listed in a file.
    Points(PointsFile),
    /// Elements of a mesh.
    Mesh(MeshFile),
    /// Cells in a closed surface or an outline.
    Filled(FilledShape),
    /// Several pieces that no bond joins, at least one; the first one is described by `[body]`.
    Pieces(Vec<Piece>),
}

/// A body on a grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lattice {
    /// Shape, spacing, section and holes.
    #[serde(with = "crate::form")]
    pub grid: Grid,
    /// Refined parts with smaller cells and horizon; where they overlap, the last one counts.
    #[serde(default, rename = "refine", with = "crate::form")]
    pub finer: Vec<Finer>,
    /// Whether the boundary conditions are periodic.
    #[serde(default)]
    pub periodic: bool,
    /// Quadrature points of cells.
    #[serde(default)]
    pub quadrature: Quadrature,
    /// Spacing along each axis, m, of a box with anisotropic spacing; the grid then has the largest one.
    #[serde(default)]
    pub rectangular: Option<Vec<f64>>,
    /// Positions of the points.
    #[serde(default)]
    pub positions: Positions,
}

impl From<Grid> for Lattice {
    /// A lattice with one point at the centre of each cell.
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
    /// Returns the lattice of an analytic shape of one piece.
    pub fn lattice(&self) -> Option<&Lattice> {
        match self {
            Self::Lattice(lattice) => Some(lattice),
            Self::Points(_) | Self::Mesh(_) | Self::Filled(_) | Self::Pieces(_) => None,
        }
    }

    /// Returns the lattice of an analytic shape of one piece, mutably.
    pub fn lattice_mut(&mut self) -> Option<&mut Lattice> {
        match self {
            Self::Lattice(lattice) => Some(lattice),
            Self::Points(_) | Self::Mesh(_) | Self::Filled(_) | Self::Pieces(_) => None,
        }
    }

    /// Returns the pieces; none for a body of one piece.
    pub fn pieces(&self) -> &[Piece] {
        match self {
            Self::Pieces(pieces) => pieces,
            _ => &[],
        }
    }

    /// Returns the shape of the first piece.
    fn first(&self) -> Option<&Self> {
        self.pieces().first().map(|piece| &piece.shape)
    }

    /// Returns whether the points come from a file, a mesh or random numbers instead of the nodes of a lattice, or from
    /// rotated pieces or pieces of several spacings.
    pub fn is_listed(&self) -> bool {
        match self {
            Self::Lattice(lattice) => lattice.positions.are_random(),
            Self::Points(_) | Self::Mesh(_) => true,
            Self::Filled(filled) => !filled.is_on_lattice(),
            Self::Pieces(pieces) => {
                let differ = |two: &[Piece]| {
                    let [one, other] = [&two[0].shape, &two[1].shape];
                    one.spacing() != other.spacing() || one.rectangular() != other.rectangular()
                };
                pieces.iter().any(Piece::is_listed) || pieces.windows(2).any(differ)
            }
        }
    }

    /// Returns whether all cells of a lattice are squares or cubes of one size.
    pub(crate) fn has_equal_cells(&self) -> bool {
        match self {
            Self::Lattice(lattice) => {
                lattice.rectangular.is_none() && !lattice.positions.are_random()
            }
            Self::Filled(filled) => filled.is_on_lattice(),
            Self::Points(_) => true,
            Self::Mesh(_) | Self::Pieces(_) => false,
        }
    }

    /// Dimension of the body.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Lattice(lattice) => lattice.grid.dimension(),
            Self::Points(file) => file.dimension,
            Self::Mesh(mesh) => mesh.dimension,
            Self::Filled(filled) => filled.dimension,
            // A list without pieces is rejected.
            Self::Pieces(_) => self.first().map_or(3, Self::dimension),
        }
    }

    /// Returns the spacing, m: the largest one of a grid, of several pieces the spacing of the first; none for a mesh and listed points
    /// with automatic spacing.
    pub fn spacing(&self) -> Option<f64> {
        match self {
            Self::Lattice(lattice) => Some(lattice.grid.spacing),
            Self::Points(file) => file.spacing,
            Self::Mesh(mesh) => mesh.spacing,
            Self::Filled(filled) => Some(filled.spacing),
            Self::Pieces(_) => self.first()?.spacing(),
        }
    }

    /// Area of a bar (m²), thickness of a 2D body (m); 1 in 3D.
    pub fn section(&self) -> f64 {
        match self {
            Self::Lattice(lattice) => lattice.grid.section,
            Self::Points(file) => file.section,
            Self::Mesh(mesh) => mesh.section,
            Self::Filled(filled) => filled.section,
            Self::Pieces(_) => self.first().map_or(1.0, Self::section),
        }
    }

    /// Returns the paths of the files of the points.
    pub fn files(&self) -> Vec<&Path> {
        match self {
            Self::Lattice(_) => Vec::new(),
            Self::Points(file) => vec![&file.path],
            Self::Mesh(mesh) => vec![&mesh.path],
            Self::Filled(filled) => filled.boundary.file().into_iter().collect(),
            Self::Pieces(pieces) => pieces
                .iter()
                .flat_map(|piece| piece.shape.files())
                .collect(),
        }
    }

    /// Whether the boundary conditions are periodic.
    pub fn is_periodic(&self) -> bool {
        self.lattice().is_some_and(|lattice| lattice.periodic)
    }

    /// Returns whether the body has refined parts.
    pub fn is_refined(&self) -> bool {
        !self.finer().is_empty()
    }

    /// Returns the refined parts; pieces have none.
    pub fn finer(&self) -> &[Finer] {
        match self {
            Self::Lattice(lattice) => &lattice.finer,
            Self::Filled(filled) => &filled.finer,
            Self::Points(_) | Self::Mesh(_) | Self::Pieces(_) => &[],
        }
    }

    /// Returns whether the points are Gauss nodes.
    pub fn has_gauss_nodes(&self) -> bool {
        let lattice = self.lattice();
        lattice.is_some_and(|lattice| lattice.quadrature == Quadrature::Gauss)
    }

    /// Returns the holes of a body of one piece.
    pub fn holes(&self) -> &[Region] {
        match self {
            Self::Lattice(lattice) => &lattice.grid.holes,
            Self::Filled(filled) => &filled.holes,
            Self::Points(_) | Self::Mesh(_) | Self::Pieces(_) => &[],
        }
    }

    /// Returns the spacing along each axis, m, of a box with anisotropic spacing, of several pieces the spacing of the first.
    pub fn rectangular(&self) -> Option<&[f64]> {
        match self {
            Self::Pieces(_) => self.first()?.rectangular(),
            _ => self.lattice()?.rectangular.as_deref(),
        }
    }
}

/// A piece of a body: its points have no bonds with points of other pieces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Piece {
    /// Name, also the name of the set of its points.
    pub name: String,
    /// Source of its points.
    pub shape: SolidShape,
    /// Position of the origin of a file's coordinates, m; zero for shapes that have a position of their own.
    #[serde(default)]
    pub origin: [f64; 3],
    /// Rotation, applied to the points at their positions.
    #[serde(default)]
    pub rotation: Option<Rotation>,
    /// Name of its material; the material of the body if none. Assignments to sets of its points replace it.
    #[serde(default)]
    pub material: Option<String>,
    /// Initial velocity, m/s, to which the velocities of `[[initial]]` are added.
    #[serde(default)]
    pub velocity: Option<[f64; 3]>,
}

/// Returns the path of a piece of a body: the first one is `[body]`, the others are `[[body.piece]]`.
pub fn piece_path(k: usize) -> KeyPath {
    let body = KeyPath::from("body");
    match k {
        0 => body,
        k => body.key("piece").index(k - 1),
    }
}

impl Piece {
    /// Returns a piece of a shape at its own position and at rest.
    pub fn new(name: impl Into<String>, shape: SolidShape) -> Self {
        Self {
            name: name.into(),
            shape,
            origin: [0.0; 3],
            rotation: None,
            material: None,
            velocity: None,
        }
    }

    /// Returns whether the points of the piece do not lie on a lattice parallel to the axes.
    pub fn is_listed(&self) -> bool {
        self.rotation.is_some() || self.shape.is_listed()
    }
}

/// Properties of a body that other tables need; none if they could not be read.
pub(crate) struct BodyRead {
    pub(crate) shape: Option<SolidShape>,
    /// Names of the pieces; empty for a body of one piece.
    pub(crate) pieces: Vec<String>,
    pub(crate) frame: Frame,
    pub(crate) state: Option<StressState>,
    /// The body, if it is a 2-manifold.
    pub(crate) surface: Option<SurfaceRead>,
}

impl Default for BodyRead {
    /// Placeholder for a body that could not be read.
    fn default() -> Self {
        Self {
            shape: None,
            pieces: Vec::new(),
            frame: Frame {
                dimension: None,
                spacing: None,
                cells: true,
                mesh: false,
                listed: false,
            },
            state: None,
            surface: None,
        }
    }
}

/// A 2-manifold, as far as it could be read.
pub(crate) struct SurfaceRead {
    pub(crate) shape: Option<SurfaceShape>,
    pub(crate) areas: Option<VertexAreas>,
}
