//! Stencil: the family of a lattice node, the same for all nodes.

use crate::space::Lattice;

/// The bonds of a node within reach, in ascending order of the index of the neighbour. The opposite of offset
/// k is offset `len() − 1 − k`.
///
/// Offsets that exceed the bounding box of the lattice are omitted, so that small bodies have small stencils.
#[derive(Debug, Clone, Default)]
pub struct Stencil {
    cells: Vec<[i32; 3]>,
    shifts: Vec<isize>,
    vectors: Vec<[f64; 3]>,
    lengths: Vec<f64>,
    volumes: Vec<f64>,
}

impl Stencil {
    /// Creates the stencil of a lattice whose nodes are stored with the given strides per axis. `volume` is κ V of a bond
    /// of a given length, m³.
    pub fn new(
        lattice: &Lattice,
        strides: [usize; 3],
        reach: f64,
        volume: &dyn Fn(f64) -> f64,
    ) -> Self {
        let mut stencil = Self::default();
        let range = |c: usize| {
            let most = (reach / lattice.spacing[c] * (1.0 + 1e-9)).floor() as i64;
            let n = most.min(lattice.shape[c] as i64 - 1) as i32;
            -n..=n
        };
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let cell = [x, y, z];
                    let xi = lattice.vector(cell);
                    let length = (xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]).sqrt();
                    if cell != [0; 3] && length <= reach {
                        let along = (0..3).map(|c| cell[c] as isize * strides[c] as isize);
                        stencil.cells.push(cell);
                        stencil.shifts.push(along.sum());
                        stencil.vectors.push(xi);
                        stencil.lengths.push(length);
                        stencil.volumes.push(volume(length));
                    }
                }
            }
        }
        stencil
    }

    /// The number of offsets.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Returns whether nodes have no neighbours.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Returns the opposite offset, from the neighbour to the node.
    pub fn opposite(&self, k: usize) -> usize {
        self.len() - 1 - k
    }

    /// The offsets of the neighbours, in spacings.
    pub fn cells(&self) -> &[[i32; 3]] {
        &self.cells
    }

    /// The distances to the neighbours in the padded rows, in places.
    pub fn shifts(&self) -> &[isize] {
        &self.shifts
    }

    /// The reference vectors ξ, m.
    pub fn vectors(&self) -> &[[f64; 3]] {
        &self.vectors
    }

    /// The reference lengths |ξ|, m.
    pub fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// κ V of the neighbours, m³.
    pub fn volumes(&self) -> &[f64] {
        &self.volumes
    }

    /// Returns the largest distance of a neighbour, in places.
    pub fn farthest_shift(&self) -> usize {
        let shifts = self.shifts.iter().map(|shift| shift.unsigned_abs());
        shifts.max().unwrap_or(0)
    }

    /// Returns the largest distance of a neighbour along each axis, in spacings.
    pub fn radius(&self) -> [usize; 3] {
        std::array::from_fn(|axis| self.farthest(axis))
    }

    /// Returns the largest distance of a neighbour along an axis, in spacings.
    pub fn farthest(&self, axis: usize) -> usize {
        let steps = |cell: &[i32; 3]| cell[axis].unsigned_abs() as usize;
        self.cells.iter().map(steps).max().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stencil(shape: [usize; 3], reach: f64) -> Stencil {
        let lattice = Lattice {
            spacing: [1.0; 3],
            shape,
            node: vec![],
        };
        let strides = [1, shape[0], shape[0] * shape[1]];
        Stencil::new(&lattice, strides, reach, &|_| 1.0)
    }

    #[test]
    fn stencils_have_all_offsets_in_the_box_with_their_opposites() {
        assert_eq!(stencil([9, 9, 9], 3.015).len(), 122);
        assert_eq!(stencil([9, 9, 1], 3.015).len(), 28);
        // 2 × 2 × 2 nodes: all offsets of at most one node along each axis.
        assert_eq!(stencil([2, 2, 2], 3.015).len(), 26);
        let stencil = stencil([9, 8, 7], 3.3);
        for k in 0..stencil.len() {
            let back = stencil.cells()[stencil.opposite(k)];
            assert_eq!(stencil.cells()[k].map(|steps| -steps), back);
        }
        // Offset (0, 1, 3); (0, 0, 3) and (1, 0, 3) are closer in memory.
        assert_eq!(stencil.farthest_shift(), 3 * 72 + 9);
        assert_eq!(stencil.farthest(2), 3);
    }
}
