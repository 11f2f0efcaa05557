//! The loops of the grid operator, one text for every law, dimension and instruction set.
//!
//! Eight nodes of a row are computed side by side, in floats sixteen of two rows: all offsets of the stencil in turn, the forces staying in registers. A byte per chunk
//! and offset says which of the eight bonds are there; it stands for holes, boundaries, pre-cracks and damage alike. Bonds that are not there
//! are computed from whatever lies at their place and masked out.

use super::arrays::Grid;
use super::block::{ChunkBlock, scatter};
use super::breaking::{ChunkBonds, GridBreaking, break_chunk};
use super::layout::Chunk;
use super::numbers::ChunkLanes;
use crate::lanes::{Lanes, for_each_instruction_set};
use crate::operator::damage::Tally;
use crate::operator::fast_law::FastLaw;

/// Forces of chunks in the fast form, and the range of the strains t they were computed from.
struct Fast<T, const D: usize> {
    sum: [T; D],
    largest: T,
    smallest: T,
}

#[inline(always)]
fn fast_force<T: ChunkLanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, T::Number, D>,
    places: T::Places,
    factors: Option<T::Places>,
    intact: &[u8],
) -> Fast<T, D> {
    let here = grid.here::<T>(places);
    let zero = T::splat(0.0);
    let mut fast = Fast {
        sum: [zero; D],
        largest: zero,
        smallest: zero,
    };
    let bonds = T::bonds(intact, grid.offsets.len());
    // No adapter here: one that is not inlined would pass all registers through memory.
    for k in 0..grid.offsets.len() {
        let (offset, mask) = (&grid.offsets[k], T::present(bonds, k));
        if T::none(mask) {
            continue;
        }
        let eta = grid.eta(places, offset.shift, &here);
        let bond = grid.bonds::<T>(k, factors);
        let t = L::strain(&bond, eta).masked(mask);
        fast.largest = t.max(fast.largest);
        fast.smallest = t.min(fast.smallest);
        L::add_force(&bond, eta, t, mask, &mut fast.sum);
    }
    fast
}

/// Forces of chunks by the law itself, however large the strains.
#[inline(always)]
fn exact_force<T: ChunkLanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, T::Number, D>,
    places: T::Places,
    factors: Option<T::Places>,
    intact: &[u8],
) -> [T; D] {
    let here = grid.here::<T>(places);
    let mut sum = [T::splat(0.0); D];
    let bonds = T::bonds(intact, grid.offsets.len());
    for k in 0..grid.offsets.len() {
        let (offset, mask) = (&grid.offsets[k], T::present(bonds, k));
        let eta = grid.eta(places, offset.shift, &here);
        let bond = grid.bonds::<T>(k, factors);
        let force = L::force(bond.xi, eta);
        for c in 0..D {
            sum[c] = sum[c] + (bond.stiffness * force[c]).masked(mask);
        }
    }
    sum
}

/// Forces of chunks. A lane takes the exact form if one of its own bonds is strained beyond the fast form's reach, so that a point's force
/// does not depend on which other points are computed beside it.
#[inline(always)]
fn chunk_force<T: ChunkLanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, T::Number, D>,
    places: T::Places,
    factors: Option<T::Places>,
    intact: &[u8],
    fast: Fast<T, D>,
) -> [T; D] {
    let reach = T::splat(L::REACH);
    let beyond = T::either(fast.largest.greater(reach), (-fast.smallest).greater(reach));
    if T::none(beyond) {
        return fast.sum;
    }
    let exact = exact_force::<T, L, D>(grid, places, factors, intact);
    let mut sum = fast.sum;
    for c in 0..D {
        // One of the two is zero in every lane.
        sum[c] = exact[c].masked(beyond) + fast.sum[c].masked(T::others(beyond));
    }
    sum
}

/// Which lanes of the chunks taken together are wanted, and whether any is.
#[inline(always)]
fn wanted<T: ChunkLanes>(block: &ChunkBlock<'_>, first: usize, count: usize) -> ([u8; 2], bool) {
    let mut lanes = [0; 2];
    for c in 0..count {
        lanes[c] = block.wanted(first + c);
    }
    (lanes, lanes != [0; 2])
}

/// Adds the forces of chunks taken together to their points.
#[inline(always)]
fn add_to_points<T: ChunkLanes, const D: usize>(
    sum: [T; D],
    chunks: &[Chunk],
    lanes: [u8; 2],
    first_point: usize,
    out: &mut [&mut [f64]; D],
) {
    for (number, chunk) in chunks.iter().enumerate() {
        if lanes[number] != 0 {
            for c in 0..D {
                let numbers = sum[c].numbers(number);
                scatter(numbers, chunk, lanes[number], first_point, out[c]);
            }
        }
    }
}

#[inline(always)]
fn force_chunks_body<T: ChunkLanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, T::Number, D>,
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; D],
) {
    let m = grid.offsets.len();
    for first in (0..block.chunks.len()).step_by(T::CHUNKS) {
        let count = T::CHUNKS.min(block.chunks.len() - first);
        let (lanes, any) = wanted::<T>(block, first, count);
        if !any {
            continue;
        }
        let chunks = &block.chunks[first..first + count];
        let intact = &intact[first * m..(first + count) * m];
        let places = grid.places::<T>(chunks);
        let factors = grid.factors_of::<T>(block.first_chunk + first, count);
        let fast = fast_force::<T, L, D>(grid, places, factors, intact);
        let sum = chunk_force::<T, L, D>(grid, places, factors, intact, fast);
        add_to_points(sum, chunks, lanes, block.first_point, out);
    }
}

