//! The loops of the grid operator, one text for every law, dimension and instruction set.
//!
//! Eight nodes of a row are computed side by side: all offsets of the stencil in turn, the forces staying in registers. A byte per chunk
//! and offset says which of the eight bonds are there; it stands for holes, boundaries, pre-cracks and damage alike. Bonds that are not there
//! are computed from whatever lies at their place and masked out.

use super::block::{ChunkBlock, scatter};
use super::breaking::{GridBreaking, break_chunk};
use super::layout::Chunk;
use super::stencil::Offset;
use crate::family::LANES;
use crate::operator::damage::Tally;
use crate::operator::fast_law::FastLaw;
use crate::operator::lanes::{InstructionSet, Lanes, for_each_instruction_set, vector};

/// Read-only arrays as the loops see them.
pub(super) struct Grid<'a, const D: usize> {
    pub offsets: &'a [Offset<D>],
    /// Displacement (or another vector) in padded rows.
    pub u: [&'a [f64]; D],
    /// Unused places before the first row.
    pub margin: usize,
}

impl<const D: usize> Grid<'_, D> {
    #[inline(always)]
    pub(super) fn place(&self, chunk: &Chunk) -> usize {
        self.margin + chunk.place as usize * LANES
    }

    #[inline(always)]
    pub(super) fn here<T: Lanes>(&self, place: usize) -> [T; D] {
        vector(|c| T::load(self.u[c], place))
    }

    /// η of eight bonds.
    #[inline(always)]
    pub(super) fn eta<T: Lanes>(&self, place: usize, shift: isize, here: &[T; D]) -> [T; D] {
        let there = place.wrapping_add_signed(shift);
        let mut eta = *here;
        for c in 0..D {
            eta[c] = T::load(self.u[c], there) - here[c];
        }
        eta
    }
}

/// ξ of an offset in all lanes.
#[inline(always)]
pub(super) fn xi<T: Lanes, const D: usize>(offset: &Offset<D>) -> [T; D] {
    vector(|c| T::splat(offset.xi[c]))
}

/// Forces of a chunk in the fast form, and the range of the strains t they were computed from.
struct Fast<T, const D: usize> {
    sum: [T; D],
    largest: T,
    smallest: T,
}

#[inline(always)]
fn fast_force<T: Lanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, D>,
    place: usize,
    intact: &[u8],
) -> Fast<T, D> {
    let here = grid.here::<T>(place);
    let zero = T::splat(0.0);
    let mut fast = Fast {
        sum: [zero; D],
        largest: zero,
        smallest: zero,
    };
    let intact = &intact[..grid.offsets.len()];
    // No adapter here: one that is not inlined would pass all registers through memory.
    for k in 0..grid.offsets.len() {
        let (offset, mask) = (&grid.offsets[k], intact[k]);
        if mask == 0 {
            continue;
        }
        let eta = grid.eta(place, offset.shift, &here);
        let bond = offset.lanes::<T>();
        let t = L::strain(&bond, eta).masked(mask);
        fast.largest = t.max(fast.largest);
        fast.smallest = t.min(fast.smallest);
        L::add_force(&bond, eta, t, mask, &mut fast.sum);
    }
    fast
}

/// Forces of a chunk by the law itself, however large the strains.
#[inline(always)]
fn exact_force<T: Lanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, D>,
    place: usize,
    intact: &[u8],
) -> [T; D] {
    let here = grid.here::<T>(place);
    let mut sum = [T::splat(0.0); D];
    let intact = &intact[..grid.offsets.len()];
    for k in 0..grid.offsets.len() {
        let (offset, mask) = (&grid.offsets[k], intact[k]);
        let eta = grid.eta(place, offset.shift, &here);
        let force = L::force(xi(offset), eta);
        for c in 0..D {
            sum[c] = sum[c] + (T::splat(offset.stiffness) * force[c]).masked(mask);
        }
    }
    sum
}

/// Forces of a chunk. A lane takes the exact form if one of its own bonds is strained beyond the fast form's reach, so that a point's force
/// does not depend on which other points are computed beside it.
#[inline(always)]
fn chunk_force<T: Lanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, D>,
    place: usize,
    intact: &[u8],
    fast: Fast<T, D>,
) -> [T; D] {
    let reach = T::splat(L::REACH);
    let beyond = fast.largest.greater(reach) | (-fast.smallest).greater(reach);
    if beyond == 0 {
        return fast.sum;
    }
    let exact = exact_force::<T, L, D>(grid, place, intact);
    let mut sum = fast.sum;
    for c in 0..D {
        // One of the two is zero in every lane.
        sum[c] = exact[c].masked(beyond) + fast.sum[c].masked(!beyond);
    }
    sum
}

#[inline(always)]
fn force_chunks_body<T: Lanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, D>,
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; D],
) {
    let m = grid.offsets.len();
    for (k, chunk) in block.chunks.iter().enumerate() {
        let lanes = block.wanted(k);
        if lanes == 0 {
            continue;
        }
        let intact = &intact[k * m..(k + 1) * m];
        let place = grid.place(chunk);
        let fast = fast_force::<T, L, D>(grid, place, intact);
        let sum = chunk_force::<T, L, D>(grid, place, intact, fast);
        for c in 0..D {
            scatter(sum[c].to_array(), chunk, lanes, block.first_point, out[c]);
        }
    }
}

