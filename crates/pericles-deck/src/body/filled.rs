//! Bodies that fill a closed surface or an outline with the cells of a lattice.

use pericles::space::Finer;

use super::Positions;
use super::plane::{section, state};
use super::sources::{Boundary, FilledCells, FilledShape};
use super::types::{BodyRead, SolidShape};
use super::unit::unit;
use crate::declaration::{DeckKeys, declared};
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::Table;
use crate::region;

/// Reads `[body]` with `shape = "solid"` or `"outline"`.
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
    let holes = declared(&table, "hole", read.frame);
    let positions = Positions::read_keys(&table, ());
    let random = positions.is_some_and(|positions| positions.are_random());
    let cells = cells(&table, random);
    let finer = declared::<_, Finer>(&table, "refine", read.frame);
    let refined = finer.as_ref().is_none_or(|parts| !parts.is_empty());
    if refined && random {
        table.forbid("refine", "refinement requires positions = \"lattice\"");
    } else if refined && cells == Some(FilledCells::Partial) {
        table.forbid(
            "refine",
            "refinement requires whole cells: remove `cells` or `refine`",
        );
    }
    table.finish();
    read.frame.cells = !random && cells == Some(FilledCells::Whole);
    read.shape = (|| {
        Some(SolidShape::Filled(FilledShape {
            boundary: boundary?,
            spacing: read.frame.spacing?,
            section: section?,
            holes: holes?,
            finer: finer?,
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
        "only a file needs a unit; lengths in a deck carry their own",
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
    let corners = |polygon| region::polygon(polygon, ());
    let read: Vec<Option<Vec<[f64; 2]>>> = polygons.iter().map(corners).collect();
    read.into_iter()
        .collect::<Option<_>>()
        .map(Boundary::Polygons)
}

fn cells(table: &Table<'_>, random: bool) -> Option<FilledCells> {
    if random {
        table.forbid(
            "cells",
            "partial cells require positions = \"lattice\": remove `positions` or `cells`",
        );
        return Some(FilledCells::Whole);
    }
    table.choice_or_first(
        "cells",
        "kind of cells",
        &[
            ("whole", FilledCells::Whole),
            ("partial", FilledCells::Partial),
        ],
    )
}
