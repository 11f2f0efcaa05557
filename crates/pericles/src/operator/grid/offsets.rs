//! Bonds of a stencil with the data read by the loops.

use super::numbers::{ChunkLanes, GridNumber};
use crate::lanes::vector;
use crate::neighbourhood::Stencil;
use crate::operator::fast_law::FixedBond;

/// A bond of the stencil with the data read by the loops.
#[derive(Debug, Clone, Copy)]
pub(super) struct Offset<N, const D: usize> {
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

/// Returns the offsets of a stencil with the stiffness c α as a function of ξ, m.
pub(super) fn offsets<const D: usize>(
    stencil: &Stencil,
    stiffness: &dyn Fn([f64; 3]) -> f64,
) -> Vec<Offset<f64, D>> {
    let offset = |k: usize| {
        let (xi, length) = (stencil.vectors()[k], stencil.lengths()[k]);
        let stiffness = stiffness(xi) * stencil.volumes()[k];
        Offset {
            shift: stencil.shifts()[k],
            xi: std::array::from_fn(|c| xi[c]),
            inverse_square: 1.0 / (length * length),
            stiffness,
            factor: stiffness / length,
        }
    };
    (0..stencil.len()).map(offset).collect()
}

/// Returns offsets in floats, with cells of the given sides in units of length. If the sides are one, ξ consists of
/// integers, which floats represent exactly.
pub(super) fn in_floats<const D: usize>(
    stencil: &Stencil,
    offsets: &[Offset<f64, D>],
    sides: [f64; 3],
) -> Vec<Offset<f32, D>> {
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
    offsets.iter().zip(stencil.cells()).map(rounded).collect()
}
