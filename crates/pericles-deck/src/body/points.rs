//! Bodies whose points are listed in a file.

use super::plane::{section, state};
use super::types::{BodyRead, PointsFile, SolidShape};
use crate::quantity::Quantity;
use crate::reader::Table;

/// Reads `[body]` with `shape = "points"`.
pub(super) fn read(table: Table<'_>, mut read: BodyRead) -> BodyRead {
    const DIMENSIONS: [(f64, usize); 3] = [(1.0, 1), (2.0, 2), (3.0, 3)];
    let path = table.required("file").and_then(|item| item.text());
    read.frame.spacing = table
        .required("spacing")
        .and_then(|item| item.positive(Quantity::Length));
    let number = table.or("dimension", 3.0, |item| {
        item.within(Quantity::Number, "1, 2 or 3", |number| {
            DIMENSIONS.iter().any(|(allowed, _)| *allowed == number)
        })
    });
    let dimension = DIMENSIONS
        .iter()
        .find(|(allowed, _)| Some(*allowed) == number);
    let Some(&(_, dimension)) = dimension else {
        return read;
    };
    read.frame.dimension = Some(dimension);
    let section = section(&table, dimension);
    read.state = state(&table, dimension);
    table.finish();
    read.shape = shape(&read, section, path, dimension);
    read
}

fn shape(
    read: &BodyRead,
    section: Option<f64>,
    path: Option<String>,
    dimension: usize,
) -> Option<SolidShape> {
    Some(SolidShape::Points(PointsFile {
        path: path?.into(),
        dimension,
        spacing: read.frame.spacing?,
        section: section?,
    }))
}
