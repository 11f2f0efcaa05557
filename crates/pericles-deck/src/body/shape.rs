//! Shapes of bodies: cells of a grid, files, 2-manifolds.

use pericles::space::{Region, Shape};
use pericles_deck_derive::{DeckKeys, DeckTable};

use super::cells::{CellScope, GivenCells};
use super::sources::{FilledShape, MeshFile, PointsFile};
use super::surface::{SurfaceFile, SurfaceFormula, SurfaceShape};
use super::types::{Lattice, SolidShape};
use crate::declaration::Check;
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::range::POSITIVE;
use crate::reader::Item;
use crate::region::{self, Frame};

/// Shape of the body. 1D: `bar`. 2D: `plate`, `disc`, `outline` (polygons). 3D: `block`, `cylinder`, `ball`, `solid` (the
/// interior of a surface read from a file). From files: `mesh` (one point per element) and `points` (a list of points).
///
/// The scope is whether it is the shape of a further piece.
#[derive(DeckKeys)]
#[deck(tag = "shape", what = "shape", scope = bool)]
pub(super) enum GivenShape {
    Bar {
        #[deck(flatten)]
        length: BarLength,
        /// Bar, plate, block: lower corner.
        #[deck(quantity = Length, default = [0.0; 3], scope = Some(1))]
        origin: [f64; 3],
        #[deck(flatten, scope = CellScope { dimension: 1, is_box: true })]
        cells: GivenCells,
    },
    Plate(#[deck(flatten, scope = 2)] GivenBox),
    Disc {
        #[deck(flatten, scope = Some(2))]
        round: Round,
        /// Disc, cylinder: inner radius of a ring or tube. Default: no hole.
        #[deck(
            quantity = Length,
            range = POSITIVE.described(INNER),
            allow_if(is_smaller(inner_radius, round.map(|round| &round.radius)), INNER)
        )]
        inner_radius: Option<f64>,
        #[deck(flatten, scope = CellScope { dimension: 2, is_box: false })]
        cells: GivenCells,
    },
    Block(#[deck(flatten, scope = 3)] GivenBox),
    Cylinder {
        /// Cylinder: centre of its lower base.
        #[deck(quantity = Length, default = [0.0; 3], scope = Some(3))]
        base: [f64; 3],
        /// Cylinder: direction of its axis.
        #[deck(flatten, key = "axis", with = region::axis, check = region::check_axis)]
        axis: usize,
        /// Disc, ball, cylinder: radius.
        #[deck(quantity = Length, range = POSITIVE)]
        radius: f64,
        /// Disc, cylinder: inner radius of a ring or tube. Default: no hole.
        #[deck(
            quantity = Length,
            range = POSITIVE.described(INNER),
            allow_if(is_smaller(inner_radius, radius), INNER)
        )]
        inner_radius: Option<f64>,
        /// Cylinder: height.
        #[deck(quantity = Length, range = POSITIVE)]
        height: f64,
        #[deck(flatten, scope = CellScope { dimension: 3, is_box: false })]
        cells: GivenCells,
    },
    Ball {
        #[deck(flatten, scope = Some(3))]
        round: Round,
        #[deck(flatten, scope = CellScope { dimension: 3, is_box: false })]
        cells: GivenCells,
    },
    Icosphere(#[deck(flatten, scope = Frame::of_model(3))] SurfaceFormula),
    UvSphere(#[deck(flatten, scope = Frame::of_model(3))] SurfaceFormula),
    Ellipsoid(#[deck(flatten, scope = Frame::of_model(3))] SurfaceFormula),
    Torus(#[deck(flatten, scope = Frame::of_model(3))] SurfaceFormula),
    Capsule(#[deck(flatten, scope = Frame::of_model(3))] SurfaceFormula),
    Surface(#[deck(flatten)] SurfaceFile),
    Points {
        #[deck(flatten)]
        file: PointsFile,
        #[deck(flatten, scope = (scope, file.map(|file| file.dimension)))]
        place: Place,
    },
    Mesh {
        #[deck(flatten)]
        file: MeshFile,
        #[deck(flatten, scope = (scope, file.map(|file| file.dimension)))]
        place: Place,
    },
    Solid {
        #[deck(flatten, scope = 3)]
        filled: FilledShape,
        #[deck(flatten, scope = (scope, Some(3)))]
        place: Place,
    },
    Outline {
        #[deck(flatten, scope = 2)]
        filled: FilledShape,
        #[deck(flatten, scope = (scope, Some(2)))]
        place: Place,
    },
}

/// Length of a bar.
#[derive(DeckKeys)]
#[deck(exclusive)]
pub(super) enum BarLength {
    /// Bar: its length, a whole number of cells.
    Length(#[deck(with = size, check = check_size, scope = 1)] Vec<f64>),
    /// Bar, plate, block: edge lengths, each a whole number of cells.
    Size(#[deck(with = size, check = check_size, scope = 1)] Vec<f64>),
}

/// A plate or block; the scope is its dimension.
#[derive(DeckTable)]
#[deck(scope = usize)]
pub(super) struct GivenBox {
    /// Bar, plate, block: edge lengths, each a whole number of cells.
    #[deck(required, with = size, check = check_size)]
    size: Vec<f64>,
    /// Bar, plate, block: lower corner.
    #[deck(quantity = Length, default = [0.0; 3], scope = Some(scope))]
    origin: [f64; 3],
    #[deck(flatten, scope = CellScope { dimension: scope, is_box: true })]
    cells: GivenCells,
}

/// A disc or ball; the scope is the dimension.
#[derive(DeckTable)]
#[deck(scope = Option<usize>)]
pub(super) struct Round {
    /// Disc, ball: centre.
    #[deck(quantity = Length, default = [0.0; 3])]
    centre: [f64; 3],
    /// Disc, ball, cylinder: radius.
    #[deck(quantity = Length, range = POSITIVE)]
    radius: f64,
}

/// Position of points whose coordinates are in a file or outline; the scope is whether they form a further piece, and the
/// dimension.
#[derive(DeckTable)]
#[deck(scope = (bool, Option<usize>))]
pub(super) struct Place {
    /// Pieces from files and outlines: position of the origin of their coordinates.
    #[deck(quantity = Length, scope = scope.1, forbid_if(!scope.0, OF_PIECE))]
    origin: Option<[f64; 3]>,
}

const INNER: &str = "a positive number smaller than `radius`";

/// Why keys of pieces are not allowed in `[body]`.
pub(super) const OF_PIECE: &str =
    "it is a key of [[body.piece]]; [body] has its own position, [material] and [[initial]]";

/// Source of the points of a body or piece.
pub(super) enum Source {
    /// A body of points with volumes, and the position of the origin of a file's coordinates.
    Solid(SolidShape, [f64; 3]),
    Surface(SurfaceShape),
}

impl GivenShape {
    /// Returns the dimension of the shape that a word names; none if another key states it.
    pub(super) fn dimension(word: &str) -> Option<usize> {
        match word {
            "bar" => Some(1),
            "plate" | "disc" | "outline" => Some(2),
            "block" | "cylinder" | "ball" | "solid" => Some(3),
            _ if Self::is_surface(word) => Some(3),
            _ => None,
        }
    }

    /// Returns whether a word names a shape.
    pub(super) fn is_known(word: &str) -> bool {
        Self::dimension(word).is_some() || ["points", "mesh"].contains(&word)
    }

    /// Returns whether a word names a 2-manifold.
    pub(super) fn is_surface(word: &str) -> bool {
        [
            "icosphere",
            "uv-sphere",
            "ellipsoid",
            "torus",
            "capsule",
            "surface",
        ]
        .contains(&word)
    }

    /// Returns the source of the points.
    pub(super) fn source(self) -> Source {
        let (cells, shape, bore) = match self {
            Self::Bar {
                length: BarLength::Length(size) | BarLength::Size(size),
                origin,
                cells,
            } => (cells, Shape::Box { origin, size }, None),
            Self::Plate(given) | Self::Block(given) => {
                let GivenBox {
                    size,
                    origin,
                    cells,
                } = given;
                (cells, Shape::Box { origin, size }, None)
            }
            Self::Disc {
                round: Round { centre, radius },
                inner_radius,
                cells,
            } => {
                let bore = inner_radius.map(|radius| Region::Ball { centre, radius });
                (cells, Shape::Disc { centre, radius }, bore)
            }
            Self::Cylinder {
                base,
                axis,
                radius,
                inner_radius,
                height,
                cells,
            } => {
                let bore = inner_radius.map(|radius| Region::Cylinder {
                    centre: base,
                    axis,
                    radius,
                });
                let shape = Shape::Cylinder {
                    base,
                    axis,
                    radius,
                    height,
                };
                (cells, shape, bore)
            }
            Self::Ball {
                round: Round { centre, radius },
                cells,
            } => (cells, Shape::Ball { centre, radius }, None),
            Self::Icosphere(formula)
            | Self::UvSphere(formula)
            | Self::Ellipsoid(formula)
            | Self::Torus(formula)
            | Self::Capsule(formula) => return Source::Surface(SurfaceShape::Formula(formula)),
            Self::Surface(file) => return Source::Surface(SurfaceShape::File(file)),
            Self::Points { file, place } => return place.of(SolidShape::Points(file)),
            Self::Mesh { file, place } => return place.of(SolidShape::Mesh(file)),
            Self::Solid { filled, place } | Self::Outline { filled, place } => {
                return place.of(SolidShape::Filled(filled));
            }
        };
        Source::Solid(SolidShape::Lattice(cells.lattice(shape, bore)), [0.0; 3])
    }

    /// Returns the description of a lattice in a deck; bores are holes.
    pub(super) fn of(lattice: &Lattice) -> Self {
        let cells = GivenCells::of(lattice);
        match lattice.grid.shape.clone() {
            Shape::Box { origin, size } => match size.len() {
                1 => Self::Bar {
                    length: BarLength::Length(size),
                    origin,
                    cells,
                },
                2 => Self::Plate(GivenBox {
                    size,
                    origin,
                    cells,
                }),
                _ => Self::Block(GivenBox {
                    size,
                    origin,
                    cells,
                }),
            },
            Shape::Disc { centre, radius } => Self::Disc {
                round: Round { centre, radius },
                inner_radius: None,
                cells,
            },
            Shape::Cylinder {
                base,
                axis,
                radius,
                height,
            } => Self::Cylinder {
                base,
                axis,
                radius,
                inner_radius: None,
                height,
                cells,
            },
            Shape::Ball { centre, radius } => Self::Ball {
                round: Round { centre, radius },
                cells,
            },
        }
    }
}

impl Place {
    fn of(self, shape: SolidShape) -> Source {
        Source::Solid(shape, self.origin.unwrap_or_default())
    }
}

fn is_smaller(inner: Option<&f64>, outer: Option<&f64>) -> bool {
    let known = inner.zip(outer);
    known.is_none_or(|(inner, outer)| inner < outer)
}

/// Reads one edge length per dimension.
fn size(item: &Item<'_>, dimension: usize) -> Option<Vec<f64>> {
    let other = match (dimension, item.list_length()) {
        (1 | 3, Some(2)) => Some("\"plate\""),
        (1 | 2, Some(3)) => Some("\"block\""),
        (2 | 3, Some(1)) => Some("\"bar\""),
        _ => None,
    };
    if let Some(other) = other {
        item.wrong_length(&format!(
            "{dimension} entries, one per dimension of the body; for this number of entries use shape = {other}"
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

fn check_size(size: &[f64], path: &KeyPath, _: usize, check: &mut Check) {
    for (k, side) in size.iter().enumerate() {
        check.number(path.key("size").index(k), *side, POSITIVE);
    }
}
