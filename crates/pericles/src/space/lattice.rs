//! Regular lattices.

use super::Point;

/// The regular lattice on which the points of a cloud lie.
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    /// Distance between neighbouring nodes along each axis, m; any number along missing axes.
    pub spacing: [f64; 3],
    /// Nodes of the bounding box along each axis; 1 along missing axes.
    pub shape: [usize; 3],
    /// Node of each point: `x + shape[0] * (y + shape[1] * z)`, ascending.
    pub node: Vec<u32>,
}

impl Lattice {
    /// Whether the cells are as long along all of the first `dimension` axes.
    pub fn is_cubic(&self, dimension: usize) -> bool {
        self.spacing[..dimension]
            .iter()
            .all(|dx| *dx == self.spacing[0])
    }

    /// The vector that leads so many steps along the axes, m.
    #[inline]
    pub fn vector(&self, steps: [i32; 3]) -> Point {
        std::array::from_fn(|c| f64::from(steps[c]) * self.spacing[c])
    }

    /// The sides of the box of all nodes and their cells, m.
    pub fn sides(&self) -> Point {
        std::array::from_fn(|c| self.shape[c] as f64 * self.spacing[c])
    }

    /// The integer coordinates of a node.
    pub fn coordinates(&self, node: u32) -> [i32; 3] {
        let node = node as usize;
        let row = node / self.shape[0];
        [
            (node % self.shape[0]) as i32,
            (row % self.shape[1]) as i32,
            (row / self.shape[1]) as i32,
        ]
    }
}
