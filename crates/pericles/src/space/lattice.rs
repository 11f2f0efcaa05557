//! Regular lattices.

use super::Point;

/// The regular lattice of the points of a cloud.
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    /// Distance between neighbouring nodes along each axis, m; arbitrary along missing axes.
    pub spacing: [f64; 3],
    /// Number of nodes of the bounding box along each axis; 1 along missing axes.
    pub shape: [usize; 3],
    /// Node of each point: `x + shape[0] * (y + shape[1] * z)`, ascending.
    pub node: Vec<u32>,
}

impl Lattice {
    /// Returns whether the spacing is the same along the first `dimension` axes.
    pub fn is_cubic(&self, dimension: usize) -> bool {
        self.spacing[..dimension]
            .iter()
            .all(|dx| *dx == self.spacing[0])
    }

    /// Returns the vector of the given steps along the axes, m.
    #[inline]
    pub fn vector(&self, steps: [i32; 3]) -> Point {
        std::array::from_fn(|c| f64::from(steps[c]) * self.spacing[c])
    }

    /// Sides of the box of all cells, m.
    pub fn sides(&self) -> Point {
        std::array::from_fn(|c| self.shape[c] as f64 * self.spacing[c])
    }

    /// Returns the integer coordinates of a node.
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
