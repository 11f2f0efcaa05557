//! Directional derivatives of both passes.

use super::arrays::{Arrays, Bonds};
use crate::lanes::{Lanes, for_each_instruction_set};
use crate::operator::grid::block::{ChunkBlock, scatter};
use crate::operator::state_based::kernels::stretch_change;
use crate::operator::state_based::kinematics::Kinematics;

#[inline(always)]
fn dilatation_change_chunks_body<T: Lanes, L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    direction: &Arrays<'_, D>,
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; 1],
) {
    let m = arrays.offsets.len();
    for number in 0..block.chunks.len() {
        let chunk = &block.chunks[number];
        let intact = &intact[number * m..(number + 1) * m];
        let place = arrays.place(chunk);
        let here = arrays.here::<T>(place);
        let direction_here = direction.here::<T>(place);
        let mut sum = T::splat(0.0);
        for k in 0..m {
            let (offset, mask) = (&arrays.offsets[k], intact[k]);
            let Bonds {
                xi,
                eta,
                inverse_square,
            } = arrays.bonds(place, offset, &here);
            let d = direction.eta(place, offset.shift, &direction_here);
            let t = L::strain(xi, eta, inverse_square).masked(mask);
            let stretch = stretch_change::<T, L, D>(xi, eta, d, t, inverse_square);
            sum = sum + (T::splat(offset.weighted_square) * stretch).masked(mask);
        }
        let numbers = sum.to_array();
        scatter(numbers, chunk, chunk.lanes, block.first_point, out[0]);
    }
}

#[inline(always)]
fn tangent_chunks_body<T: Lanes, L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    direction: &Arrays<'_, D>,
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; D],
) {
    let m = arrays.offsets.len();
    for number in 0..block.chunks.len() {
        let chunk = &block.chunks[number];
        let intact = &intact[number * m..(number + 1) * m];
        let place = arrays.place(chunk);
        let here = arrays.here::<T>(place);
        let direction_here = direction.here::<T>(place);
        let p = T::load(arrays.pressure, place);
        let s = T::load(arrays.stiffness, place);
        let change = T::load(direction.pressure, place);
        let mut sum = [T::splat(0.0); D];
        for k in 0..m {
            let (offset, mask) = (&arrays.offsets[k], intact[k]);
            let there = place.wrapping_add_signed(offset.shift);
            let Bonds {
                xi,
                eta,
                inverse_square,
            } = arrays.bonds(place, offset, &here);
            let d = direction.eta(place, offset.shift, &direction_here);
            let p = p + T::load(arrays.pressure, there);
            let s = s + T::load(arrays.stiffness, there);
            let change = change + T::load(direction.pressure, there);
            let t = L::strain(xi, eta, inverse_square).masked(mask);
            let stretch = stretch_change::<T, L, D>(xi, eta, d, t, inverse_square);
            let weight = T::splat(offset.weight);
            let along = (weight * L::pull_change(t, p, s, stretch, change)).masked(mask);
            let axis = L::direction(xi, eta);
            for c in 0..D {
                sum[c] = along.mul_add(axis[c], sum[c]);
            }
            if !L::LINEAR {
                let turn = (weight * L::exact_pull(t, p, s)).masked(mask);
                for c in 0..D {
                    sum[c] = turn.mul_add(d[c], sum[c]);
                }
            }
        }
        for c in 0..D {
            let numbers = sum[c].to_array();
            scatter(numbers, chunk, chunk.lanes, block.first_point, out[c]);
        }
    }
}

for_each_instruction_set! {
    /// Adds the derivative of Σ ω r e of all points in a direction to `out`.
    pub(super) fn dilatation_change_chunks [L: Kinematics, const D: usize] <L, D> (
        arrays: &Arrays<'_, D>,
        direction: &Arrays<'_, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; 1],
    ) = dilatation_change_chunks_body on lanes
}

for_each_instruction_set! {
    /// Adds the derivative of the force density of all points in a direction, with its change of p, to `out`.
    pub(super) fn tangent_chunks [L: Kinematics, const D: usize] <L, D> (
        arrays: &Arrays<'_, D>,
        direction: &Arrays<'_, D>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; D],
    ) = tangent_chunks_body on lanes
}
