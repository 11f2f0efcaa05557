//! The cells of a body, one for each point.
//!
//! Cells are derived from the points: field files of grids have cell data, files of other bodies point data. Readers
//! use centroids of cells as points.

use std::collections::HashMap;

use pericles::space::PointCloud;

use crate::numbering::Numbering;
use crate::vtk::VtuCells;

/// Cells of a body, one for each of its points or for some of them.
#[derive(Debug, Clone)]
pub struct CellMesh {
    /// Positions of the nodes, m: x of all, then y, then z.
    pub nodes: Vec<f64>,
    /// The cells.
    pub cells: VtuCells,
    /// The point of each cell, in the user's order, ascending.
    pub points: Vec<u32>,
}

/// Signs of the corners of a box in the order of VTK; the first two form a line, the first four a quadrilateral.
const CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// VTK's types of lines, quadrilaterals and hexahedra.
const BOX_TYPES: [u8; 3] = [3, 9, 12];

impl CellMesh {
    /// The cells of a body whose points are the centres of boxes: lines, quadrilaterals or hexahedra. Cells of a piece share the nodes in
    /// which they meet.
    pub fn of_boxes(cloud: &PointCloud) -> Self {
        /// Corners that are nearer to each other than this share of the smallest cell are one node.
        const SAME: f64 = 1e-4;
        let (n, dimension) = (cloud.len(), cloud.dimension());
        let [low, _] = cloud.bounds();
        let sides = |i: usize| -> [f64; 3] {
            std::array::from_fn(|c| match cloud.cell_sides() {
                Some(sides) => sides.get(c).copied().unwrap_or(0.0),
                None => cloud.cell_size(i),
            })
        };
        let smallest = (0..n)
            .flat_map(|i| sides(i).into_iter().take(dimension))
            .fold(f64::INFINITY, f64::min);
        let numbering = Numbering::of(cloud);
        let mut in_order = vec![0; n];
        for i in 0..n as u32 {
            in_order[numbering.number(i) as usize] = i as usize;
        }
        let mut numbers: HashMap<([i64; 3], u32), u32> = HashMap::with_capacity(n);
        let mut nodes: Vec<[f64; 3]> = Vec::with_capacity(n);
        let mut cells = VtuCells::default();
        for i in in_order {
            let (centre, sides) = (cloud.point(i), sides(i));
            let corners = CORNERS[..1 << dimension].iter().map(|signs| {
                let place: [f64; 3] = std::array::from_fn(|c| match c < dimension {
                    true => centre[c] + 0.5 * signs[c] * sides[c],
                    false => 0.0,
                });
                let key = std::array::from_fn(|c| {
                    ((place[c] - low[c]) / (SAME * smallest)).round() as i64
                });
                *numbers.entry((key, cloud.piece(i))).or_insert_with(|| {
                    nodes.push(place);
                    nodes.len() as u32 - 1
                })
            });
            let corners: Vec<u32> = corners.collect();
            cells.push(BOX_TYPES[dimension - 1], &corners);
        }
        let along = |c: usize| nodes.iter().map(move |place| place[c]);
        Self {
            nodes: (0..3).flat_map(along).collect(),
            cells,
            points: (0..n as u32).collect(),
        }
    }

    /// A field of the cells at the nodes: the mean of the cells that meet there; component-major.
    pub(super) fn at_nodes(&self, values: &[f64]) -> Vec<f64> {
        let (cells, nodes) = (self.cells.len(), self.nodes.len() / 3);
        let mut counts = vec![0.0; nodes];
        for &corner in self.cells.corners() {
            counts[corner as usize] += 1.0;
        }
        let mut means = Vec::with_capacity(values.len() / cells.max(1) * nodes);
        for component in values.chunks(cells.max(1)) {
            let mut sums = vec![0.0; nodes];
            for (cell, value) in component.iter().enumerate() {
                for &corner in self.cells.corners_of(cell) {
                    sums[corner as usize] += value;
                }
            }
            means.extend(sums.iter().zip(&counts).map(|(sum, count)| sum / count));
        }
        means
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::space::{Finer, GradedGrid, Grid, Region, Shape};

    #[test]
    fn touching_pieces_have_nodes_of_their_own() {
        let cloud = plate().points().unwrap();
        let right = cloud.axis(0).iter().map(|&x| u32::from(x > 0.0)).collect();
        let apart = cloud.clone().with_pieces(right).unwrap();
        // The three nodes of the common edge exist twice.
        let nodes = |cloud: &PointCloud| CellMesh::of_boxes(cloud).nodes.len() / 3;
        assert_eq!((nodes(&cloud), nodes(&apart)), (12, 15));
    }

    fn plate() -> Grid {
        let shape = Shape::Box {
            origin: [-1.0, 0.0, 0.0],
            size: vec![3.0, 2.0],
        };
        Grid {
            shape,
            spacing: 1.0,
            section: 1.0,
            holes: vec![],
        }
    }

    /// Area of each quadrilateral by the shoelace formula.
    fn areas(mesh: &CellMesh) -> Vec<f64> {
        let n = mesh.nodes.len() / 3;
        let place = |k: u32| (mesh.nodes[k as usize], mesh.nodes[n + k as usize]);
        let area = |cell: usize| {
            let corners = mesh.cells.corners_of(cell);
            (0..4)
                .map(|k| {
                    let ((x0, y0), (x1, y1)) = (place(corners[k]), place(corners[(k + 1) % 4]));
                    0.5 * (x0 * y1 - x1 * y0)
                })
                .sum()
        };
        (0..mesh.cells.len()).map(area).collect()
    }

    #[test]
    fn cells_of_a_plate_share_their_nodes_and_have_the_area_of_the_points() {
        let cloud = plate().points().unwrap();
        let mesh = CellMesh::of_boxes(&cloud);
        assert_eq!(mesh.nodes.len(), 3 * 4 * 3);
        assert_eq!(mesh.cells.len(), 6);
        for (area, volume) in areas(&mesh).iter().zip(cloud.volumes()) {
            assert!((area - volume).abs() < 1e-14);
        }
        // A linear field of the centres is the same linear function at inner nodes.
        let values = mesh.at_nodes(cloud.axis(0));
        let inner = (0..12).filter(|&k| mesh.nodes[k] == 0.0 && mesh.nodes[12 + k] == 1.0);
        for k in inner {
            assert!(values[k].abs() < 1e-15);
        }
    }

    #[test]
    fn cells_of_several_sizes_have_the_area_of_their_points() {
        let finer = Finer {
            region: Region::Box {
                min: [0.0, f64::NEG_INFINITY, f64::NEG_INFINITY],
                max: [1.0, f64::INFINITY, f64::INFINITY],
            },
            ratio: 3,
        };
        let grid = GradedGrid {
            grid: plate(),
            finer: vec![finer],
        };
        let cloud = grid.points().unwrap().cloud;
        let mesh = CellMesh::of_boxes(&cloud);
        assert_eq!(mesh.cells.len(), 4 + 2 * 9);
        // 4 × 7 nodes of the small cells, 2 × 3 of the large ones beside them that are not among these.
        assert_eq!(mesh.nodes.len() / 3, 28 + 6);
        for (i, area) in areas(&mesh).iter().enumerate() {
            assert!((area - cloud.volumes()[i]).abs() < 1e-13);
        }
    }
}
