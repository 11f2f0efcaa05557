//! Bodies from files of points, meshes, surfaces and outlines.

use std::path::{Path, PathBuf};

use pericles::space::{Finer, Region};
use pericles_deck_derive::{DeckKeys, DeckTable, DeckWords};
use serde::{Deserialize, Serialize};

use super::plane::section;
use super::positions::Positions;
use super::unit::{check_unit, unit_of};
use crate::declaration::Check;
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::{self, Frame};

/// A file of points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
pub struct PointsFile {
    /// File of the geometry; a relative path starts at the deck's folder. Points: text file with one line
    /// `x y z block volume` per point.
    #[serde(rename = "file")]
    #[deck(key = "file")]
    pub path: PathBuf,
    /// Points, mesh, solid, outline from a file: unit of length of the coordinates, such as "mm"; volumes of points are in its
    /// third power. Required for mesh, solid and outline, because the file formats do not store it; default for points: "m".
    ///
    /// In m.
    #[serde(default)]
    #[deck(with = unit_of, check = check_unit)]
    pub unit: Option<f64>,
    /// Listed points: their approximate distance; "auto" takes that of their mean volume, (volume/thickness)^(1/dimension);
    /// `material.horizon` must then be a length.
    ///
    /// In m.
    #[serde(default)]
    #[deck(quantity = Length, range = POSITIVE, none = "auto", default)]
    pub spacing: Option<f64>,
    /// Points, mesh: dimension of the body: 1, 2 or 3 for points, 2 or 3 for meshes.
    #[deck(flatten, key = "dimension", with = dimension_of_points)]
    pub dimension: usize,
    /// Area of a bar (m²), thickness of a 2D body (m); 1 in 3D.
    #[deck(flatten, with = section, keys("area", "thickness"), scope = dimension.copied())]
    pub section: f64,
}

/// A mesh file: each element of the highest dimension is a point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
pub struct MeshFile {
    /// Mesh: Gmsh (.msh), Abaqus (.inp), Exodus II (.e, .exo, .g) or VTU.
    #[serde(rename = "file")]
    #[deck(key = "file")]
    pub path: PathBuf,
    /// Points, mesh, solid, outline from a file: unit of length of the coordinates, such as "mm"; volumes of points are in its
    /// third power. Required for mesh, solid and outline, because the file formats do not store it; default for points: "m".
    ///
    /// In m.
    #[deck(with = unit_of, check = check_unit)]
    pub unit: f64,
    /// Mesh: "auto" takes the mean element size (volume/thickness)^(1/dimension); `material.horizon` must then be a length.
    ///
    /// In m.
    #[serde(default)]
    #[deck(quantity = Length, range = POSITIVE, none = "auto", default)]
    pub spacing: Option<f64>,
    /// Mesh: element group, or list of groups, that forms the body. Default: all elements of the highest dimension.
    #[serde(default)]
    #[deck(with = names)]
    pub blocks: Vec<String>,
    /// Points, mesh: dimension of the body: 1, 2 or 3 for points, 2 or 3 for meshes.
    #[deck(
        flatten,
        key = "dimension",
        with = dimension_of_mesh,
        allow_if(dimension.is_none_or(|own| *own >= 2), "2 or 3")
    )]
    pub dimension: usize,
    /// Thickness of a 2D body (m); 1 in 3D.
    #[deck(flatten, with = section, keys("area", "thickness"), scope = dimension.copied())]
    pub section: f64,
}

/// The interior of a closed surface or an outline.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = usize)]
pub struct FilledShape {
    /// Dimension of the body: 3 for a surface, 2 for an outline.
    #[deck(
        flatten,
        with = own_dimension,
        keys(),
        allow_if(dimension.is_none_or(|own| *own == 2 || *own == 3), "2 or 3")
    )]
    pub dimension: usize,
    /// The boundary of the interior.
    #[deck(flatten)]
    pub boundary: Boundary,
    /// Solid, outline: spacing of the lattice.
    ///
    /// In m.
    #[deck(quantity = Length, range = POSITIVE)]
    pub spacing: f64,
    /// Thickness of a 2D body (m); 1 in 3D.
    #[deck(flatten, with = section, keys("area", "thickness"), scope = Some(scope))]
    pub section: f64,
    /// Regions without material. Any number of tables.
    #[serde(default, rename = "hole", with = "crate::form")]
    #[deck(key = "hole", scope = frame(scope, spacing))]
    pub holes: Vec<Region>,
    /// Positions of the points.
    #[serde(default)]
    #[deck(flatten)]
    pub positions: Positions,
    /// Solid, outline: treatment of cells at the boundary. `whole`: cells whose centres are inside, with the full cell
    /// volume. `partial`: all cells that are partly inside, with the volume of that part; cells with less than 10 % of
    /// their volume inside are merged with their neighbours. The part is exact for outlines; it is computed from 16
    /// lines along z for closed surfaces and from 64 samples of the winding number for open ones. `partial` uses a
    /// neighbour list and needs positions = "lattice".
    #[serde(default)]
    #[deck(
        default,
        forbid_if(
            positions.is_some_and(Positions::are_random),
            "partial cells require positions = \"lattice\": remove `positions` or `cells`"
        )
    )]
    pub cells: FilledCells,
    /// Refined parts with smaller cells and horizon; where they overlap, the last one counts.
    #[serde(default, rename = "refine", with = "crate::form")]
    #[deck(
        key = "refine",
        scope = frame(scope, spacing),
        forbid_if(
            positions.is_some_and(Positions::are_random),
            "refinement requires positions = \"lattice\""
        ),
        forbid_if(
            cells == Some(&FilledCells::Partial),
            "refinement requires whole cells: remove `cells` or `refine`"
        )
    )]
    pub finer: Vec<Finer>,
}

