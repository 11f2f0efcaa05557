//! Loops of linear peridynamic solids on a lattice: both passes, generic over dimension and instruction set.
//!
//! Eight nodes of a row are computed together, all offsets of the stencil in turn. The pass over points
//! computes dilatations; the pass over bonds reads p = A θ/m and s = B/m of both ends. A lane uses the exact
//! law if the strain of one of its own bonds exceeds the range of the fast form, so that the values of a
//! point do not depend on which other points are computed with it.
//!
//! No closures or adapters here: without inlining they would use baseline instructions.

use super::arrays::Arrays;
use super::breaking::{ChunkBonds, StencilRule, break_chunk};
use crate::lanes::{LANES, Lanes, for_each_instruction_set};
use crate::neighbourhood::Chunk;
use crate::neighbourhood::Tally;
use crate::operator::grid::block::{ChunkBlock, scatter};
use crate::operator::state_based::kinematics::Kinematics;

/// Σ ω r e of eight points, and the range of their strains t.
struct Extension<T> {
    sum: T,
    largest: T,
    smallest: T,
}

#[inline(always)]
fn extension<T: Lanes, L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    place: usize,
    intact: &[u8],
) -> Extension<T> {
    let here = arrays.here::<T>(place);
    let zero = T::splat(0.0);
    let mut extension = Extension {
        sum: zero,
        largest: zero,
        smallest: zero,
    };
    let intact = &intact[..arrays.offsets.len()];
    for k in 0..arrays.offsets.len() {
        let (offset, mask) = (&arrays.offsets[k], intact[k]);
        if mask == 0 {
            continue;
        }
        let bonds = arrays.bonds(place, offset, &here);
        let t = L::strain(bonds.xi, bonds.eta, bonds.inverse_square).masked(mask);
        extension.largest = t.max(extension.largest);
        extension.smallest = t.min(extension.smallest);
        extension.sum = T::splat(offset.weighted_square).mul_add(L::stretch(t), extension.sum);
    }
    extension
}

/// Returns Σ ω r e by the exact law, for any strains.
#[inline(always)]
fn exact_extension<T: Lanes, L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    place: usize,
    intact: &[u8],
) -> T {
    let here = arrays.here::<T>(place);
    let mut sum = T::splat(0.0);
    for k in 0..arrays.offsets.len() {
        let (offset, mask) = (&arrays.offsets[k], intact[k]);
        let bonds = arrays.bonds(place, offset, &here);
        let t = L::strain(bonds.xi, bonds.eta, bonds.inverse_square).masked(mask);
        sum = T::splat(offset.weighted_square).mul_add(L::exact_stretch(t), sum);
    }
    sum
}

/// Selects the fast or exact form by the strains of each lane.
#[inline(always)]
fn settled<T: Lanes, L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    place: usize,
    intact: &[u8],
    extension: Extension<T>,
) -> T {
    let reach = T::splat(L::REACH);
    let beyond = extension.largest.greater(reach) | (-extension.smallest).greater(reach);
    if beyond == 0 {
        return extension.sum;
    }
    let exact = exact_extension::<T, L, D>(arrays, place, intact);
    // One of both terms is zero in each lane.
    exact.masked(beyond) + extension.sum.masked(!beyond)
}

/// Sets the values of the requested lanes times the factors of their points.
#[inline(always)]
fn set(
    numbers: [f64; LANES],
    chunk: &Chunk,
    lanes: u8,
    factors: &[f64],
    first_point: usize,
    out: &mut [f64],
) {
    let mut point = chunk.point as usize;
    for k in 0..LANES {
        if lanes >> k & 1 == 1 {
            out[point - first_point] = factors[point] * numbers[k];
        }
        point += usize::from(chunk.lanes >> k & 1);
    }
}

#[inline(always)]
fn dilatation_chunks_body<T: Lanes, L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    factors: &[f64],
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; 1],
) {
    let (arrays, m) = (&arrays.alike(), arrays.offsets.len());
    for number in 0..block.chunks.len() {
        let lanes = block.wanted(number);
        if lanes == 0 {
            continue;
        }
        let chunk = &block.chunks[number];
        let intact = &intact[number * m..(number + 1) * m];
        let place = arrays.place(chunk);
        let extension = extension::<T, L, D>(arrays, place, intact);
        let sum = settled::<T, L, D>(arrays, place, intact, extension);
        let sum = sum.to_array();
        set(sum, chunk, lanes, factors, block.first_point, out[0]);
    }
}

/// Fraction of the threshold above which bonds of a chunk are checked individually; the margin exceeds the
/// rounding error of the fast form.
const WATCH: f64 = 1.0 - 1e-9;

#[inline(always)]
fn accept_chunks_body<T: Lanes, L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    rule: &StencilRule<'_>,
    block: &ChunkBlock<'_>,
    intact: &mut [u8],
    out: &mut [&mut [f64]; 1],
    tally: &mut Tally,
) {
    let (arrays, m) = (&arrays.alike(), arrays.offsets.len());
    let watch = T::splat(rule.threshold * WATCH);
    for number in 0..block.chunks.len() {
        let lanes = block.wanted(number);
        if lanes == 0 {
            continue;
        }
        let chunk = &block.chunks[number];
        let intact = &mut intact[number * m..(number + 1) * m];
        let place = arrays.place(chunk);
        // Repeated if bonds have broken. A loop gives the compiler a single copy of the body.
        let extension = loop {
            let extension = extension::<T, L, D>(arrays, place, intact);
            let endangered = extension.largest.greater(watch) & lanes;
            let bonds = ChunkBonds {
                chunk,
                lanes: endangered,
                number: block.first_chunk + number,
            };
            if endangered == 0 || !break_chunk::<L, D>(arrays, rule, bonds, intact, tally) {
                break extension;
            }
        };
        let sum = settled::<T, L, D>(arrays, place, intact, extension);
        let (sum, factors) = (sum.to_array(), &rule.states.dilatation);
        set(sum, chunk, lanes, factors, block.first_point, out[0]);
    }
}

