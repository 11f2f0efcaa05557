//! Serialised form of grids.

use pericles::space::{Grid, Point, Region, Shape};
use serde::{Deserialize, Serialize};

use super::described;

#[derive(Serialize, Deserialize)]
#[serde(remote = "Grid", deny_unknown_fields)]
struct GridForm {
    #[serde(with = "crate::form")]
    shape: Shape,
    spacing: f64,
    section: f64,
    #[serde(rename = "hole", with = "crate::form")]
    holes: Vec<Region>,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Shape", rename_all = "snake_case", deny_unknown_fields)]
enum ShapeForm {
    Box {
        origin: Point,
        size: Vec<f64>,
    },
    Disc {
        centre: Point,
        radius: f64,
    },
    Cylinder {
        base: Point,
        axis: usize,
        radius: f64,
        height: f64,
    },
    Ball {
        centre: Point,
        radius: f64,
    },
}

described!(Grid: GridForm, Shape: ShapeForm);
