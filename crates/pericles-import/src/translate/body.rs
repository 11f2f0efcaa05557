//! The discretisation: `[body]` and `[[crack]]`.

use std::fs;
use std::path::Path;

use pericles::space::ListedPoints;
use pericles_io::parse_points;

use super::material::Materials;
use super::model::Plane;
use super::{Code, Source};
use crate::entry::{Entry, is_same};
use crate::error::Fault;
use crate::table::{self, Table};
use crate::units::{Quantity, Units};

/// The body of an input file.
#[derive(Debug)]
pub(crate) struct Body {
    pub(super) dimension: usize,
    points: Points,
    pub(crate) tables: Vec<Table>,
}

/// The points of a body.
#[derive(Debug)]
enum Points {
    /// From a text file; without volumes if it cannot be read.
    Listed(Option<ListedPoints>),
    /// A grid of equal cells.
    Grid { volume: f64 },
    /// Elements of a mesh.
    Mesh,
}

impl Body {
    pub(crate) fn read(source: &Source<'_>, materials: &Materials<'_>) -> Result<Self, Fault> {
        let entry = source.root.need(&["Discretization"])?;
        let kind = entry
            .find("Type")
            .map(Entry::text)
            .transpose()?
            .unwrap_or("Text File");
        let table = Table::new("[body]").from(entry);
        let mut body = if is_same(kind, "PdQuickGrid") {
            grid(table, entry, &source.units)?
        } else {
            let file = entry.need(&["Input Mesh File"])?;
            let link = source.link.join(file.text()?);
            let table = table.key(
                "shape",
                table::text(if is_same(kind, "Text File") {
                    "points"
                } else {
                    "mesh"
                }),
            );
            let table = table.key("file", table::text(&link.display().to_string()));
            let table = table.key("unit", table::text(source.units.length_name()));
            if is_same(kind, "Text File") {
                listed(table, source, file, materials)?
            } else {
                let dimension = if materials.plane.is_some() { 2 } else { 3 };
                file.differ("node sets of the file become the elements at their nodes; compare the sets with `pericles check`");
                Self {
                    dimension,
                    points: Points::Mesh,
                    tables: vec![table.key("dimension", dimension.to_string())],
                }
            }
        };
        if body.dimension == 2 {
            let plane = materials.plane.map(|plane| match plane {
                Plane::Stress => table::text("stress"),
                Plane::Strain => table::text("strain"),
            });
            body.tables = body
                .tables
                .into_iter()
                .map(|table| {
                    table.maybe("plane", plane.clone()).key(
                        "thickness",
                        source.units.number(materials.thickness, Quantity::Length),
                    )
                })
                .collect();
        }
        if let Some(function) = entry.find("Influence Function")
            && !["One", "1"].contains(&function.text()?)
        {
            function.refuse("see `material.influence`; the deck has the constant function");
        }
        if let Some(filters) = entry.find("Bond Filters") {
            for filter in filters.entries()? {
                let crack = crack(filter, body.dimension, &source.units)?;
                body.tables.extend(crack);
            }
        }
        Ok(body)
    }

    pub(super) fn is_mesh(&self) -> bool {
        matches!(self.points, Points::Mesh)
    }

    /// Returns the volume of each of the points, if it is the same for all; `None` stands for all points.
    pub(super) fn common_volume(&self, members: Option<&[usize]>) -> Option<f64> {
        let listed = match &self.points {
            Points::Grid { volume } => return Some(*volume),
            Points::Listed(Some(listed)) => listed,
            _ => return None,
        };
        let volumes: Vec<f64> = match members {
            Some(members) => members
                .iter()
                .filter_map(|&k| listed.volumes.get(k).copied())
                .collect(),
            None => listed.volumes.clone(),
        };
        let first = *volumes.first()?;
        volumes
            .iter()
            .all(|v| (v - first).abs() < 1e-6 * first)
            .then_some(first)
    }
}

/// The body of a text file with points.
fn listed(
    table: Table,
    source: &Source<'_>,
    file: &Entry,
    materials: &Materials<'_>,
) -> Result<Body, Fault> {
    let name = file.text()?;
    let path = source.folder.join(name);
    let plane = if materials.plane.is_some() { 2 } else { 3 };
    let content = fs::read(&path).map_err(|reason| reason.to_string());
    let dimension = match (source.code, &content) {
        (Code::PeriLab, Ok(content)) => columns(content).unwrap_or(plane),
        _ => plane,
    };
    let points = content.and_then(|content| {
        parse_points(Path::new(name), &content, dimension).map_err(|error| error.to_string())
    });
    if let Err(reason) = &points {
        file.differ(format!("the points cannot be read: {reason}"));
    }
    let table = table.key("dimension", dimension.to_string());
    Ok(Body {
        dimension,
        points: Points::Listed(points.ok()),
        tables: vec![table],
    })
}

