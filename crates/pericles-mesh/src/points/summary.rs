//! Summary of a mesh.

use super::{MeshPoints, SetKind};
use crate::cell::CellKind;
use crate::raw::RawMesh;

/// A set in a summary.
#[derive(Debug, Clone, PartialEq)]
pub struct SetSummary {
    /// Name.
    pub name: String,
    /// Origin.
    pub kind: SetKind,
    /// Number of points.
    pub points: usize,
    /// Area of the faces, m².
    pub area: Option<f64>,
}

/// Summary of a mesh in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Number of nodes.
    pub nodes: usize,
    /// Number of cells of each type.
    pub kinds: Vec<(CellKind, usize)>,
    /// Number of elements of unsupported types.
    pub left_out: Vec<(String, usize)>,
    /// Number of points.
    pub points: usize,
    /// Number of points that are in no element group.
    pub in_no_group: usize,
    /// Total volume of the points, m³.
    pub volume: f64,
    /// Corners of the bounding box of the nodes of all elements, m.
    pub bounds: [[f64; 3]; 2],
    /// Minimum, mean and maximum element size, m.
    pub sizes: [f64; 3],
    /// The sets.
    pub sets: Vec<SetSummary>,
    /// Warnings.
    pub problems: Vec<String>,
}

impl Summary {
    /// Summarises a mesh and the points created from it, with the unit of length in m.
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
