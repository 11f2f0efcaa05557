//! Loops of the stencil kernel, generic over law, dimension and instruction set.
//!
//! Eight nodes of a row are computed together, in single precision sixteen of two rows: all offsets of the
//! stencil in turn, with forces in registers. A byte per chunk and offset marks the existing bonds of eight
//! nodes; it covers holes, boundaries, pre-cracks and damage. Missing bonds are computed from arbitrary data
//! at their place and masked out.

use super::arrays::Grid;
use super::block::{ChunkBlock, scatter};
use super::breaking::{ChunkBonds, GridBreaking, break_chunk};
use super::numbers::ChunkLanes;
use crate::lanes::{Lanes, for_each_instruction_set};
use crate::neighbourhood::Chunk;
use crate::neighbourhood::Tally;
use crate::operator::fast_law::VectorLaw;

/// Forces of chunks in the fast form, and the range of their strains t.
struct Fast<T, const D: usize> {
    sum: [T; D],
    largest: T,
    smallest: T,
}

#[inline(always)]
fn fast_force<T: ChunkLanes, L: VectorLaw, const D: usize>(
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
    // No iterator adapter here: without inlining it would pass all registers through memory.
    for k in 0..grid.offsets.len() {
        let mask = T::present(bonds, k);
        if T::none(mask) {
            continue;
        }
        let (bond, eta) = grid.pulled::<T>(places, k, factors, &here);
        let t = L::strain(&bond, eta).masked(mask);
        fast.largest = t.max(fast.largest);
        fast.smallest = t.min(fast.smallest);
        L::add_force(&bond, eta, t, mask, &mut fast.sum);
    }
    fast
}

/// Returns the forces of chunks by the exact law, for any strains.
#[inline(always)]
fn exact_force<T: ChunkLanes, L: VectorLaw, const D: usize>(
    grid: &Grid<'_, T::Number, D>,
    places: T::Places,
    factors: Option<T::Places>,
    intact: &[u8],
) -> [T; D] {
    let here = grid.here::<T>(places);
    let mut sum = [T::splat(0.0); D];
    let bonds = T::bonds(intact, grid.offsets.len());
    for k in 0..grid.offsets.len() {
        let mask = T::present(bonds, k);
        let (bond, eta) = grid.pulled::<T>(places, k, factors, &here);
        let force = L::force(bond.xi, eta);
        for c in 0..D {
            sum[c] = sum[c] + (bond.stiffness * force[c]).masked(mask);
        }
    }
    sum
}

/// Returns the forces of chunks. A lane uses the exact law if the strain of one of its own bonds exceeds the
/// range of the fast form, so that the force on a point does not depend on which other points are computed
/// with it.
#[inline(always)]
fn chunk_force<T: ChunkLanes, L: VectorLaw, const D: usize>(
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
        // One of both terms is zero in each lane.
        sum[c] = exact[c].masked(beyond) + fast.sum[c].masked(T::others(beyond));
    }
    sum
}

/// Returns the requested lanes of chunks computed together, and whether there are any.
#[inline(always)]
fn wanted<T: ChunkLanes>(block: &ChunkBlock<'_>, first: usize, count: usize) -> ([u8; 2], bool) {
    let mut lanes = [0; 2];
    for c in 0..count {
        lanes[c] = block.wanted(first + c);
    }
    (lanes, lanes != [0; 2])
}

/// Adds the forces of chunks computed together to their points.
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
fn force_chunks_body<T: ChunkLanes, L: VectorLaw, const D: usize>(
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

/// Fraction of the threshold above which bonds of a chunk are checked individually; the margin exceeds the
/// rounding error of the fast form.
const WATCH: f64 = 1.0 - 1e-9;

#[inline(always)]
fn accept_chunks_body<T: ChunkLanes, L: VectorLaw, const D: usize>(
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
fn energy_chunks_body<T: Lanes, L: VectorLaw, const D: usize>(
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
            let mask = intact[k];
            let (bond, eta) = grid.pulled::<T>(place, k, factors, &here);
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
fn tangent_chunks_body<T: Lanes, L: VectorLaw, const D: usize>(
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
            let (bond, eta) = grid.pulled::<T>(place, k, factors, &here);
            let d = direction.eta(place, offset.shift, &direction_here);
            let force = L::tangent_force(&bond, eta, d);
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
    /// Adds the force density of the requested points to `out` (indexed from the first point of the block).
    pub(super) fn force_chunks [L: VectorLaw, const D: usize] <L, D> (
        grid: &Grid<'_, f64, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; D],
    ) = force_chunks_body on lanes
}

for_each_instruction_set! {
    /// Runs [`force_chunks`] in single precision.
    pub(super) fn force_chunks_in_floats [L: VectorLaw, const D: usize] <L, D> (
        grid: &Grid<'_, f32, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; D],
    ) = force_chunks_body on floats
}

for_each_instruction_set! {
    /// Breaks over-stretched bonds of the requested points and adds the force density of the intact bonds.
    pub(super) fn accept_chunks [L: VectorLaw, const D: usize] <L, D> (
        grid: &Grid<'_, f64, D>,
        rule: &GridBreaking<'_>,
        block: &ChunkBlock<'_>,
        intact: &mut [u8],
        out: &mut [&mut [f64]; D],
        tally: &mut Tally,
    ) = accept_chunks_body on lanes
}

for_each_instruction_set! {
    /// Runs [`accept_chunks`] in single precision.
    pub(super) fn accept_chunks_in_floats [L: VectorLaw, const D: usize] <L, D> (
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
    pub(super) fn energy_chunks [L: VectorLaw, const D: usize] <L, D> (
        grid: &Grid<'_, f64, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; 1],
    ) = energy_chunks_body on lanes
}

for_each_instruction_set! {
    /// Adds the derivative of the force density in a direction to `out`.
    pub(super) fn tangent_chunks [L: VectorLaw, const D: usize] <L, D> (
        grid: &Grid<'_, f64, D>,
        direction: &Grid<'_, f64, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; D],
    ) = tangent_chunks_body on lanes
}