/// The boundary of the interior.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[deck(exclusive, scope = usize)]
pub enum Boundary {
    /// A file of a triangulated surface (3D) or of polygons (2D).
    File {
        /// Solid: OBJ, PLY, STL, OFF, Gmsh, VTU or VTP. Outline: text file with one line `x y` per corner and blank lines
        /// between polygons.
        #[serde(rename = "file")]
        path: PathBuf,
        /// Points, mesh, solid, outline from a file: unit of length of the coordinates, such as "mm"; volumes of points are in its
        /// third power. Required for mesh, solid and outline, because the file formats do not store it; default for points: "m".
        ///
        /// In m.
        #[deck(
            with = unit_of,
            check = check_unit,
            otherwise = "only a file needs a unit; lengths in a deck carry their own"
        )]
        unit: f64,
        /// Solid: accept gaps; a point is then inside if the winding number of the surface exceeds 1/2.
        #[serde(default)]
        #[deck(default = false, forbid_if(scope == 2, "it requires shape = \"solid\""))]
        open: bool,
    },
    /// Outline: list of polygons, each a list of corners. A point belongs to the body if an odd number of polygons enclose it,
    /// so that a polygon inside another one is a hole.
    ///
    /// In m.
    #[deck(allow_if(scope == 2, "it requires shape = \"outline\""))]
    Polygons(#[deck(with = polygons, check = check_polygons)] Vec<Vec<[f64; 2]>>),
}

impl Boundary {
    /// Returns the path of the file, if there is one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::File { path, .. } => Some(path),
            Self::Polygons(_) => None,
        }
    }
}

/// Selection of cells in a filled shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "snake_case")]
#[deck(what = "kind of cells")]
pub enum FilledCells {
    /// Cells whose centres are inside, with their full volume.
    #[default]
    Whole,
    /// All cells that are partly inside, with the volume of that part; cells below a tenth are merged with
    /// their neighbours.
    Partial,
}

impl FilledShape {
    /// Returns whether its points lie on a lattice and have equal volumes.
    pub fn is_on_lattice(&self) -> bool {
        self.cells == FilledCells::Whole && !self.positions.are_random()
    }
}

fn own_dimension(_: &Table<'_>, dimension: usize) -> Option<usize> {
    Some(dimension)
}

fn dimension_of_points<S>(table: &Table<'_>, _: S) -> Option<usize> {
    dimension(table, 1, "1, 2 or 3")
}

fn dimension_of_mesh<S>(table: &Table<'_>, _: S) -> Option<usize> {
    dimension(table, 2, "2 or 3")
}

/// Reads the dimension of a body from a file; the default is 3.
fn dimension(table: &Table<'_>, least: usize, allowed: &str) -> Option<usize> {
    let is_allowed = |number| (least..=3).any(|dimension| dimension as f64 == number);
    let number = table.or("dimension", 3.0, |item| {
        item.within(Quantity::Number, allowed, is_allowed)
    });
    number.map(|number| number as usize)
}

/// Reads a name or a list of names.
fn names<S>(item: &Item<'_>, _: S) -> Option<Vec<String>> {
    if !item.is_list() {
        return Some(vec![item.text()?]);
    }
    let items = item.list("a list of names of groups")?;
    let names: Vec<Option<String>> = items.iter().map(Item::text).collect();
    names.into_iter().collect()
}

/// Returns the reference of holes and refined parts.
fn frame(dimension: usize, spacing: Option<&f64>) -> Frame {
    Frame {
        spacing: spacing.copied(),
        mesh: false,
        ..Frame::of_model(dimension)
    }
}

fn polygons(item: &Item<'_>, _: usize) -> Option<Vec<Vec<[f64; 2]>>> {
    let polygons = item.list("a list of polygons, each a list of corners [x, y]")?;
    if polygons.is_empty() {
        item.wrong_length("at least one polygon");
        return None;
    }
    let read = polygons.iter().map(|polygon| region::polygon(polygon, ()));
    let read: Vec<Option<Vec<[f64; 2]>>> = read.collect();
    read.into_iter().collect()
}

fn check_polygons(polygons: &[Vec<[f64; 2]>], path: &KeyPath, _: usize, check: &mut Check) {
    for (k, polygon) in polygons.iter().enumerate() {
        let (right, path) = (polygon.len() >= 3, path.key("polygons").index(k));
        check.within(right, path, polygon.len(), "allowed: at least 3 corners");
    }
}
