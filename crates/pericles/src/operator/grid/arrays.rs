//! Arrays of a lattice body as the loops see them.

use super::layout::Chunk;
use super::numbers::{ChunkLanes, GridNumber};
use super::stencil::Offset;
use crate::lanes::{LANES, vector};

/// Read-only arrays as the loops see them.
pub(super) struct Grid<'a, N, const D: usize> {
    pub offsets: &'a [Offset<N, D>],
    /// Displacement (or another vector) in padded rows.
    pub u: [&'a [N]; D],
    /// Unused places before the first row.
    pub margin: usize,
    /// The length that is one in these numbers, m.
    pub unit: f64,
}

impl<N: GridNumber, const D: usize> Grid<'_, N, D> {
    #[inline(always)]
    pub(super) fn place(&self, chunk: &Chunk) -> usize {
        self.margin + chunk.place as usize * LANES
    }

    /// Where the chunks lie that are taken together; at least one.
    #[inline(always)]
    pub(super) fn places<T: ChunkLanes<Number = N>>(&self, chunks: &[Chunk]) -> T::Places {
        T::places(
            self.place(&chunks[0]),
            self.place(&chunks[chunks.len() - 1]),
        )
    }

    #[inline(always)]
    pub(super) fn here<T: ChunkLanes<Number = N>>(&self, places: T::Places) -> [T; D] {
        let mut here = [T::splat(0.0); D];
        for c in 0..D {
            here[c] = T::at(self.u[c], places, 0);
        }
        here
    }

    /// η of the bonds of an offset.
    #[inline(always)]
    pub(super) fn eta<T: ChunkLanes<Number = N>>(
        &self,
        places: T::Places,
        shift: isize,
        here: &[T; D],
    ) -> [T; D] {
        let mut eta = *here;
        for c in 0..D {
            eta[c] = T::at(self.u[c], places, shift) - here[c];
        }
        eta
    }
}

/// ξ of an offset in all lanes.
#[inline(always)]
pub(super) fn xi<T: ChunkLanes, const D: usize>(offset: &Offset<T::Number, D>) -> [T; D] {
    vector(|c| T::broadcast(offset.xi[c]))
}