/// t above which a chunk is looked at bond by bond: below the threshold by more than the fast form's rounding.
const WATCH: f64 = 1.0 - 1e-9;

#[inline(always)]
fn accept_chunks_body<T: ChunkLanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, T::Number, D>,
    rule: &GridBreaking<'_>,
    block: &ChunkBlock<'_>,
    intact: &mut [u8],
    out: &mut [&mut [f64]; D],
    tally: &mut Tally,
) {
    let m = grid.offsets.len();
    for first in (0..block.chunks.len()).step_by(T::CHUNKS) {
        let count = T::CHUNKS.min(block.chunks.len() - first);
        let (lanes, any) = wanted::<T>(block, first, count);
        if !any {
            continue;
        }
        let chunks = &block.chunks[first..first + count];
        let intact = &mut intact[first * m..(first + count) * m];
        let places = grid.places::<T>(chunks);
        let factors = grid.factors_of::<T>(block.first_chunk + first, count);
        let mut fast = fast_force::<T, L, D>(grid, places, factors, intact);
        let threshold = rule.smallest_threshold(block.first_chunk + first, count);
        let watch = T::splat(threshold * WATCH - T::STRAIN_ERROR);
        let strained = fast.largest.greater(watch);
        if !T::none(strained) {
            let mut broken = false;
            for number in 0..count {
                if T::of_chunk(strained, number) & lanes[number] != 0 {
                    let own = ChunkBonds {
                        chunk: &chunks[number],
                        lanes: lanes[number],
                        intact: &mut intact[number * m..(number + 1) * m],
                        entry: (block.first_chunk + first + number) * m,
                    };
                    broken |= break_chunk::<T::Wide, L, T::Number, D>(grid, rule, own, tally);
                }
            }
            if broken {
                fast = fast_force::<T, L, D>(grid, places, factors, intact);
            }
        }
        let sum = chunk_force::<T, L, D>(grid, places, factors, intact, fast);
        add_to_points(sum, chunks, lanes, block.first_point, out);
    }
}

#[inline(always)]
fn energy_chunks_body<T: Lanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, f64, D>,
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; 1],
) {
    let m = grid.offsets.len();
    for (k, chunk) in block.chunks.iter().enumerate() {
        let place = grid.place(chunk);
        let here = grid.here::<T>(place);
        let factors = grid.factors_of::<T>(block.first_chunk + k, 1);
        let mut sum = T::splat(0.0);
        let intact = &intact[k * m..(k + 1) * m];
        for k in 0..m {
            let (offset, mask) = (&grid.offsets[k], intact[k]);
            let eta = grid.eta(place, offset.shift, &here);
            let bond = grid.bonds::<T>(k, factors);
            let energy = L::energy(bond.xi, eta);
            sum = sum + (T::splat(0.5) * bond.stiffness * energy).masked(mask);
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
    grid: &Grid<'_, f64, D>,
    direction: &Grid<'_, f64, D>,
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; D],
) {
    let m = grid.offsets.len();
    for (k, chunk) in block.chunks.iter().enumerate() {
        let place = grid.place(chunk);
        let here = grid.here::<T>(place);
        let direction_here = direction.here::<T>(place);
        let factors = grid.factors_of::<T>(block.first_chunk + k, 1);
        let mut sum = [T::splat(0.0); D];
        let intact = &intact[k * m..(k + 1) * m];
        for k in 0..m {
            let (offset, mask) = (&grid.offsets[k], intact[k]);
            let eta = grid.eta(place, offset.shift, &here);
            let d = direction.eta(place, offset.shift, &direction_here);
            let force = L::tangent_force(&grid.bonds::<T>(k, factors), eta, d);
            for c in 0..D {
                sum[c] = sum[c] + force[c].masked(mask);
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
        grid: &Grid<'_, f64, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; D],
    ) = force_chunks_body on lanes
}

for_each_instruction_set! {
    /// [`force_chunks`] in floats.
    pub(super) fn force_chunks_in_floats [L: FastLaw, const D: usize] <L, D> (
        grid: &Grid<'_, f32, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; D],
    ) = force_chunks_body on floats
}

for_each_instruction_set! {
    /// Breaks over-stretched bonds of the wanted points and adds the force density of those that are left.
    pub(super) fn accept_chunks [L: FastLaw, const D: usize] <L, D> (
        grid: &Grid<'_, f64, D>,
        rule: &GridBreaking<'_>,
        block: &ChunkBlock<'_>,
        intact: &mut [u8],
        out: &mut [&mut [f64]; D],
        tally: &mut Tally,
    ) = accept_chunks_body on lanes
}

for_each_instruction_set! {
    /// [`accept_chunks`] in floats.
    pub(super) fn accept_chunks_in_floats [L: FastLaw, const D: usize] <L, D> (
        grid: &Grid<'_, f32, D>,
        rule: &GridBreaking<'_>,
        block: &ChunkBlock<'_>,
        intact: &mut [u8],
        out: &mut [&mut [f64]; D],
        tally: &mut Tally,
    ) = accept_chunks_body on floats
}

for_each_instruction_set! {
    /// Adds the energy density of all points to `out`.
    pub(super) fn energy_chunks [L: FastLaw, const D: usize] <L, D> (
        grid: &Grid<'_, f64, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; 1],
    ) = energy_chunks_body on lanes
}

for_each_instruction_set! {
    /// Adds the derivative of the force density in a direction to `out`.
    pub(super) fn tangent_chunks [L: FastLaw, const D: usize] <L, D> (
        grid: &Grid<'_, f64, D>,
        direction: &Grid<'_, f64, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; D],
    ) = tangent_chunks_body on lanes
}
