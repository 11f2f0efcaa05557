//! `[[crack]]`: pre-cracks, which cut bonds before the run.

use std::path::{Path, PathBuf};

use pericles::family::{Crack, EndRule};
use serde::{Deserialize, Serialize};

use crate::body::unit;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::{self, Frame};
use crate::set::SetNames;

/// A pre-crack.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PreCrack {
    /// The surface.
    pub surface: CrackSurface,
    /// Treatment of bonds through the crack edge.
    #[serde(default, with = "crate::form")]
    pub ends: EndRule,
}

/// The surface of a pre-crack.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum CrackSurface {
    /// A planar crack.
    Plane(#[serde(with = "crate::form")] Crack),
    /// Triangles from a file.
    File {
        /// Path of the file; a relative path starts at the deck's folder.
        #[serde(rename = "file")]
        path: PathBuf,
        /// Unit of length of the file, m.
        unit: f64,
    },
    /// A layer of points that bonds between other points do not cross.
    Layer {
        /// Name of the set of its points.
        layer: String,
    },
}

impl From<Crack> for CrackSurface {
    fn from(crack: Crack) -> Self {
        Self::Plane(crack)
    }
}

impl CrackSurface {
    /// Returns the path of the file, if there is one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Plane(_) | Self::Layer { .. } => None,
            Self::File { path, .. } => Some(path),
        }
    }
}

/// Keys of cracks, with the required dimension of the body and the advice.
const KINDS: [(&str, usize, &str); 5] = [
    ("section", 1, "`section` requires a bar (1D)"),
    ("segment", 2, "`segment` requires a 2D body"),
    ("polygon", 3, "`polygon` requires a 3D body"),
    ("disc", 3, "`disc` requires a 3D body"),
    ("file", 3, "`file` requires a 3D body"),
];

pub(crate) fn read(table: Table<'_>, frame: Frame, sets: &SetNames) -> Option<PreCrack> {
    let is_layer = table.has("layer");
    let surface = match frame.dimension {
        Some(dimension) => {
            for (kind, needs, reason) in KINDS {
                if needs != dimension {
                    table.forbid(kind, reason);
                }
            }
            match dimension {
                _ if is_layer => layer(&table, sets),
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
        // The body is invalid: mark all kinds of crack as known.
        None => {
            for (kind, ..) in KINDS {
                table.optional(kind);
            }
            table.optional("layer");
            None
        }
    };
    if is_layer {
        for key in KINDS.map(|(kind, ..)| kind) {
            table.forbid(key, "a `layer` has no other surface");
        }
        table.forbid("ends", "bonds with an end in the `layer` always remain");
    } else if table.has("file") {
        table.forbid("ends", "a crack from a `file` always includes its edges");
    } else {
        table.forbid("unit", "it requires `file`");
    }
    let ends = table.worded("ends", "end rule");
    let crack = surface.zip(ends);
    if let (Some((CrackSurface::Plane(surface), ends)), Some(spacing)) = (&crack, frame.spacing) {
        // The tolerance must be the one with which bonds are cut.
        table.accept(surface.cutter(*ends, 1e-9 * spacing))?;
    }
    table.finish();
    let (surface, ends) = crack?;
    Some(PreCrack { surface, ends })
}

fn layer(table: &Table<'_>, sets: &SetNames) -> Option<CrackSurface> {
    let layer = table.required("layer")?;
    let layer = sets.reference(&layer)?;
    Some(CrackSurface::Layer { layer })
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
