//! Bodies whose points are listed in a file.

use std::path::PathBuf;

use pericles::space::{Grid, Shape};

use crate::body::{self, Body, BodyRead, Quadrature};
use crate::quantity::Quantity;
use crate::reader::Table;

/// The file that lists a body's points.
#[derive(Debug, Clone, PartialEq)]
pub struct PointsFile {
    /// The file; a relative path starts at the folder of the deck.
    pub path: PathBuf,
    /// Dimension of the body.
    pub dimension: usize,
}

/// What `[body]` says besides the shape, where that is "points".
pub(crate) fn read(table: Table<'_>, mut read: BodyRead) -> BodyRead {
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
    let section = body::section(&table, dimension);
    read.state = body::state(&table, dimension);
    table.finish();
    read.body = body(&read, section, path, dimension);
    read
}

fn body(
    read: &BodyRead,
    section: Option<f64>,
    path: Option<String>,
    dimension: usize,
) -> Option<Body> {
    Some(Body {
        grid: no_grid(dimension, read.frame.spacing?, section?),
        listed: Some(PointsFile {
            path: path?.into(),
            dimension,
        }),
        rectangular: None,
        finer: Vec::new(),
        state: read.state?,
        periodic: false,
        quadrature: Quadrature::Midpoint,
    })
}

/// What stands in the place of a grid: only its spacing and section are used.
fn no_grid(dimension: usize, spacing: f64, section: f64) -> Grid {
    Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: vec![spacing; dimension],
        },
        spacing,
        section,
        holes: Vec::new(),
    }
}
