//! Bodies whose points are the elements of a mesh in a file.

use super::plane::{section, state};
use super::sources::MeshFile;
use super::types::{BodyRead, SolidShape};
use super::unit::unit;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};

/// The word for the mean element size as spacing.
const AUTO: &str = "auto";

/// Reads `[body]` with `shape = "mesh"`.
pub(super) fn read(table: Table<'_>, mut read: BodyRead) -> BodyRead {
    let path = table.required("file").and_then(|item| item.text());
    let unit = unit(&table);
    let spacing = spacing(&table);
    read.frame.mesh = true;
    read.frame.cells = false;
    read.frame.spacing = spacing.flatten();
    let blocks = table.maybe("blocks", |item| names(&item));
    let number = table.or("dimension", 3.0, |item| {
        item.within(Quantity::Number, "2 or 3", |number| {
            number == 2.0 || number == 3.0
        })
    });
    let Some(number) = number else {
        return read;
    };
    let dimension = if number == 2.0 { 2 } else { 3 };
    read.frame.dimension = Some(dimension);
    let section = section(&table, dimension);
    read.state = state(&table, dimension);
    table.finish();
    read.shape = (|| {
        Some(SolidShape::Mesh(MeshFile {
            path: path?.into(),
            unit: unit?,
            dimension,
            blocks: blocks?.unwrap_or_default(),
            spacing: spacing?,
            section: section?,
        }))
    })();
    read
}

/// Reads a length or "auto", the default.
fn spacing(table: &Table<'_>) -> Option<Option<f64>> {
    match table.optional("spacing") {
        None => {
            table.record("spacing", AUTO);
            Some(None)
        }
        Some(item) if item.is_keyword(AUTO) => Some(None),
        Some(item) => item.positive(Quantity::Length).map(Some),
    }
}

/// Reads a name or a list of names.
fn names(item: &Item<'_>) -> Option<Vec<String>> {
    if !item.is_list() {
        return Some(vec![item.text()?]);
    }
    let items = item.list("a list of names of groups")?;
    let names: Vec<Option<String>> = items.iter().map(Item::text).collect();
    names.into_iter().collect()
}
