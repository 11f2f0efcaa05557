//! Regions of space in sets, holes and refinements.

use pericles::space::{Face, Finer, Point, Region};
use pericles_deck_derive::{DeckKeys, DeckTable};
use serde::{Deserialize, Serialize};

use crate::declaration::{Check, DeckKeys, DeckValue, Spatial};
use crate::fault::Fault;
use crate::form::described;
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::range::{Range, from_to};
use crate::reader::{Item, Table};
use crate::words::Worded;

/// Reference of a region: dimension and spacing of the body.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    /// Dimension of the body; none if the body could not be read.
    pub(crate) dimension: Option<usize>,
    /// Spacing, m.
    pub(crate) spacing: Option<f64>,
    /// Whether all cells have one size, so that lengths may be given in cells.
    pub(crate) cells: bool,
    /// Whether the body or a piece of it is a mesh, whose file defines sets and, by default, the spacing.
    pub(crate) mesh: bool,
    /// Whether the body is a list of points, whose volumes define the spacing by default.
    pub(crate) listed: bool,
}

impl Frame {
    /// Returns the frame of a body of a model, whose lengths are in metres.
    pub(crate) fn of_model(dimension: usize) -> Self {
        Self {
            dimension: Some(dimension),
            spacing: None,
            cells: true,
            mesh: true,
            listed: false,
        }
    }

    /// Returns whether the spacing is unknown before the file of the body is read.
    pub(crate) fn is_automatic(&self) -> bool {
        (self.mesh || self.listed) && self.spacing.is_none()
    }
}

impl Spatial for Frame {
    fn dimension(&self) -> Option<usize> {
        self.dimension
    }
}

/// Depth of a layer, or distance from the faces of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "snake_case")]
#[deck(exclusive)]
pub enum Depth {
    /// Thickness of the layer; for faces the largest distance from them.
    ///
    /// In m.
    #[deck(key = "depth")]
    Length(#[deck(quantity = Length, range = POSITIVE)] f64),
    /// Thickness of the layer in spacings; for faces the largest distance from them.
    Cells(#[deck(range = POSITIVE)] f64),
}

impl Depth {
    /// Returns the depth in metres for a given spacing (m).
    pub fn length(self, spacing: f64) -> f64 {
        match self {
            Self::Length(length) => length,
            Self::Cells(cells) => cells * spacing,
        }
    }
}

/// Region of space.
#[derive(Serialize, Deserialize, DeckKeys)]
#[serde(remote = "Region", rename_all = "snake_case", deny_unknown_fields)]
#[deck(exclusive, remote = Region, define = "region", scope = Frame)]
enum RegionForm {
    /// All of space.
    #[deck(key = "all", define = "all")]
    All,
    /// Axis-aligned box. A missing corner, or an entry "open", means no bound.
    #[deck(table, define = "box")]
    Box {
        /// Lower corner.
        #[serde(with = "crate::form")]
        #[deck(with = lower_corner, default = [f64::NEG_INFINITY; 3])]
        min: Point,
        /// Upper corner.
        #[serde(with = "crate::form")]
        #[deck(
            with = upper_corner,
            default = [f64::INFINITY; 3],
            allow_if(
                are_ordered(min, max),
                "an upper corner `max` not below the lower corner `min` along any axis"
            )
        )]
        max: Point,
    },
    /// Ball (3D) or disc (2D).
    #[deck(table, define = "ball")]
    Ball {
        /// Centre.
        #[deck(quantity = Length)]
        centre: Point,
        /// Radius.
        #[deck(quantity = Length, range = POSITIVE)]
        radius: f64,
    },
    /// 3D: infinite circular cylinder.
    #[deck(
        table,
        define = "cylinder",
        allow_if(scope.dimension.is_none_or(|own| own == 3), "`cylinder` requires a 3D body; in 2D, a `ball` is a disc")
    )]
    Cylinder {
        /// Point on the axis.
        #[deck(quantity = Length)]
        centre: Point,
        /// Direction of the axis.
        #[deck(flatten, key = "axis", with = axis, check = check_axis)]
        axis: usize,
        /// Radius.
        #[deck(quantity = Length, range = POSITIVE)]
        radius: f64,
    },
    /// Half-space on the side of a plane opposite to its normal.
    #[deck(table, define = "half_space")]
    HalfSpace {
        /// Point on the plane.
        #[deck(quantity = Length)]
        point: Point,
        /// Outward normal vector, of any length.
        #[deck(with = normal)]
        normal: Point,
    },
    /// Layer at one side of the body's bounding box. Give `depth` or `cells`.
    #[deck(table, define = "layer")]
    Layer {
        /// Side of the bounding box.
        #[serde(rename = "side", with = "crate::form")]
        #[deck(key = "side", with = side)]
        face: Face,
        #[deck(flatten, with = layer_depth, keys("depth", "cells"), check = check_depth)]
        depth: f64,
    },
    /// 2D, 3D: polygon in the x–y plane; infinite along z in 3D.
    #[deck(
        table,
        define = "polygon",
        allow_if(scope.dimension != Some(1), "`polygon` requires a 2D or 3D body; in 1D, a `box` is an interval")
    )]
    Polygon {
        /// Corners in order, at least three.
        #[deck(required, with = polygon, check = check_corners)]
        corners: Vec<[f64; 2]>,
    },
    /// Union of regions.
    #[deck(define = "union")]
    Union(
        #[serde(with = "crate::form")]
        #[deck(allow_if(value0.is_none_or(|parts| !parts.is_empty()), "at least one region"))]
        Vec<Region>,
    ),
    /// Intersection of regions.
    #[deck(define = "intersection")]
    Intersection(
        #[serde(with = "crate::form")]
        #[deck(allow_if(value0.is_none_or(|parts| !parts.is_empty()), "at least one region"))]
        Vec<Region>,
    ),
    /// Complement of a region.
    #[deck(define = "complement")]
    Complement(#[serde(with = "crate::form")] Box<Region>),
}

