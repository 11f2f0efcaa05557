//! Bodies that fill a closed surface or an outline with the cells of a lattice.

use std::path::PathBuf;

use pericles::space::Region;
use serde::{Deserialize, Serialize};

use super::plane::{section, state};
use super::positions::{self, Positions};
use super::types::{BodyRead, SolidShape};
use super::unit::unit;
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region;

/// The inside of a closed surface or of an outline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FilledShape {
    /// What is filled.
    pub boundary: Boundary,
    /// Spacing of the lattice, m.
    pub spacing: f64,
    /// Thickness of a body in two dimensions (m), 1 in three dimensions.
    pub section: f64,
    /// Regions without material.
    #[serde(default, rename = "hole", with = "crate::form")]
    pub holes: Vec<Region>,
    /// Which cells are points.
    #[serde(default)]
    pub cells: FilledCells,
    /// How points are arranged.
    #[serde(default)]
    pub positions: Positions,
}

/// What is filled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Boundary {
    /// A surface of triangles in a file.
    Surface {
        /// The file; a relative path starts at the folder of the deck.
        #[serde(rename = "file")]
        path: PathBuf,
        /// The file's unit of length, m.
        unit: f64,
        /// Whether the surface may have gaps: the inside is then where its winding number is above ½.
        open: bool,
    },
    /// Polygons in the plane, m: places that an odd number of them surround are inside.
    Polygons(Vec<Vec<[f64; 2]>>),
    /// The same from a file with a line `x y` for each corner and blank lines between polygons.
    PolygonFile {
        /// The file; a relative path starts at the folder of the deck.
        #[serde(rename = "file")]
        path: PathBuf,
        /// The file's unit of length, m.
        unit: f64,
    },
}

impl Boundary {
    /// Dimension of the body: 3 in a surface, 2 in polygons.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Surface { .. } => 3,
            Self::Polygons(_) | Self::PolygonFile { .. } => 2,
        }
    }

    /// The file that it is read from.
    pub fn file(&self) -> Option<&std::path::Path> {
        match self {
            Self::Surface { path, .. } | Self::PolygonFile { path, .. } => Some(path),
            Self::Polygons(_) => None,
        }
    }
}

/// Which cells of a filled lattice are points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FilledCells {
    /// Those whose centres are inside, whole.
    #[default]
    Whole,
    /// All that are partly inside, with the volume of that part; cells below a tenth give it to their neighbours.
    Partial,
}

impl FilledShape {
    /// Whether its points lie on a lattice and have equal volumes.
    pub fn is_on_lattice(&self) -> bool {
        self.cells == FilledCells::Whole && !self.positions.are_random()
    }
}

/// What `[body]` says besides the shape, where that is "solid" or "outline".
pub(super) fn read(table: Table<'_>, dimension: usize, mut read: BodyRead) -> BodyRead {
    let boundary = match dimension {
        2 => polygons(&table),
        _ => surface(&table),
    };
    read.frame.spacing = table
        .required("spacing")
        .and_then(|item| item.positive(Quantity::Length));
    read.frame.dimension = Some(dimension);
    let section = section(&table, dimension);
    read.state = state(&table, dimension);
    let holes: Vec<Option<Region>> = table
        .tables("hole")
        .into_iter()
        .map(|hole| region::read(hole, read.frame))
        .collect();
    let positions = positions::read(&table);
    let random = positions.is_some_and(|positions| positions.are_random());
    let cells = cells(&table, boundary.as_ref(), random);
    table.finish();
    read.frame.cells = !random && cells == Some(FilledCells::Whole);
    read.shape = (|| {
        Some(SolidShape::Filled(FilledShape {
            boundary: boundary?,
            spacing: read.frame.spacing?,
            section: section?,
            holes: holes.into_iter().collect::<Option<_>>()?,
            cells: cells?,
            positions: positions?,
        }))
    })();
    read
}

fn surface(table: &Table<'_>) -> Option<Boundary> {
    let path = table.required("file").and_then(|item| item.text());
    let unit = unit(table);
    let open = table.or("open", false, |item| item.boolean());
    Some(Boundary::Surface {
        path: path?.into(),
        unit: unit?,
        open: open?,
    })
}

fn polygons(table: &Table<'_>) -> Option<Boundary> {
    let (key, item) = table.exactly_one(&["polygons", "file"])?;
    if key == "file" {
        let (path, unit) = (item.text(), unit(table));
        return Some(Boundary::PolygonFile {
            path: path?.into(),
            unit: unit?,
        });
    }
    table.forbid(
        "unit",
        "lengths in a deck carry their units: only a file needs one",
    );
    let polygons = item.list("a list of polygons, each a list of corners [x, y]")?;
    if polygons.is_empty() {
        item.report(Fault::WrongLength {
            value: "[]".into(),
            found: 0,
            allowed: "allowed: at least one polygon".into(),
        });
        return None;
    }
    let corners = |polygon: &Item<'_>| -> Option<Vec<[f64; 2]>> {
        let corners = region::corners(polygon, Some(2))?;
        Some(corners.iter().map(|&[x, y, _]| [x, y]).collect())
    };
    let read: Vec<Option<Vec<[f64; 2]>>> = polygons.iter().map(corners).collect();
    read.into_iter()
        .collect::<Option<_>>()
        .map(Boundary::Polygons)
}

fn cells(table: &Table<'_>, boundary: Option<&Boundary>, random: bool) -> Option<FilledCells> {
    let closed = matches!(boundary, Some(Boundary::Surface { open: false, .. }));
    if boundary.is_some() && (random || !closed) {
        table.forbid(
            "cells",
            "only a lattice in a closed surface of triangles has partial cells",
        );
        return Some(FilledCells::Whole);
    }
    table.choice_or_first(
        "cells",
        "choice of cells",
        &[
            ("whole", FilledCells::Whole),
            ("partial", FilledCells::Partial),
        ],
    )
}
