//! What `[body]` describes.

use std::path::PathBuf;

use pericles::material::StressState;
use pericles::space::{Finer, Grid, Shape};

use super::surface::{SurfaceShape, VertexAreas};
use crate::region::Frame;

/// The body.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Shape, spacing, section and holes.
    pub grid: Grid,
    /// The file of its points; of the grid only spacing and section are used then.
    pub listed: Option<PointsFile>,
    /// Parts with smaller cells and horizon, later ones before earlier ones.
    pub finer: Vec<Finer>,
    /// Stress state, which follows from the dimension and, in two dimensions, from `plane`.
    pub state: StressState,
    /// Whether opposite faces are one.
    pub periodic: bool,
    /// Where the points of a cell are.
    pub quadrature: Quadrature,
    /// Spacing along each axis, m, of a box whose cells are no squares or cubes; the grid's is then the largest.
    pub rectangular: Option<Vec<f64>>,
}

/// Where the points of a cell are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Quadrature {
    /// One in its middle.
    #[default]
    Midpoint,
    /// The two Gauss nodes of a bar's cell.
    Gauss,
}

/// What other tables need of a body, as far as it could be read.
pub(crate) struct BodyRead {
    pub(crate) body: Option<Body>,
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
#[derive(Debug, Clone, PartialEq)]
pub struct PointsFile {
    /// The file; a relative path starts at the folder of the deck.
    pub path: PathBuf,
    /// Dimension of the body.
    pub dimension: usize,
}

/// The placeholder for the grid of a body that is a surface.
pub(super) fn no_grid() -> Body {
    Body {
        grid: Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: vec![1.0; 3],
            },
            spacing: 1.0,
            section: 1.0,
            holes: Vec::new(),
        },
        listed: None,
        finer: Vec::new(),
        state: StressState::Spatial,
        periodic: false,
        quadrature: Quadrature::Midpoint,
        rectangular: None,
    }
}
