//! `[[crack]]`: surfaces that cut bonds before the run.

use std::path::{Path, PathBuf};

use pericles::family::{Crack, EndRule};
use serde::{Deserialize, Serialize};

use crate::body::unit;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::{self, Frame};

/// A pre-crack with the rule at its border.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PreCrack {
    /// The surface.
    pub surface: CrackSurface,
    /// What happens to bonds through its border.
    #[serde(default, with = "crate::form")]
    pub ends: EndRule,
}

/// The surface of a pre-crack.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum CrackSurface {
    /// A plane surface.
    Plane(#[serde(with = "crate::form")] Crack),
    /// Triangles in a file.
    File {
        /// The file; a relative path starts at the folder of the deck.
        #[serde(rename = "file")]
        path: PathBuf,
        /// The file's unit of length, m.
        unit: f64,
    },
}

impl From<Crack> for CrackSurface {
    fn from(crack: Crack) -> Self {
        Self::Plane(crack)
    }
}

impl CrackSurface {
    /// The file that it is read from.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Plane(_) => None,
            Self::File { path, .. } => Some(path),
        }
    }
}

/// The kinds of crack with the dimension they belong to.
const KINDS: [(&str, usize, &str); 5] = [
    ("section", 1, "a section cuts a bar (1D)"),
    ("segment", 2, "a segment cuts a body of two dimensions"),
    ("polygon", 3, "a polygon cuts a body of three dimensions"),
    ("disc", 3, "a disc cuts a body of three dimensions"),
    (
        "file",
        3,
        "a surface of triangles cuts a body of three dimensions",
    ),
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
                1 => table
                    .required("section")
                    .and_then(|item| section(&item))
                    .map(CrackSurface::Plane),
                2 => table
                    .required("segment")
                    .and_then(|item| segment(&item))
                    .map(CrackSurface::Plane),
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
    if table.has("file") {
        table.forbid("ends", "the border of a surface of triangles is part of it");
    } else {
        table.forbid("unit", "only a surface of triangles from a `file` has one");
    }
    let ends = table.worded("ends", "end rule");
    let crack = surface.zip(ends);
    if let (Some((CrackSurface::Plane(surface), ends)), Some(spacing)) = (&crack, frame.spacing) {
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

fn spatial(table: &Table<'_>) -> Option<CrackSurface> {
    let (kind, item) = table.exactly_one(&["polygon", "disc", "file"])?;
    match kind {
        "polygon" => {
            let corners = region::corners(&item, Some(3))?;
            Some(Crack::Polygon { corners }.into())
        }
        "disc" => disc(&item).map(CrackSurface::Plane),
        _ => {
            let (path, unit) = (item.text(), unit(table));
            Some(CrackSurface::File {
                path: path?.into(),
                unit: unit?,
            })
        }
    }
}

fn disc(item: &Item<'_>) -> Option<Crack> {
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
