//! Regular lattices.
//!
//! Grid points have integer coordinates, and bond vectors are integer differences times the spacing. Equal bonds are
//! therefore bitwise equal, and a symmetric body breaks symmetrically.

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
    /// Edge of the cube (square, interval) with the volume of a cell, m.
    pub fn size(&self, dimension: usize) -> f64 {
        match self.is_cubic(dimension) {
            true => self.spacing[0],
            false => {
                let volume: f64 = self.spacing[..dimension].iter().product();
                volume.powf(1.0 / dimension as f64)
            }
        }
    }

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

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.shape.iter().product()
    }

    /// Returns the position of a node, m, if node 0 is at `origin`; components beyond `dimension` are zero.
    pub fn position(&self, dimension: usize, origin: Point, node: u32) -> Point {
        let cell = self.coordinates(node);
        std::array::from_fn(|c| match c < dimension {
            true => origin[c] + f64::from(cell[c]) * self.spacing[c],
            false => 0.0,
        })
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
