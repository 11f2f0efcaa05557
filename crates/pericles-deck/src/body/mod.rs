//! `[body]`: shape, grid and stress state.

mod cells;
mod check;
mod piece;
mod plane;
mod positions;
mod rotation;
mod shape;
mod sources;
mod surface;
mod types;
mod unit;

pub use positions::{Positions, Quadrature};
pub use rotation::Rotation;
pub use sources::{Boundary, FilledCells, FilledShape, MeshFile, PointsFile};
pub use surface::{SurfaceFile, SurfaceFormula, SurfaceShape, VertexAreas};
pub use types::{Lattice, Piece, SolidShape, piece_path};
pub use unit::length_unit;

pub(crate) use rotation::{RotationScope, check_axis};
pub(crate) use types::{BodyRead, SurfaceRead};
pub(crate) use unit::{check_unit, unit_of};

use pericles::material::StressState;

use self::plane::state;
use self::shape::{GivenShape, Source};
use crate::declaration::DeckKeys;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::Frame;

/// Reads `[body]`.
pub(crate) fn read(table: Option<Table<'_>>) -> BodyRead {
    let Some(table) = table else {
        return BodyRead::default();
    };
    table.about("Geometry and discretisation of the body.");
    piece::read(table, one_piece)
}

/// Reads the shape of a piece, with the position of the origin of a file's coordinates. Other tables know its dimension and
/// spacing even if another key is invalid.
fn one_piece(table: &Table<'_>, is_further: bool) -> (BodyRead, [f64; 3]) {
    let given = GivenShape::read_keys(table, is_further);
    let word = table.optional("shape");
    let word = word.as_ref().and_then(Item::word).unwrap_or_default();
    if GivenShape::is_surface(word) {
        return (surface(table, given.map(GivenShape::source)), [0.0; 3]);
    }
    if !GivenShape::is_known(word) {
        table.know(&["areas"]);
        let spacing = table.optional("spacing").filter(|item| !item.is_list());
        spacing.and_then(|item| item.positive(Quantity::Length));
    }
    let of_file = table.number("dimension");
    let of_file = (1..=3).find(|&dimension| of_file == Some(dimension as f64));
    let mut frame = Frame {
        dimension: GivenShape::dimension(word).or(of_file),
        spacing: table.number("spacing").filter(|spacing| *spacing > 0.0),
        cells: word != "mesh",
        mesh: word == "mesh",
        listed: word == "points",
    };
    let state = state(table, frame.dimension);
    let (shape, origin) = match given.map(GivenShape::source) {
        Some(Source::Solid(shape, origin)) => (Some(shape), origin),
        _ => (None, [0.0; 3]),
    };
    if let Some(shape) = &shape {
        frame.cells &= shape.has_equal_cells();
        frame.spacing = shape.spacing();
        frame.cells &= !frame.is_automatic();
    }
    let read = BodyRead {
        shape,
        frame,
        state,
        ..BodyRead::default()
    };
    (read, origin)
}

fn surface(table: &Table<'_>, given: Option<Source>) -> BodyRead {
    let areas = surface::areas(table);
    let shape = given.and_then(|given| match given {
        Source::Surface(shape) => surface::with_spacing(table, shape),
        Source::Solid(..) => None,
    });
    let (shape, spacing) = shape.unzip();
    BodyRead {
        frame: Frame {
            dimension: Some(3),
            spacing: spacing.flatten(),
            cells: false,
            mesh: false,
            listed: false,
        },
        state: Some(StressState::Spatial),
        surface: Some(SurfaceRead { shape, areas }),
        ..BodyRead::default()
    }
}