/// Returns the forces on eight points by the exact law, for any strains.
#[inline(always)]
fn exact_force<T: Lanes, L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    place: usize,
    intact: &[u8],
) -> [T; D] {
    let here = arrays.here::<T>(place);
    let p = T::load(arrays.pressure, place);
    let s = T::load(arrays.stiffness, place);
    let mut force = [T::splat(0.0); D];
    for k in 0..arrays.offsets.len() {
        let (offset, mask) = (&arrays.offsets[k], intact[k]);
        let there = place.wrapping_add_signed(offset.shift);
        let bonds = arrays.bonds(place, offset, &here);
        let t = L::strain(bonds.xi, bonds.eta, bonds.inverse_square).masked(mask);
        let p = p + T::load(arrays.pressure, there);
        let s = s + T::load(arrays.stiffness, there);
        let pull = (T::splat(offset.weight) * L::exact_pull(t, p, s)).masked(mask);
        let direction = L::direction(bonds.xi, bonds.eta);
        for c in 0..D {
            force[c] = pull.mul_add(direction[c], force[c]);
        }
    }
    force
}

#[inline(always)]
fn force_chunks_body<T: Lanes, L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; D],
) {
    let (arrays, m) = (&arrays.alike(), arrays.offsets.len());
    for number in 0..block.chunks.len() {
        let lanes = block.wanted(number);
        if lanes == 0 {
            continue;
        }
        let chunk = &block.chunks[number];
        let intact = &intact[number * m..(number + 1) * m];
        let place = arrays.place(chunk);
        let here = arrays.here::<T>(place);
        let p = T::load(arrays.pressure, place);
        let s = T::load(arrays.stiffness, place);
        let (mut force, mut largest) = ([T::splat(0.0); D], T::splat(0.0));
        for k in 0..m {
            let (offset, mask) = (&arrays.offsets[k], intact[k]);
            if mask == 0 {
                continue;
            }
            let there = place.wrapping_add_signed(offset.shift);
            let bonds = arrays.bonds(place, offset, &here);
            let t = L::strain(bonds.xi, bonds.eta, bonds.inverse_square).masked(mask);
            if L::REACH.is_finite() {
                largest = (t * t).max(largest);
            }
            let p = p + T::load(arrays.pressure, there);
            let s = s + T::load(arrays.stiffness, there);
            let pull = (T::splat(offset.weight) * L::pull(t, p, s)).masked(mask);
            let direction = L::direction(bonds.xi, bonds.eta);
            for c in 0..D {
                force[c] = pull.mul_add(direction[c], force[c]);
            }
        }
        let beyond = largest.greater(T::splat(L::REACH * L::REACH));
        if beyond != 0 {
            let exact = exact_force::<T, L, D>(arrays, place, intact);
            for c in 0..D {
                // One of both terms is zero in each lane.
                force[c] = exact[c].masked(beyond) + force[c].masked(!beyond);
            }
        }
        for c in 0..D {
            let numbers = force[c].to_array();
            scatter(numbers, chunk, lanes, block.first_point, out[c]);
        }
    }
}

#[inline(always)]
fn square_chunks_body<T: Lanes, L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; 1],
) {
    let (arrays, m) = (&arrays.alike(), arrays.offsets.len());
    for number in 0..block.chunks.len() {
        let chunk = &block.chunks[number];
        let intact = &intact[number * m..(number + 1) * m];
        let place = arrays.place(chunk);
        let here = arrays.here::<T>(place);
        let mut sum = T::splat(0.0);
        for k in 0..m {
            let (offset, mask) = (&arrays.offsets[k], intact[k]);
            let bonds = arrays.bonds(place, offset, &here);
            let stretch = L::exact_stretch(L::strain(bonds.xi, bonds.eta, bonds.inverse_square));
            let square = T::splat(offset.weighted_square) * stretch * stretch;
            sum = sum + square.masked(mask);
        }
        let numbers = sum.to_array();
        scatter(numbers, chunk, chunk.lanes, block.first_point, out[0]);
    }
}

for_each_instruction_set! {
    /// Sets the dilatations of the requested points (indexed from the first point of the block): `factors`
    /// (D/m of each point) times Σ ω r e.
    pub(super) fn dilatation_chunks [L: Kinematics, const D: usize] <L, D> (
        arrays: &Arrays<'_, D>,
        factors: &[f64],
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; 1],
    ) = dilatation_chunks_body on lanes
}

for_each_instruction_set! {
    /// Breaks over-stretched bonds of the requested points and sets the dilatations from the intact bonds.
    pub(super) fn accept_chunks [L: Kinematics, const D: usize] <L, D> (
        arrays: &Arrays<'_, D>,
        rule: &StencilRule<'_>,
        block: &ChunkBlock<'_>,
        intact: &mut [u8],
        out: &mut [&mut [f64]; 1],
        tally: &mut Tally,
    ) = accept_chunks_body on lanes
}

for_each_instruction_set! {
    /// Adds the force density of the requested points to `out`.
    pub(super) fn force_chunks [L: Kinematics, const D: usize] <L, D> (
        arrays: &Arrays<'_, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; D],
    ) = force_chunks_body on lanes
}

for_each_instruction_set! {
    /// Adds Σ ω e² of all points to `out`.
    pub(super) fn square_chunks [L: Kinematics, const D: usize] <L, D> (
        arrays: &Arrays<'_, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; 1],
    ) = square_chunks_body on lanes
}