/// Regions with a smaller spacing and horizon, for analytic shapes, filled surfaces and outlines with whole lattice
/// cells. Any number of tables; where they overlap, the last one counts. Refined bodies use a neighbour list, and the
/// fracture energy determines one critical stretch per cell size. A bond exists within the larger horizon of its end
/// points; its force is the mean of both end points' force laws.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "Finer", deny_unknown_fields)]
#[deck(remote = Finer, scope = Frame)]
struct FinerForm {
    /// Number of parts into which cells with their centre in the region are divided along each axis. The horizon shrinks by
    /// the same factor.
    #[deck(range = RATIOS)]
    ratio: u32,
    #[serde(with = "crate::form")]
    #[deck(flatten)]
    region: Region,
}

described!(Region: RegionForm, Finer: FinerForm);

impl DeckValue<Frame> for Box<Region> {
    fn read(item: &Item<'_>, frame: Frame) -> Option<Self> {
        Region::read(item, frame).map(Self::new)
    }

    fn check(&self, path: KeyPath, frame: Frame, check: &mut Check) {
        (**self).check(path, frame, check);
    }
}

/// Larger ratios would make time steps that differ as much.
const RATIOS: Range = from_to(2.0, 16.0).whole();

fn lower_corner(item: &Item<'_>, frame: Frame) -> Option<Point> {
    corner(item, frame, f64::NEG_INFINITY)
}

fn upper_corner(item: &Item<'_>, frame: Frame) -> Option<Point> {
    corner(item, frame, f64::INFINITY)
}

