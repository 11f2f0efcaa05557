//! What is in a mesh, for people and scripts.

use super::{MeshPoints, SetKind};
use crate::cell::CellKind;
use crate::raw::RawMesh;

/// A set in a summary.
#[derive(Debug, Clone, PartialEq)]
pub struct SetSummary {
    /// Its name.
    pub name: String,
    /// What defines it.
    pub kind: SetKind,
    /// Its number of points.
    pub points: usize,
    /// The area of its faces, m².
    pub area: Option<f64>,
}

/// What is in a mesh, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// The number of nodes.
    pub nodes: usize,
    /// The number of cells of every kind.
    pub kinds: Vec<(CellKind, usize)>,
    /// The number of elements of types that are not used.
    pub left_out: Vec<(String, usize)>,
    /// The number of points.
    pub points: usize,
    /// The number of points in no group of elements.
    pub in_no_group: usize,
    /// The volume of all points, m³.
    pub volume: f64,
    /// The corners of the box that holds the nodes of all elements, m.
    pub bounds: [[f64; 3]; 2],
    /// The least, mean and largest size of an element, m.
    pub sizes: [f64; 3],
    /// The sets.
    pub sets: Vec<SetSummary>,
    /// Warnings.
    pub problems: Vec<String>,
}

impl Summary {
    /// The summary of a mesh and the points made of it with this unit of length (m).
    pub fn new(mesh: &RawMesh, points: &MeshPoints, unit: f64) -> Self {
        let mut grouped = vec![false; points.len()];
        for set in points
            .sets
            .iter()
            .filter(|set| set.kind == SetKind::Elements)
        {
            for &point in &set.points {
                grouped[point as usize] = true;
            }
        }
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for &cell in &points.cells {
            for &node in mesh.cells.corners(cell as usize) {
                for (c, &x) in mesh.nodes[node as usize].iter().enumerate() {
                    bounds[0][c] = bounds[0][c].min(x * unit);
                    bounds[1][c] = bounds[1][c].max(x * unit);
                }
            }
        }
        let [least, most] = points.extremes();
        let sets = points.sets.iter().map(|set| SetSummary {
            name: set.name.clone(),
            kind: set.kind,
            points: set.points.len(),
            area: set.area,
        });
        Self {
            nodes: mesh.nodes.len(),
            kinds: mesh.cells.counts(),
            left_out: mesh
                .left_out
                .iter()
                .map(|(name, count)| (name.clone(), *count))
                .collect(),
            points: points.len(),
            in_no_group: grouped.iter().filter(|grouped| !**grouped).count(),
            volume: points.volumes.iter().sum(),
            bounds,
            sizes: [points.sizes[least], points.mean_size(), points.sizes[most]],
            sets: sets.collect(),
            problems: points.warnings.iter().map(ToString::to_string).collect(),
        }
    }
}
