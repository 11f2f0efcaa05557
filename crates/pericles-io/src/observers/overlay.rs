//! Lines on pictures of plane bodies: pre-cracks, interfaces of materials, borders of refined parts.

use std::collections::HashMap;

use pericles::space::PointCloud;

use super::cell_mesh::CellMesh;
use crate::numbering::Numbering;

/// Lines on the pictures of a plane body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlay {
    /// Pre-cracks at their reference positions: both sides of an open crack move away from them.
    cracks: Vec<[[f64; 2]; 2]>,
    /// Cell edges between points of different class.
    interfaces: Vec<Edge>,
}

/// An edge that moves with the points on both sides.
#[derive(Debug, Clone, PartialEq)]
struct Edge {
    ends: [[f64; 2]; 2],
    points: [u32; 2],
}

impl Overlay {
    /// Creates the overlay of a plane body whose points are the centres of boxes. `class` tells points of different material or
    /// cell size apart; empty if all are equal.
    pub fn new(cloud: &PointCloud, cracks: Vec<[[f64; 2]; 2]>, class: &[u32]) -> Self {
        let is_uniform = class.windows(2).all(|pair| pair[0] == pair[1]);
        let interfaces = match is_uniform || cloud.dimension() != 2 {
            true => Vec::new(),
            false => interfaces(cloud, class),
        };
        Self { cracks, interfaces }
    }

    /// Returns the lines for a displacement, component-major, magnified by `scale`.
    pub fn lines(&self, displacement: &[f64], scale: f64) -> Vec<Vec<[f64; 2]>> {
        let n = displacement.len() / 2;
        let cracks = self.cracks.iter().map(|ends| ends.to_vec());
        let interfaces = self.interfaces.iter().map(|edge| {
            let shift: [f64; 2] = std::array::from_fn(|c| {
                let moved = edge.points.map(|i| displacement[c * n + i as usize]);
                0.5 * scale * (moved[0] + moved[1])
            });
            let shifted = |end: &[f64; 2]| [end[0] + shift[0], end[1] + shift[1]];
            edge.ends.iter().map(shifted).collect()
        });
        let lines = cracks.chain(interfaces);
        lines
            .filter(|line: &Vec<[f64; 2]>| line.iter().flatten().all(|x| x.is_finite()))
            .collect()
    }
}

/// Returns the edges between cells of different class; where cells of different size meet, the edges of the cells that are
/// not of the first class.
fn interfaces(cloud: &PointCloud, class: &[u32]) -> Vec<Edge> {
    let mesh = CellMesh::of_boxes(cloud);
    let nodes = mesh.nodes.len() / 3;
    let numbering = Numbering::of(cloud);
    let mut point_of_cell = vec![0; cloud.len()];
    for i in 0..cloud.len() as u32 {
        point_of_cell[numbering.number(i) as usize] = i;
    }
    let place = |node: u32| [mesh.nodes[node as usize], mesh.nodes[nodes + node as usize]];
    let edge = |(a, b): (u32, u32), points: [u32; 2]| Edge {
        ends: [place(a), place(b)],
        points,
    };
    let mut open: HashMap<(u32, u32), u32> = HashMap::new();
    let mut found = Vec::new();
    for (cell, &point) in point_of_cell.iter().enumerate() {
        let corners = mesh.cells.corners_of(cell);
        for (k, &a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            let key = (a.min(b), a.max(b));
            match open.remove(&key) {
                Some(other) if class[other as usize] != class[point as usize] => {
                    found.push(edge(key, [other, point]));
                }
                Some(_) => {}
                None => {
                    open.insert(key, point);
                }
            }
        }
    }
    let [low, high] = cloud.bounds();
    let slack = 1e-3 * cloud.spacing();
    let is_outer = |ends: &[[f64; 2]; 2]| {
        (0..2).any(|c| {
            let on = |x: f64| ends.iter().all(|end| (end[c] - x).abs() < slack);
            on(low[c]) || on(high[c])
        })
    };
    let base = class[0];
    let mut hanging: Vec<_> = open.into_iter().collect();
    hanging.sort_unstable();
    for (key, point) in hanging {
        let single = edge(key, [point, point]);
        if class[point as usize] != base && !is_outer(&single.ends) {
            found.push(single);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::space::{Grid, Shape};

    #[test]
    fn interfaces_are_the_edges_between_classes_and_move_with_the_body() {
        let shape = Shape::Box {
            origin: [0.0; 3],
            size: vec![4.0, 2.0],
        };
        let plate = Grid {
            shape,
            spacing: 1.0,
            section: 1.0,
            holes: vec![],
        };
        let cloud = plate.points().unwrap();
        let class: Vec<u32> = cloud.axis(0).iter().map(|&x| u32::from(x > 2.0)).collect();
        let crack = [[0.0, 1.0], [1.0, 1.0]];
        let overlay = Overlay::new(&cloud, vec![crack], &class);
        let mut u = vec![0.0; 16];
        u[..8].fill(0.5);
        let lines = overlay.lines(&u, 2.0);
        assert_eq!(lines[0], crack);
        let mut heights: Vec<f64> = lines[1..].iter().flatten().map(|p| p[1]).collect();
        heights.sort_by(f64::total_cmp);
        assert_eq!(heights, [0.0, 1.0, 1.0, 2.0]);
        assert!(lines[1..].iter().flatten().all(|p| p[0] == 3.0));
    }
}