/// Reads a corner whose entries may be open.
fn corner(item: &Item<'_>, frame: Frame, open: f64) -> Option<Point> {
    let words = [
        ("open", open),
        ("inf", f64::INFINITY),
        ("+inf", f64::INFINITY),
        ("-inf", f64::NEG_INFINITY),
    ];
    let expected = format!("{}, or \"open\"", Quantity::Length.expected());
    let items = item.components(frame.dimension, &expected)?;
    let mut corner = Some([open; 3]);
    for (c, entry) in items.iter().enumerate() {
        let word = words.iter().find(|(word, _)| entry.is_keyword(word));
        let value = word.map_or_else(
            || entry.quantity(Quantity::Length),
            |(_, bound)| Some(*bound),
        );
        match (value, &mut corner) {
            (Some(value), Some(corner)) => corner[c] = value,
            _ => corner = None,
        }
    }
    corner
}

/// Returns whether an upper corner, if both are known, is not below a lower one.
fn are_ordered(min: Option<&Point>, max: Option<&Point>) -> bool {
    let corners = min.zip(max);
    corners.is_none_or(|(min, max)| (0..3).all(|c| min[c] <= max[c]))
}

/// Reads the axis of a cylinder; the default is z.
pub(crate) fn axis<S>(table: &Table<'_>, _: S) -> Option<usize> {
    table.choice_or_first("axis", "axis", &[("z", 2), ("x", 0), ("y", 1)])
}

pub(crate) fn check_axis<S>(axis: &usize, path: &KeyPath, _: S, check: &mut Check) {
    check.axis(path.key("axis"), *axis);
}

fn normal(item: &Item<'_>, frame: Frame) -> Option<Point> {
    direction(item, frame.dimension)
}

/// Reads a nonzero vector.
pub(crate) fn direction(item: &Item<'_>, dimension: Option<usize>) -> Option<Point> {
    let vector = item.vector(Quantity::Number, dimension)?;
    if vector == [0.0; 3] {
        item.out_of_range("a nonzero vector, of any length");
        return None;
    }
    Some(vector)
}

/// Reads a side within the dimension of the body.
fn side(item: &Item<'_>, frame: Frame) -> Option<Face> {
    let sides = Face::words();
    item.choice(Face::WHAT, &sides[..2 * frame.dimension.unwrap_or(3)])
}

fn layer_depth(table: &Table<'_>, frame: Frame) -> Option<f64> {
    match Depth::read_keys(table, ())? {
        Depth::Cells(_) if !frame.cells => {
            if let Some(item) = table.optional("cells") {
                item.out_of_range("`depth` instead; this body has no uniform spacing");
            }
            None
        }
        Depth::Cells(cells) => frame.spacing.map(|spacing| cells * spacing),
        Depth::Length(length) => Some(length),
    }
}

fn check_depth<S>(depth: &f64, path: &KeyPath, _: S, check: &mut Check) {
    check.positive(path.key("depth"), *depth);
}

/// Reads at least three corners in the plane.
pub(crate) fn polygon<S>(item: &Item<'_>, _: S) -> Option<Vec<[f64; 2]>> {
    let corners = corners(item, Some(2))?;
    Some(corners.iter().map(|&[x, y, _]| [x, y]).collect())
}

fn check_corners<S>(corners: &[[f64; 2]], path: &KeyPath, _: S, check: &mut Check) {
    let allowed = "allowed: at least 3 corners";
    check.within(
        corners.len() >= 3,
        path.key("corners"),
        corners.len(),
        allowed,
    );
}

/// Reads at least three points.
pub(crate) fn corners(item: &Item<'_>, dimension: Option<usize>) -> Option<Vec<Point>> {
    let items = item.list("a list of corners, each a list of coordinates")?;
    if items.len() < 3 {
        item.report(Fault::WrongLength {
            value: "the list of corners".into(),
            found: items.len(),
            allowed: "allowed: at least 3 corners".into(),
        });
        return None;
    }
    let read: Vec<Option<Point>> = items
        .iter()
        .map(|corner| corner.vector(Quantity::Length, dimension))
        .collect();
    read.into_iter().collect()
}