/// Returns the dimension of a list of points from its first line: the header, or the number of columns.
fn columns(content: &[u8]) -> Option<usize> {
    let text = String::from_utf8_lossy(content);
    let line = text.lines().find(|line| {
        let line = line.trim();
        !line.is_empty() && !line.starts_with(['#', '!'])
    })?;
    let words: Vec<&str> = super::names(line).collect();
    if words.first()?.parse::<f64>().is_ok() {
        return words
            .len()
            .checked_sub(2)
            .filter(|dimension| (1..=3).contains(dimension));
    }
    let has = |name: &str| words.iter().any(|word| word.eq_ignore_ascii_case(name));
    Some(if has("z") { 3 } else { 2 })
}

/// The body of Peridigm's generator of grids.
fn grid(table: Table, entry: &Entry, units: &Units) -> Result<Body, Fault> {
    let grid = entry.need(&["TensorProduct3DMeshGenerator"])?;
    if let Some(kind) = grid.find("Type") {
        kind.text()?;
    }
    let numbers = |what: &str| -> Result<Vec<f64>, Fault> {
        let axes = ["X", "Y", "Z"];
        axes.iter()
            .map(|axis| grid.need(&[&format!("{axis} {what}")])?.number())
            .collect()
    };
    let counts: Result<Vec<usize>, Fault> = ["X", "Y", "Z"]
        .iter()
        .map(|axis| grid.need(&[&format!("Number Points {axis}")])?.count())
        .collect();
    let (size, counts) = (numbers("Length")?, counts?);
    let spacing: Vec<f64> = size
        .iter()
        .zip(&counts)
        .map(|(size, count)| size / *count as f64)
        .collect();
    let is_cubic = spacing
        .iter()
        .all(|dx| (dx - spacing[0]).abs() < 1e-9 * spacing[0]);
    let spacing_key = if is_cubic {
        units.number(spacing[0], Quantity::Length)
    } else {
        units.numbers(&spacing, Quantity::Length)
    };
    let table = table
        .from(grid)
        .key("shape", table::text("block"))
        .key("size", units.numbers(&size, Quantity::Length));
    let table = table
        .key(
            "origin",
            units.numbers(&numbers("Origin")?, Quantity::Length),
        )
        .key("spacing", spacing_key);
    Ok(Body {
        dimension: 3,
        points: Points::Grid {
            volume: spacing.iter().product(),
        },
        tables: vec![table],
    })
}

/// Translates a bond filter to a pre-crack.
fn crack(filter: &Entry, dimension: usize, units: &Units) -> Result<Option<Table>, Fault> {
    let vector = |name: &str| -> Result<[f64; 3], Fault> {
        let mut vector = [0.0; 3];
        for (value, axis) in vector.iter_mut().zip(["X", "Y", "Z"]) {
            *value = filter.need(&[&format!("{name} {axis}")])?.number()?;
        }
        Ok(vector)
    };
    let table = Table::new("[[crack]]").from(filter);
    let kind = filter.need(&["Type"])?;
    let text = kind.text()?;
    if dimension < 2 {
        filter.refuse("pre-cracks of bars are `[[crack]] section`");
        return Ok(None);
    }
    if is_same(text, "Rectangular_Plane") {
        let (corner, normal) = (vector("Lower Left Corner")?, unit(vector("Normal")?));
        let bottom = unit(vector("Bottom Unit Vector")?);
        let along = filter.need(&["Bottom Length"])?.positive()?;
        let side = filter.need(&["Side Length"])?.positive()?;
        let up = cross(bottom, normal);
        let at = |a: f64, b: f64| [0, 1, 2].map(|c| corner[c] + a * bottom[c] + b * up[c]);
        if dimension == 3 {
            let corners = [at(0.0, 0.0), at(along, 0.0), at(along, side), at(0.0, side)];
            let corners = corners
                .iter()
                .map(|corner| units.numbers(corner, Quantity::Length));
            return Ok(Some(table.key("polygon", table::list(corners))));
        }
        // The rectangle cuts the plane z = 0 along one of its edges.
        let ends = match (bottom[2].abs() < 1e-9, up[2].abs() < 1e-9) {
            (true, false)
                if (corner[2]..=corner[2] + side * up[2]).contains(&0.0)
                    || (corner[2] + side * up[2]..=corner[2]).contains(&0.0) =>
            {
                Some(at(along, 0.0))
            }
            (false, true) => Some(at(0.0, side)),
            _ => None,
        };
        let Some(end) = ends else {
            filter
                .refuse("the rectangle does not cut the plane of the body along one of its edges");
            return Ok(None);
        };
        let segment = [corner, end].map(|point| units.numbers(&point[..2], Quantity::Length));
        return Ok(Some(table.key("segment", table::list(segment))));
    }
    if is_same(text, "Disk") && dimension == 3 {
        let disc = format!(
            "{{ centre = {}, normal = {}, radius = {} }}",
            units.numbers(&vector("Center")?, Quantity::Length),
            table::numbers(&vector("Normal")?),
            units.number(filter.need(&["Radius"])?.positive()?, Quantity::Length)
        );
        return Ok(Some(table.key("disc", disc)));
    }
    filter.refuse("bond filters of this type have no counterpart");
    Ok(None)
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    vector.map(|x| if length > 0.0 { x / length } else { x })
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|c| {
        let (d, e) = ((c + 1) % 3, (c + 2) % 3);
        a[d] * b[e] - a[e] * b[d]
    })
}
