//! Shapes of bodies on a grid.

use pericles::space::{Region, Shape};

use super::kind::Kind;
use crate::quantity::Quantity;
use crate::reader::Table;
use crate::region;

/// A shape and, for tubes and rings, the region of the hole.
pub(super) struct Outline {
    pub(super) shape: Shape,
    pub(super) bore: Option<Region>,
}

/// Reads the keys of a shape.
pub(super) fn shape(table: &Table<'_>, kind: Kind) -> Option<Outline> {
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
        // These have their own modules.
        Kind::Points
        | Kind::Mesh
        | Kind::Solid
        | Kind::Outline
        | Kind::Surface
        | Kind::SurfaceFile => None,
        Kind::Cylinder => {
            let base = place(table, "base", dimension);
            let axis = region::axis(table, ());
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

/// Reads the edge lengths: `size`, or `length` for a bar.
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

/// Reads a point; the default is the origin.
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
