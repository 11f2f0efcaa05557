//! Arrays of a lattice body read by the loops.

use super::factors::Factors;
use super::numbers::{ChunkLanes, GridNumber};
use super::offsets::Offset;
use crate::lanes::LANES;
use crate::neighbourhood::Chunk;
use crate::operator::fast_law::FixedBond;

/// Read-only arrays of the loops.
pub(super) struct Grid<'a, N, const D: usize> {
    pub offsets: &'a [Offset<N, D>],
    /// Stiffness of bonds relative to their offset, if it depends on their ends.
    pub factors: Option<&'a Factors<N>>,
    /// Displacement (or another vector) in padded rows.
    pub u: [&'a [N]; D],
    /// Thermal stretch of sites in padded rows, if the material expands.
    pub heat: Option<&'a [N]>,
    /// Number of unused places before the first row.
    pub margin: usize,
    /// Unit of length, m.
    pub unit: f64,
}

impl<N: GridNumber, const D: usize> Grid<'_, N, D> {
    #[inline(always)]
    pub(super) fn place(&self, chunk: &Chunk) -> usize {
        self.margin + chunk.place as usize * LANES
    }

    /// Returns the places of the chunks computed together; at least one.
    #[inline(always)]
    pub(super) fn places<T: ChunkLanes<Number = N>>(&self, chunks: &[Chunk]) -> T::Places {
        T::places(
            self.place(&chunks[0]),
            self.place(&chunks[chunks.len() - 1]),
        )
    }

    /// Returns the first entries of the factors of chunks computed together; `None` if all their bonds have
    /// the stiffness of the offset.
    #[inline(always)]
    pub(super) fn factors_of<T: ChunkLanes<Number = N>>(
        &self,
        first_chunk: usize,
        count: usize,
    ) -> Option<T::Places> {
        let [first, last] = self.factors?.places(first_chunk, count)?;
        Some(T::places(first, last))
    }

    /// Returns the bonds of an offset with the factors at the given entries.
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

    /// Returns the bonds of an offset with their stress-free lengths, and their η relative to them.
    #[inline(always)]
    pub(super) fn pulled<T: ChunkLanes<Number = N>>(
        &self,
        places: T::Places,
        offset: usize,
        factors: Option<T::Places>,
        here: &[T; D],
    ) -> (FixedBond<T, D>, [T; D]) {
        let shift = self.offsets[offset].shift;
        let (bonds, eta) = (
            self.bonds::<T>(offset, factors),
            self.eta(places, shift, here),
        );
        match self.heat {
            None => (bonds, eta),
            Some(heat) => {
                let both = T::at(heat, places, 0) + T::at(heat, places, shift);
                bonds.expanded(T::splat(0.5) * both, eta)
            }
        }
    }

    /// Returns the mean thermal stretch of the bond between two places.
    pub(super) fn thermal(&self, [here, there]: [usize; 2]) -> f64 {
        let of = |heat: &[N]| -> f64 { heat[here].into() + heat[there].into() };
        self.heat.map_or(0.0, |heat| 0.5 * of(heat))
    }

    /// Returns the stiffness of the bond of an offset and lane of a chunk, N/m³.
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

    /// Returns η of the bonds of an offset.
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