/// t above which a chunk is looked at bond by bond: below the threshold by more than the fast form's rounding.
const WATCH: f64 = 1.0 - 1e-9;

#[inline(always)]
fn accept_chunks_body<T: Lanes, L: FastLaw, const D: usize, const FORCE: bool>(
    grid: &Grid<'_, D>,
    rule: &GridBreaking<'_, D>,
    block: &ChunkBlock<'_>,
    intact: &mut [u8],
    out: &mut [&mut [f64]; D],
    tally: &mut Tally,
) {
    let m = grid.offsets.len();
    let watch = T::splat(rule.threshold * WATCH);
    for (k, chunk) in block.chunks.iter().enumerate() {
        let lanes = block.wanted(k);
        if lanes == 0 {
            continue;
        }
        let intact = &mut intact[k * m..(k + 1) * m];
        let place = grid.place(chunk);
        let mut fast = fast_force::<T, L, D>(grid, place, intact);
        if fast.largest.greater(watch) & lanes != 0 {
            let entry = (block.first_chunk + k) * m;
            if break_chunk::<T, L, D>(grid, rule, chunk, lanes, intact, entry, tally) {
                fast = fast_force::<T, L, D>(grid, place, intact);
            }
        }
        if FORCE {
            let sum = chunk_force::<T, L, D>(grid, place, intact, fast);
            for c in 0..D {
                scatter(sum[c].to_array(), chunk, lanes, block.first_point, out[c]);
            }
        }
    }
}

#[inline(always)]
fn energy_chunks_body<T: Lanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, D>,
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; 1],
) {
    let m = grid.offsets.len();
    for (k, chunk) in block.chunks.iter().enumerate() {
        let place = grid.place(chunk);
        let here = grid.here::<T>(place);
        let mut sum = T::splat(0.0);
        let intact = &intact[k * m..(k + 1) * m];
        for k in 0..m {
            let (offset, mask) = (&grid.offsets[k], intact[k]);
            let eta = grid.eta(place, offset.shift, &here);
            let energy = L::energy(xi(offset), eta);
            sum = sum + (T::splat(0.5 * offset.stiffness) * energy).masked(mask);
        }
        scatter(
            sum.to_array(),
            chunk,
            chunk.lanes,
            block.first_point,
            out[0],
        );
    }
}

#[inline(always)]
fn tangent_chunks_body<T: Lanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, D>,
    direction: &Grid<'_, D>,
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; D],
) {
    let m = grid.offsets.len();
    for (k, chunk) in block.chunks.iter().enumerate() {
        let place = grid.place(chunk);
        let here = grid.here::<T>(place);
        let direction_here = direction.here::<T>(place);
        let mut sum = [T::splat(0.0); D];
        let intact = &intact[k * m..(k + 1) * m];
        for k in 0..m {
            let (offset, mask) = (&grid.offsets[k], intact[k]);
            let eta = grid.eta(place, offset.shift, &here);
            let d = direction.eta(place, offset.shift, &direction_here);
            let force = L::tangent(xi(offset), eta, d);
            for c in 0..D {
                sum[c] = sum[c] + (T::splat(offset.stiffness) * force[c]).masked(mask);
            }
        }
        for c in 0..D {
            scatter(
                sum[c].to_array(),
                chunk,
                chunk.lanes,
                block.first_point,
                out[c],
            );
        }
    }
}

for_each_instruction_set! {
    /// Adds the force density of the wanted points to `out` (indexed from the block's first point).
    pub(super) fn force_chunks [L: FastLaw, const D: usize] <L, D> (
        grid: &Grid<'_, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; D],
    ) = force_chunks_body on lanes
}

for_each_instruction_set! {
    /// Breaks over-stretched bonds of the wanted points and, with FORCE, adds the force density of those that are left.
    pub(super) fn accept_chunks [L: FastLaw, const D: usize, const FORCE: bool] <L, D, FORCE> (
        grid: &Grid<'_, D>,
        rule: &GridBreaking<'_, D>,
        block: &ChunkBlock<'_>,
        intact: &mut [u8],
        out: &mut [&mut [f64]; D],
        tally: &mut Tally,
    ) = accept_chunks_body on lanes
}

for_each_instruction_set! {
    /// Adds the energy density of all points to `out`.
    pub(super) fn energy_chunks [L: FastLaw, const D: usize] <L, D> (
        grid: &Grid<'_, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; 1],
    ) = energy_chunks_body on lanes
}

for_each_instruction_set! {
    /// Adds the derivative of the force density in a direction to `out`.
    pub(super) fn tangent_chunks [L: FastLaw, const D: usize] <L, D> (
        grid: &Grid<'_, D>,
        direction: &Grid<'_, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; D],
    ) = tangent_chunks_body on lanes
}
