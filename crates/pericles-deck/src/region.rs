//! Regions of space in sets, holes and refinements.

use pericles::PericlesError;
use pericles::space::{Face, Point, Region};
use pericles_deck_derive::DeckKeys;
use serde::{Deserialize, Serialize};

use crate::declaration::{DeckKeys, Spatial};
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::vocabulary::REGIONS;

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
}

impl Frame {
    /// Returns the frame of a body of a model, whose lengths are in metres.
    pub(crate) fn of_model(dimension: usize) -> Self {
        Self {
            dimension: Some(dimension),
            spacing: None,
            cells: true,
            mesh: true,
        }
    }

    /// Returns whether the spacing is unknown before a mesh is read.
    pub(crate) fn is_automatic(&self) -> bool {
        self.mesh && self.spacing.is_none()
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

/// Reads a table with exactly one key, the kind of region.
pub(crate) fn read(table: Table<'_>, frame: Frame) -> Option<Region> {
    table.define("region");
    read_among_others(table, frame)
}

/// Reads the kind of region in a table with other keys.
pub(crate) fn read_among_others(table: Table<'_>, frame: Frame) -> Option<Region> {
    let found = table.exactly_one(REGIONS);
    table.finish();
    let (kind, item) = found?;
    of_kind(kind, &item, frame)
}

/// Reads a region of a kind.
pub(crate) fn of_kind(kind: &'static str, item: &Item<'_>, frame: Frame) -> Option<Region> {
    item.define(kind);
    match kind {
        "all" => everything(item),
        "box" => axis_parallel_box(item.table()?, frame),
        "ball" => ball(item.table()?, frame),
        "cylinder" => cylinder(item, frame),
        "half_space" => half_space(item.table()?, frame),
        "layer" => layer(item.table()?, frame),
        "polygon" => polygon(item, frame),
        "union" => Some(Region::Union(several(item, frame)?)),
        "intersection" => Some(Region::Intersection(several(item, frame)?)),
        _ => Some(Region::Complement(Box::new(read(item.table()?, frame)?))),
    }
}

fn everything(item: &Item<'_>) -> Option<Region> {
    if item.boolean()? {
        return Some(Region::All);
    }
    item.out_of_range("true; remove the table for no region");
    None
}

fn several(item: &Item<'_>, frame: Frame) -> Option<Vec<Region>> {
    let parts = item.list("a list of regions")?;
    if parts.is_empty() {
        item.report(Fault::WrongLength {
            value: "[]".into(),
            found: 0,
            allowed: "allowed: at least one region".into(),
        });
        return None;
    }
    let read: Vec<Option<Region>> = parts
        .iter()
        .map(|part| part.table().and_then(|table| read(table, frame)))
        .collect();
    read.into_iter().collect()
}

fn axis_parallel_box(table: Table<'_>, frame: Frame) -> Option<Region> {
    let bound = |item: Option<Item<'_>>, open: f64| match item {
        None => Some([open; 3]),
        Some(item) => bounds(&item, frame, open),
    };
    let upper = table.optional("max");
    let (min, max) = (
        bound(table.optional("min"), f64::NEG_INFINITY),
        bound(upper.clone(), f64::INFINITY),
    );
    table.finish();
    let (min, max) = (min?, max?);
    if let Some(item) = upper
        && (0..3).any(|c| min[c] > max[c])
    {
        item.out_of_range("an upper corner `max` not below the lower corner `min` along any axis");
        return None;
    }
    Some(Region::Box { min, max })
}

/// Reads a corner whose entries may be open.
fn bounds(item: &Item<'_>, frame: Frame, open: f64) -> Option<Point> {
    let items = item.components(
        frame.dimension,
        &format!("{}, or \"open\"", Quantity::Length.expected()),
    )?;
    let mut corner = Some([open; 3]);
    for (c, entry) in items.iter().enumerate() {
        let words = [
            ("open", open),
            ("inf", f64::INFINITY),
            ("+inf", f64::INFINITY),
            ("-inf", f64::NEG_INFINITY),
        ];
        let value = words
            .into_iter()
            .find(|(word, _)| entry.is_keyword(word))
            .map(|(_, bound)| bound)
            .or_else(|| entry.quantity(Quantity::Length));
        match (value, &mut corner) {
            (Some(value), Some(corner)) => corner[c] = value,
            _ => corner = None,
        }
    }
    corner
}

fn ball(table: Table<'_>, frame: Frame) -> Option<Region> {
    let centre = point(&table, "centre", frame);
    let radius = table
        .required("radius")
        .and_then(|item| item.positive(Quantity::Length));
    table.finish();
    Some(Region::Ball {
        centre: centre?,
        radius: radius?,
    })
}

fn cylinder(item: &Item<'_>, frame: Frame) -> Option<Region> {
    let table = item.table()?;
    if let Some(dimension) = frame.dimension
        && dimension != 3
    {
        item.report(
            PericlesError::WrongDimension {
                what: "a cylinder as a region",
                needed: "3 (a ball is a disc in two dimensions)",
                dimension,
            }
            .into(),
        );
        return None;
    }
    let centre = point(&table, "centre", frame);
    let axis = axis(&table);
    let radius = table
        .required("radius")
        .and_then(|item| item.positive(Quantity::Length));
    table.finish();
    Some(Region::Cylinder {
        centre: centre?,
        axis: axis?,
        radius: radius?,
    })
}

/// Reads the axis of a cylinder; the default is z.
pub(crate) fn axis(table: &Table<'_>) -> Option<usize> {
    table.choice_or_first("axis", "axis", &[("z", 2), ("x", 0), ("y", 1)])
}

fn half_space(table: Table<'_>, frame: Frame) -> Option<Region> {
    let point = point(&table, "point", frame);
    let normal = table
        .required("normal")
        .and_then(|item| direction(&item, frame.dimension));
    table.finish();
    Some(Region::HalfSpace {
        point: point?,
        normal: normal?,
    })
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

fn layer(table: Table<'_>, frame: Frame) -> Option<Region> {
    const SIDES: [(&str, usize); 6] = [
        ("-x", 1),
        ("+x", 1),
        ("-y", 2),
        ("+y", 2),
        ("-z", 3),
        ("+z", 3),
    ];
    // Only sides within the dimension of the body are allowed.
    let sides: Vec<(&'static str, &'static str)> = SIDES
        .iter()
        .filter(|(_, needs)| *needs <= frame.dimension.unwrap_or(3))
        .map(|(side, _)| (*side, *side))
        .collect();
    let side = table
        .required("side")
        .and_then(|item| item.choice("side", &sides));
    let depth = match Depth::read_keys(&table, ()) {
        Some(Depth::Cells(_)) if !frame.cells => {
            if let Some(item) = table.optional("cells") {
                item.out_of_range("`depth` instead; this body has no uniform spacing");
            }
            None
        }
        Some(Depth::Cells(cells)) => frame.spacing.map(|spacing| cells * spacing),
        Some(Depth::Length(length)) => Some(length),
        None => None,
    };
    table.finish();
    Some(Region::Layer {
        face: Face::named(side?)?,
        depth: depth?,
    })
}

fn polygon(item: &Item<'_>, frame: Frame) -> Option<Region> {
    let table = item.table()?;
    if frame.dimension == Some(1) {
        item.report(
            PericlesError::WrongDimension {
                what: "a polygon as a region",
                needed: "2 or 3 (a box or a ball is an interval in one dimension)",
                dimension: 1,
            }
            .into(),
        );
        return None;
    }
    let corners = table
        .required("corners")
        .and_then(|item| corners(&item, Some(2)));
    table.finish();
    let flat = corners?
        .iter()
        .map(|corner| [corner[0], corner[1]])
        .collect();
    Some(Region::Polygon { corners: flat })
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

fn point(table: &Table<'_>, key: &'static str, frame: Frame) -> Option<Point> {
    table
        .required(key)?
        .vector(Quantity::Length, frame.dimension)
}
