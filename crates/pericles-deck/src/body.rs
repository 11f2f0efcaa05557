//! `[body]`: the shape, its grid and its state of stress.

use pericles::material::StressState;
use pericles::space::{Finer, Grid, Region, Shape};

use crate::points::{self, PointsFile};
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::{self, Frame};
use crate::surface::{self, SurfaceKind, SurfaceShape, VertexAreas};

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

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Bar,
    Plate,
    Disc,
    Block,
    Cylinder,
    Ball,
    Points,
    Surface(SurfaceKind),
}

const KINDS: [(&str, Kind); 13] = [
    ("bar", Kind::Bar),
    ("plate", Kind::Plate),
    ("disc", Kind::Disc),
    ("block", Kind::Block),
    ("cylinder", Kind::Cylinder),
    ("ball", Kind::Ball),
    ("icosphere", Kind::Surface(SurfaceKind::Icosphere)),
    ("uv-sphere", Kind::Surface(SurfaceKind::UvSphere)),
    ("ellipsoid", Kind::Surface(SurfaceKind::Ellipsoid)),
    ("torus", Kind::Surface(SurfaceKind::Torus)),
    ("capsule", Kind::Surface(SurfaceKind::Capsule)),
    ("surface", Kind::Surface(SurfaceKind::File)),
    ("points", Kind::Points),
];

impl Kind {
    fn dimension(self) -> usize {
        match self {
            Self::Bar => 1,
            Self::Plate | Self::Disc => 2,
            Self::Block | Self::Cylinder | Self::Ball => 3,
            // Points say it themselves.
            Self::Points | Self::Surface(_) => 3,
        }
    }
}

pub(crate) fn read(table: Option<Table<'_>>) -> BodyRead {
    let mut read = BodyRead {
        body: None,
        frame: Frame {
            dimension: None,
            spacing: None,
            cells: true,
        },
        state: None,
        surface: None,
    };
    let Some(table) = table else { return read };
    let kind = table
        .required("shape")
        .and_then(|item| item.choice("shape", &KINDS));
    if let Some(Kind::Surface(kind)) = kind {
        return surface(table, kind, read);
    }
    if kind == Some(Kind::Points) {
        return points::read(table, read);
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
        // Without the shape nobody knows which other keys belong here.
        return read;
    };
    read.frame.dimension = Some(kind.dimension());
    let outline = shape(&table, kind);
    let section = section(&table, kind.dimension());
    read.state = state(&table, kind.dimension());
    let holes: Vec<Option<Region>> = table
        .tables("hole")
        .into_iter()
        .map(|hole| region::read(hole, read.frame))
        .collect();
    let finer: Vec<Option<Finer>> = table
        .tables("refine")
        .into_iter()
        .map(|part| finer(part, read.frame))
        .collect();
    let plain = rectangular.is_none();
    if !plain && !finer.is_empty() {
        table.forbid("refine", "only cells of one size can be divided");
    }
    let rules = rules(&table, kind, plain && holes.is_empty() && finer.is_empty());
    table.finish();
    let body = assemble(&read, outline, section, holes, finer, rules);
    read.body = body.map(|body| Body {
        rectangular,
        ..body
    });
    read
}

fn surface(table: Table<'_>, kind: SurfaceKind, mut read: BodyRead) -> BodyRead {
    let shape = surface::shape(&table, kind);
    let areas = surface::areas(&table);
    table.finish();
    let (shape, spacing) = shape.unzip();
    read.frame = Frame {
        dimension: Some(3),
        spacing: spacing.flatten(),
        cells: false,
    };
    read.state = Some(StressState::Spatial);
    read.body = Some(surface::no_grid());
    read.surface = Some(SurfaceRead { shape, areas });
    read
}

/// One spacing, or one for each axis of a box.
fn spacings(item: &Item<'_>, kind: Option<Kind>) -> Option<Vec<f64>> {
    if !item.is_list() {
        return item.positive(Quantity::Length).map(|dx| vec![dx]);
    }
    let kind = kind?;
    if !matches!(kind, Kind::Plate | Kind::Block) {
        item.out_of_range("one length: only plates and blocks have a spacing for each axis");
        return None;
    }
    let entries = item.exactly(kind.dimension(), "a length, or one for each axis")?;
    let lengths: Vec<Option<f64>> = entries
        .iter()
        .map(|entry| entry.positive(Quantity::Length))
        .collect();
    lengths.into_iter().collect()
}

fn finer(table: Table<'_>, frame: Frame) -> Option<Finer> {
    /// More would make steps that differ as much.
    const MOST: u64 = 16;
    let ratio = table.required("ratio").and_then(|item| {
        let ratio = item.count()?;
        if (2..=MOST).contains(&ratio) {
            return Some(ratio as u32);
        }
        item.out_of_range(
            "a whole number from 2 to 16: cells are divided into so many along each axis",
        );
        None
    });
    let region = region::read_among_others(table, frame);
    Some(Finer {
        region: region?,
        ratio: ratio?,
    })
}

fn assemble(
    read: &BodyRead,
    outline: Option<Outline>,
    section: Option<f64>,
    holes: Vec<Option<Region>>,
    finer: Vec<Option<Finer>>,
    rules: Option<(bool, Quadrature)>,
) -> Option<Body> {
    let (periodic, quadrature) = rules?;
    let outline = outline?;
    let mut holes = holes.into_iter().collect::<Option<Vec<Region>>>()?;
    holes.extend(outline.bore);
    Some(Body {
        grid: Grid {
            shape: outline.shape,
            spacing: read.frame.spacing?,
            section: section?,
            holes,
        },
        listed: None,
        finer: finer.into_iter().collect::<Option<_>>()?,
        state: read.state?,
        periodic,
        quadrature,
        rectangular: None,
    })
}

