//! Serialised form of grids, regions and cracks.

use pericles::family::Crack;
use pericles::space::{Face, Finer, Grid, Point, Region, Shape};
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

#[derive(Serialize, Deserialize)]
#[serde(remote = "Finer", deny_unknown_fields)]
struct FinerForm {
    #[serde(with = "crate::form")]
    region: Region,
    ratio: u32,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Region", rename_all = "snake_case", deny_unknown_fields)]
enum RegionForm {
    All,
    Box {
        #[serde(with = "crate::form")]
        min: Point,
        #[serde(with = "crate::form")]
        max: Point,
    },
    Ball {
        centre: Point,
        radius: f64,
    },
    Cylinder {
        centre: Point,
        axis: usize,
        radius: f64,
    },
    HalfSpace {
        point: Point,
        normal: Point,
    },
    Layer {
        #[serde(rename = "side", with = "crate::form")]
        face: Face,
        depth: f64,
    },
    Polygon {
        corners: Vec<[f64; 2]>,
    },
    Union(#[serde(with = "crate::form")] Vec<Region>),
    Intersection(#[serde(with = "crate::form")] Vec<Region>),
    Complement(#[serde(with = "crate::form")] Box<Region>),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Crack", rename_all = "snake_case", deny_unknown_fields)]
enum CrackForm {
    Section {
        x: f64,
    },
    Segment {
        from: [f64; 2],
        to: [f64; 2],
    },
    Polygon {
        corners: Vec<Point>,
    },
    Disc {
        centre: Point,
        normal: Point,
        radius: f64,
    },
    Triangles {
        triangles: Vec<[Point; 3]>,
    },
    Layer {
        points: Vec<Point>,
        spacing: f64,
        dimension: usize,
    },
}

described!(Grid: GridForm, Shape: ShapeForm, Finer: FinerForm, Region: RegionForm, Crack: CrackForm);
