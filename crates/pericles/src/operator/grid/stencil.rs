//! Stencil: the family of a lattice node, the same for all nodes.

use super::numbers::{ChunkLanes, GridNumber};
use crate::lanes::vector;
use crate::operator::fast_law::FixedBond;
use crate::space::Lattice;

/// A bond of the stencil with the data read by the loops.
#[derive(Debug, Clone, Copy)]
pub(in crate::operator) struct Offset<N, const D: usize> {
    /// Distance in places of a padded array from a node to its neighbour.
    pub shift: isize,
    /// ξ in units of length: m or spacings.
    pub xi: [N; D],
    /// 1/|ξ|² per unit squared.
    pub inverse_square: N,
    /// c α κ V, N/m³.
    pub stiffness: N,
    /// c α κ V/|ξ|, N/m³ per unit.
    pub factor: N,
}

impl<N: GridNumber, const D: usize> Offset<N, D> {
    /// Returns the bond in all lanes.
    #[inline(always)]
    pub(super) fn lanes<T: ChunkLanes<Number = N>>(&self) -> FixedBond<T, D> {
        FixedBond {
            xi: vector(|c| T::broadcast(self.xi[c])),
            inverse_square: T::broadcast(self.inverse_square),
            stiffness: T::broadcast(self.stiffness),
            factor: T::broadcast(self.factor),
        }
    }
}

/// The bonds of a node within reach, in ascending order of the index of the neighbour. The opposite of offset
/// k is offset `len() − 1 − k`.
///
/// Offsets that exceed the bounding box of the lattice are omitted, so that small bodies have small stencils.
#[derive(Debug, Clone)]
pub(in crate::operator) struct Stencil<const D: usize> {
    /// Offset of the neighbour, in spacings.
    cells: Vec<[i32; 3]>,
    /// |ξ|, m.
    lengths: Vec<f64>,
    /// κ V of the neighbour, m³.
    volumes: Vec<f64>,
    offsets: Vec<Offset<f64, D>>,
}

/// Rule for the entries of a stencil.
pub(in crate::operator) struct BondRule<'a> {
    /// Largest length of a bond, m.
    pub reach: f64,
    /// κ V of a bond of a given length, m³.
    pub volume: &'a dyn Fn(f64) -> f64,
    /// c α of a bond with a given vector ξ, m.
    pub stiffness: &'a dyn Fn([f64; 3]) -> f64,
}

impl<const D: usize> Stencil<D> {
    /// Creates the stencil of a lattice whose nodes are stored with the given strides per axis.
    pub fn new(lattice: &Lattice, strides: [usize; 3], rule: &BondRule<'_>) -> Self {
        let mut stencil = Self {
            cells: Vec::new(),
            lengths: Vec::new(),
            volumes: Vec::new(),
            offsets: Vec::new(),
        };
        let range = |c: usize| {
            let most = (rule.reach / lattice.spacing[c] * (1.0 + 1e-9)).floor() as i64;
            let n = most.min(lattice.shape[c] as i64 - 1) as i32;
            -n..=n
        };
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let cell = [x, y, z];
                    let xi = lattice.vector(cell);
                    let length = (xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]).sqrt();
                    if cell != [0; 3] && length <= rule.reach {
                        stencil.push(cell, xi, length, strides, rule);
                    }
                }
            }
        }
        stencil
    }

    fn push(
        &mut self,
        cell: [i32; 3],
        xi: [f64; 3],
        length: f64,
        strides: [usize; 3],
        rule: &BondRule<'_>,
    ) {
        let volume = (rule.volume)(length);
        let stiffness = (rule.stiffness)(xi) * volume;
        let shift = (0..3).map(|c| cell[c] as isize * strides[c] as isize).sum();
        self.cells.push(cell);
        self.lengths.push(length);
        self.volumes.push(volume);
        self.offsets.push(Offset {
            shift,
            xi: std::array::from_fn(|c| xi[c]),
            inverse_square: 1.0 / (length * length),
            stiffness,
            factor: stiffness / length,
        });
    }

    /// Returns the number of offsets.
    pub fn len(&self) -> usize {
        self.offsets.len()
    }

    /// Returns the opposite offset, from the neighbour to the node.
    pub fn opposite(&self, k: usize) -> usize {
        self.len() - 1 - k
    }

    /// Returns the offsets of the neighbours, in spacings.
    pub fn cells(&self) -> &[[i32; 3]] {
        &self.cells
    }

    /// Returns the reference lengths, m.
    pub fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// Returns κ V of the neighbours, m³.
    pub fn volumes(&self) -> &[f64] {
        &self.volumes
    }

    /// Returns the data read by the loops.
    pub fn offsets(&self) -> &[Offset<f64, D>] {
        &self.offsets
    }

    /// Returns the offsets in floats, with cells of the given sides in units of length. If the sides are one,
    /// ξ consists of integers, which floats represent exactly.
    pub fn offsets_in_floats(&self, sides: [f64; 3]) -> Vec<Offset<f32, D>> {
        let rounded = |(offset, cell): (&Offset<f64, D>, &[i32; 3])| {
            let xi: [f64; D] = std::array::from_fn(|c| f64::from(cell[c]) * sides[c]);
            let square = xi.iter().map(|x| x * x).sum::<f64>();
            Offset {
                shift: offset.shift,
                xi: xi.map(f32::rounded),
                inverse_square: f32::rounded(1.0 / square),
                stiffness: f32::rounded(offset.stiffness),
                factor: f32::rounded(offset.stiffness / square.sqrt()),
            }
        };
        self.offsets.iter().zip(&self.cells).map(rounded).collect()
    }

    /// Returns the largest distance of a neighbour, in places.
    pub fn farthest_shift(&self) -> usize {
        let shift = |offset: &Offset<f64, D>| offset.shift.unsigned_abs();
        self.offsets.iter().map(shift).max().unwrap_or(0)
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

    fn stencil(shape: [usize; 3], reach: f64) -> Stencil<3> {
        let lattice = Lattice {
            spacing: [1.0; 3],
            shape,
            node: vec![],
        };
        let strides = [1, shape[0], shape[0] * shape[1]];
        let rule = BondRule {
            reach,
            volume: &|_| 1.0,
            stiffness: &|_| 1.0,
        };
        Stencil::new(&lattice, strides, &rule)
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