/// Periodicity and the place of points in their cells.
fn rules(table: &Table<'_>, kind: Kind, whole: bool) -> Option<(bool, Quadrature)> {
    const BOX: &str = "only a bar, plate or block of equal cells without holes has opposite faces that can be one";
    const BAR: &str = "only the cells of a bar without holes, and with two ends, have Gauss nodes";
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

/// A shape and, for tubes and rings, the region left out in its middle.
struct Outline {
    shape: Shape,
    bore: Option<Region>,
}

fn shape(table: &Table<'_>, kind: Kind) -> Option<Outline> {
    let solid = |shape| Outline { shape, bore: None };
    let dimension = kind.dimension();
    let radius = || {
        table
            .required("radius")
            .and_then(|item| item.positive(Quantity::Length))
    };
    match kind {
        Kind::Bar | Kind::Plate | Kind::Block => {
            let size = size(table, kind);
            let origin = place(table, "origin", dimension);
            Some(solid(Shape::Box {
                origin: origin?,
                size: size?,
            }))
        }
        Kind::Ball => {
            let (centre, radius) = (place(table, "centre", dimension), radius());
            Some(solid(Shape::Ball {
                centre: centre?,
                radius: radius?,
            }))
        }
        Kind::Disc => {
            let (centre, radius) = (place(table, "centre", dimension), radius());
            let inner = inner_radius(table, radius);
            let (centre, radius) = (centre?, radius?);
            Some(Outline {
                shape: Shape::Disc { centre, radius },
                bore: inner?.map(|radius| Region::Ball { centre, radius }),
            })
        }
        // Read by `surface`.
        Kind::Points | Kind::Surface(_) => None,
        Kind::Cylinder => {
            let base = place(table, "base", dimension);
            let axis = region::axis(table);
            let radius = radius();
            let inner = inner_radius(table, radius);
            let height = table
                .required("height")
                .and_then(|item| item.positive(Quantity::Length));
            let (base, axis, radius) = (base?, axis?, radius?);
            Some(Outline {
                shape: Shape::Cylinder {
                    base,
                    axis,
                    radius,
                    height: height?,
                },
                bore: inner?.map(|radius| Region::Cylinder {
                    centre: base,
                    axis,
                    radius,
                }),
            })
        }
    }
}

/// The sides: `size`, or `length` for a bar.
fn size(table: &Table<'_>, kind: Kind) -> Option<Vec<f64>> {
    let dimension = kind.dimension();
    let item = if kind == Kind::Bar {
        table.exactly_one(&["length", "size"])?.1
    } else {
        table.required("size")?
    };
    let other = match (dimension, item.list_length()) {
        (1 | 3, Some(2)) => Some("\"plate\""),
        (1 | 2, Some(3)) => Some("\"block\""),
        (2 | 3, Some(1)) => Some("\"bar\""),
        _ => None,
    };
    if let Some(other) = other {
        item.wrong_length(&format!(
            "{dimension} entries, one for each dimension of the body; a body with so many sides is shape = {other}"
        ));
        return None;
    }
    let items = item.components(Some(dimension), &Quantity::Length.expected())?;
    let sides: Vec<Option<f64>> = items
        .iter()
        .map(|side| side.positive(Quantity::Length))
        .collect();
    sides.into_iter().collect()
}

/// A point, by default the origin.
fn place(table: &Table<'_>, key: &'static str, dimension: usize) -> Option<[f64; 3]> {
    match table.optional(key) {
        Some(item) => item.vector(Quantity::Length, Some(dimension)),
        None => {
            let zero = vec![0.0; dimension];
            table.record(key, zero);
            Some([0.0; 3])
        }
    }
}

fn inner_radius(table: &Table<'_>, outer: Option<f64>) -> Option<Option<f64>> {
    table.maybe("inner_radius", |item| {
        item.within(
            Quantity::Length,
            "a positive number smaller than `radius`",
            |inner| inner > 0.0 && outer.is_none_or(|outer| inner < outer),
        )
    })
}

/// Area of a bar, thickness of a plate, 1 in three dimensions.
pub(crate) fn section(table: &Table<'_>, dimension: usize) -> Option<f64> {
    if dimension != 1 {
        table.forbid("area", "only a bar has an area");
    }
    if dimension != 2 {
        table.forbid(
            "thickness",
            "only bodies of two dimensions (plate, disc) have a thickness",
        );
    }
    match dimension {
        1 => table.or("area", 1.0, |item| item.positive(Quantity::Area)),
        2 => table.or("thickness", 1.0, |item| item.positive(Quantity::Length)),
        _ => Some(1.0),
    }
}

pub(crate) fn state(table: &Table<'_>, dimension: usize) -> Option<StressState> {
    const PLANES: [(&str, StressState); 2] = [
        ("stress", StressState::PlaneStress),
        ("strain", StressState::PlaneStrain),
    ];
    if dimension == 2 {
        return table
            .required("plane")
            .and_then(|item| item.choice("state of the plane", &PLANES));
    }
    table.forbid(
        "plane",
        "only bodies of two dimensions (plate, disc) are in plane stress or plane strain",
    );
    Some(if dimension == 1 {
        StressState::Uniaxial
    } else {
        StressState::Spatial
    })
}
