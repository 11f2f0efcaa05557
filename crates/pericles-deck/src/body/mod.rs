//! `[body]`: shape, grid and stress state.

mod kind;
mod outline;
mod piece;
mod plane;
mod positions;
mod rotation;
mod sources;
mod surface;
mod types;
mod unit;

pub use positions::Positions;
pub use rotation::Rotation;
pub use sources::{Boundary, FilledCells, FilledShape, MeshFile, PointsFile};
pub use surface::{SurfaceFile, SurfaceFormula, SurfaceShape, VertexAreas};
pub use types::{Lattice, Piece, Quadrature, SolidShape, piece_path};
pub use unit::length_unit;

pub(crate) use rotation::{RotationScope, check_axis};
pub(crate) use types::{BodyRead, SurfaceRead};
pub(crate) use unit::{check_unit, unit_of};

use pericles::material::StressState;
use pericles::space::{Finer, Grid, Region};

use self::kind::{KINDS, Kind};
use self::outline::{Outline, shape};
use self::plane::{section, state};
use crate::declaration::{DeckKeys, declared};
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::Frame;

/// Reads `[body]`.
pub(crate) fn read(table: Option<Table<'_>>) -> BodyRead {
    let Some(table) = table else {
        return BodyRead::default();
    };
    let pieces = piece::read(&table, one_piece);
    pieces.join(one_piece(table))
}

/// Reads the shape of a piece; its further keys have been read.
fn one_piece(table: Table<'_>) -> BodyRead {
    let mut read = BodyRead::default();
    let kind = table
        .required("shape")
        .and_then(|item| item.choice("shape", &KINDS));
    match kind {
        Some(Kind::Surface) => return surface(table, false, read),
        Some(Kind::SurfaceFile) => return surface(table, true, read),
        Some(Kind::Points) => {
            let shape = PointsFile::read_keys(&table, ()).map(SolidShape::Points);
            return from_file(table, shape, read.frame);
        }
        Some(Kind::Mesh) => {
            let shape = MeshFile::read_keys(&table, ()).map(SolidShape::Mesh);
            let frame = Frame {
                mesh: true,
                cells: false,
                ..read.frame
            };
            return from_file(table, shape, frame);
        }
        Some(kind @ (Kind::Solid | Kind::Outline)) => {
            let shape = FilledShape::read_keys(&table, kind.dimension());
            let cells = shape.as_ref().is_none_or(FilledShape::is_on_lattice);
            let frame = Frame {
                cells,
                dimension: Some(kind.dimension()),
                ..read.frame
            };
            return from_file(table, shape.map(SolidShape::Filled), frame);
        }
        _ => {}
    }
    let spacings = table
        .required("spacing")
        .and_then(|item| spacings(&item, kind));
    read.frame.spacing = spacings
        .as_ref()
        .map(|all| all.iter().copied().fold(0.0, f64::max));
    let rectangular = spacings.filter(|all| all.iter().any(|dx| *dx != all[0]));
    read.frame.cells = rectangular.is_none();
    let Some(kind) = kind else {
        // Without the shape, the allowed keys are unknown.
        return read;
    };
    read.frame.dimension = Some(kind.dimension());
    let outline = shape(&table, kind);
    let section = section(&table, read.frame.dimension);
    read.state = state(&table, read.frame.dimension);
    let holes = declared(&table, "hole", read.frame);
    let finer = declared::<_, Finer>(&table, "refine", read.frame);
    let has_none = |holes: &Vec<Region>| holes.is_empty();
    let refined = finer.as_ref().is_none_or(|parts| !parts.is_empty());
    let plain = rectangular.is_none();
    if !plain && refined {
        table.forbid(
            "refine",
            "refinement requires equal spacings along all axes",
        );
    }
    let positions = positions(&table, plain, refined);
    let random = positions.is_some_and(|positions| positions.are_random());
    read.frame.cells &= !random;
    let whole = !random && holes.as_ref().is_some_and(has_none) && !refined;
    let rules = rules(&table, kind, whole);
    table.finish();
    let lattice = assemble(&read, outline, section, holes, finer, rules);
    read.shape = lattice.zip(positions).map(|(lattice, positions)| {
        SolidShape::Lattice(Lattice {
            rectangular,
            positions,
            ..lattice
        })
    });
    read
}

