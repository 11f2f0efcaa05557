//! `[[crack]]`: surfaces that cut bonds before the run.

use pericles::family::{Crack, EndRule};
use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::{self, Frame};

/// A pre-crack with the rule at its border.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PreCrack {
    /// The surface.
    #[serde(with = "crate::form")]
    pub surface: Crack,
    /// What happens to bonds through its border.
    #[serde(default, with = "crate::form")]
    pub ends: EndRule,
}

/// The kinds of crack with the dimension they belong to.
const KINDS: [(&str, usize, &str); 4] = [
    ("section", 1, "a section cuts a bar (1D)"),
    ("segment", 2, "a segment cuts a body of two dimensions"),
    ("polygon", 3, "a polygon cuts a body of three dimensions"),
    ("disc", 3, "a disc cuts a body of three dimensions"),
];

pub(crate) fn read(table: Table<'_>, frame: Frame) -> Option<PreCrack> {
    let surface = match frame.dimension {
        Some(dimension) => {
            for (kind, needs, reason) in KINDS {
                if needs != dimension {
                    table.forbid(kind, reason);
                }
            }
            match dimension {
                1 => table.required("section").and_then(|item| section(&item)),
                2 => table.required("segment").and_then(|item| segment(&item)),
                _ => spatial(&table),
            }
        }
        // The body is refused already: only keep its kinds of crack from being reported as unknown.
        None => {
            for (kind, ..) in KINDS {
                table.optional(kind);
            }
            None
        }
    };
    let ends = table.worded("ends", "end rule");
    let crack = surface.zip(ends);
    if let (Some((surface, ends)), Some(spacing)) = (&crack, frame.spacing) {
        // The same tolerance as when bonds are cut.
        table.accept(surface.cutter(*ends, 1e-9 * spacing))?;
    }
    table.finish();
    let (surface, ends) = crack?;
    Some(PreCrack { surface, ends })
}

fn section(item: &Item<'_>) -> Option<Crack> {
    Some(Crack::Section {
        x: item.vector(Quantity::Length, Some(1))?[0],
    })
}

fn segment(item: &Item<'_>) -> Option<Crack> {
    let ends = item.exactly(2, "two points [[x, y], [x, y]]")?;
    let (from, to) = (
        ends[0].vector(Quantity::Length, Some(2)),
        ends[1].vector(Quantity::Length, Some(2)),
    );
    let flat = |point: [f64; 3]| [point[0], point[1]];
    Some(Crack::Segment {
        from: flat(from?),
        to: flat(to?),
    })
}

fn spatial(table: &Table<'_>) -> Option<Crack> {
    let (kind, item) = table.exactly_one(&["polygon", "disc"])?;
    if kind == "polygon" {
        let corners = region::corners(&item, Some(3))?;
        return Some(Crack::Polygon { corners });
    }
    let table = item.table()?;
    let centre = table
        .required("centre")
        .and_then(|item| item.vector(Quantity::Length, Some(3)));
    let normal = table
        .required("normal")
        .and_then(|item| region::direction(&item, Some(3)));
    let radius = table
        .required("radius")
        .and_then(|item| item.positive(Quantity::Length));
    table.finish();
    Some(Crack::Disc {
        centre: centre?,
        normal: normal?,
        radius: radius?,
    })
}
