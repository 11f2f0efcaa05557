//! Arrays of a lattice body as the loops see them.

use super::factors::Factors;
use super::layout::Chunk;
use super::numbers::{ChunkLanes, GridNumber};
use super::stencil::Offset;
use crate::lanes::LANES;
use crate::operator::fast_law::FixedBond;

/// Read-only arrays as the loops see them.
pub(super) struct Grid<'a, N, const D: usize> {
    pub offsets: &'a [Offset<N, D>],
    /// The stiffness of bonds over the offsets', where it depends on their ends.
    pub factors: Option<&'a Factors<N>>,
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

    /// Where the factors of chunks taken together begin; none if all their bonds have the offsets' stiffness.
    #[inline(always)]
    pub(super) fn factors_of<T: ChunkLanes<Number = N>>(
        &self,
        first_chunk: usize,
        count: usize,
    ) -> Option<T::Places> {
        let [first, last] = self.factors?.places(first_chunk, count)?;
        Some(T::places(first, last))
    }

    /// The bonds of an offset, with the factors that begin there.
    #[inline(always)]
    pub(super) fn bonds<T: ChunkLanes<Number = N>>(
        &self,
        offset: usize,
        factors: Option<T::Places>,
    ) -> FixedBond<T, D> {
        let mut bonds = self.offsets[offset].lanes::<T>();
        if let (Some(all), Some(places)) = (self.factors, factors) {
            let factor = T::at(all.values(), places, (offset * LANES) as isize);
            bonds.stiffness = bonds.stiffness * factor;
            bonds.factor = bonds.factor * factor;
        }
        bonds
    }

    /// The stiffness of a chunk's bond of one offset, N/m³.
    pub(super) fn stiffness(&self, chunk: usize, offset: usize, lane: usize) -> f64 {
        let stiffness: f64 = self.offsets[offset].stiffness.into();
        match self.factors {
            None => stiffness,
            Some(factors) => stiffness * factors.of_bond(chunk, offset, lane),
        }
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