/// Completes a body from a file. Other tables know its dimension and spacing even if another key is invalid.
fn from_file(table: Table<'_>, shape: Option<SolidShape>, frame: Frame) -> BodyRead {
    let given = table.number("dimension");
    let given = (1..=3).find(|&dimension| given == Some(dimension as f64));
    let frame = Frame {
        dimension: frame.dimension.or(given),
        spacing: table.number("spacing").filter(|spacing| *spacing > 0.0),
        ..frame
    };
    let state = state(&table, frame.dimension);
    table.finish();
    BodyRead {
        shape,
        frame,
        state,
        ..BodyRead::default()
    }
}

/// Reads the positions of points; random positions need equal spacings along all axes and no refinement.
fn positions(table: &Table<'_>, plain: bool, refined: bool) -> Option<Positions> {
    let positions = Positions::read_keys(table, ())?;
    if positions.are_random() && !plain {
        table.forbid(
            "positions",
            "random positions require equal spacings along all axes",
        );
    }
    if positions.are_random() && refined {
        table.forbid("refine", "refinement requires positions = \"lattice\"");
    }
    Some(positions)
}

fn surface(table: Table<'_>, is_file: bool, mut read: BodyRead) -> BodyRead {
    let shape = surface::shape(&table, is_file);
    let areas = surface::areas(&table);
    table.finish();
    let (shape, spacing) = shape.unzip();
    read.frame = Frame {
        dimension: Some(3),
        spacing: spacing.flatten(),
        cells: false,
        mesh: false,
    };
    read.state = Some(StressState::Spatial);
    read.surface = Some(SurfaceRead { shape, areas });
    read
}

/// Reads one spacing, or one per axis of a box.
fn spacings(item: &Item<'_>, kind: Option<Kind>) -> Option<Vec<f64>> {
    if !item.is_list() {
        return item.positive(Quantity::Length).map(|dx| vec![dx]);
    }
    let kind = kind?;
    if !matches!(kind, Kind::Plate | Kind::Block) {
        item.out_of_range("one length; only plates and blocks have one spacing per axis");
        return None;
    }
    let entries = item.exactly(kind.dimension(), "a length, or one length per axis")?;
    let lengths: Vec<Option<f64>> = entries
        .iter()
        .map(|entry| entry.positive(Quantity::Length))
        .collect();
    lengths.into_iter().collect()
}

fn assemble(
    read: &BodyRead,
    outline: Option<Outline>,
    section: Option<f64>,
    holes: Option<Vec<Region>>,
    finer: Option<Vec<Finer>>,
    rules: Option<(bool, Quadrature)>,
) -> Option<Lattice> {
    let (periodic, quadrature) = rules?;
    let outline = outline?;
    let mut holes = holes?;
    holes.extend(outline.bore);
    Some(Lattice {
        grid: Grid {
            shape: outline.shape,
            spacing: read.frame.spacing?,
            section: section?,
            holes,
        },
        finer: finer?,
        periodic,
        quadrature,
        rectangular: None,
        positions: Positions::Lattice,
    })
}

/// Reads periodicity and the quadrature of cells.
fn rules(table: &Table<'_>, kind: Kind, whole: bool) -> Option<(bool, Quadrature)> {
    const BOX: &str =
        "periodicity requires a bar, plate or block with one cell size and without holes";
    const BAR: &str = "Gauss nodes require a bar that is not periodic and has no holes";
    let periodic = if matches!(kind, Kind::Bar | Kind::Plate | Kind::Block) && whole {
        table.or("periodic", false, |item| item.boolean())
    } else {
        table.forbid("periodic", BOX);
        Some(false)
    };
    let quadrature = if kind == Kind::Bar && whole && periodic != Some(true) {
        let rules = [
            ("midpoint", Quadrature::Midpoint),
            ("gauss", Quadrature::Gauss),
        ];
        table.choice_or_first("quadrature", "quadrature", &rules)
    } else {
        table.forbid("quadrature", BAR);
        Some(Quadrature::Midpoint)
    };
    Some((periodic?, quadrature?))
}
