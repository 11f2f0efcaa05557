//! Loops of the stencil kernel: eight nodes of a row at a time, all offsets of the stencil in turn.

use pericles::lanes::{LANES, Lanes, for_each_instruction_set};

use super::Interface;

/// Eight nodes of a row, at least one of which is a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chunk {
    /// Place of the first node.
    pub place: u32,
    /// First point of the chunk.
    pub point: u32,
    /// Nodes that are points.
    pub lanes: u8,
    /// Whether all bonds of all points have the same conductivity and no surface correction.
    pub is_plain: bool,
}

/// The fields and bonds that the loops read; places are shifted by `margin` in fields.
pub(super) struct Stencil<'a> {
    pub values: &'a [f64],
    /// Conductivity at each place, or its inverse for [`Interface::Harmonic`].
    pub material: &'a [f64],
    /// Fields of [`super::surface::SurfaceFactors`] at each place; none if all families are complete.
    pub surface: &'a [Vec<f64>],
    /// Coefficients of the tensors for each offset.
    pub directions: &'a [[f64; 6]],
    pub interface: Interface,
    pub margin: usize,
    pub shifts: &'a [isize],
    /// κ V V of each offset for unit conductivity.
    pub weights: &'a [f64],
    /// Factor of all flows.
    pub scale: f64,
}

#[inline(always)]
fn add_chunks_body<T: Lanes>(
    stencil: &Stencil<'_>,
    chunks: &[Chunk],
    bonds: &[u8],
    first_point: usize,
    out: &mut [f64],
) {
    let m = stencil.shifts.len();
    for number in 0..chunks.len() {
        let chunk = &chunks[number];
        let bonds = &bonds[number * m..(number + 1) * m];
        let at = chunk.place as usize + stencil.margin;
        let here = T::load(stencil.values, at);
        let material = T::load(stencil.material, at);
        let zero = T::splat(0.0);
        let (mut even, mut odd) = (zero, zero);
        let flow = if chunk.is_plain {
            let mut k = 0;
            while k + 1 < m {
                let there = T::load(stencil.values, at.wrapping_add_signed(stencil.shifts[k]));
                let next = T::load(
                    stencil.values,
                    at.wrapping_add_signed(stencil.shifts[k + 1]),
                );
                even = (there - here)
                    .masked(bonds[k])
                    .mul_add(T::splat(stencil.weights[k]), even);
                odd = (next - here)
                    .masked(bonds[k + 1])
                    .mul_add(T::splat(stencil.weights[k + 1]), odd);
                k += 2;
            }
            if k < m {
                let there = T::load(stencil.values, at.wrapping_add_signed(stencil.shifts[k]));
                even = (there - here)
                    .masked(bonds[k])
                    .mul_add(T::splat(stencil.weights[k]), even);
            }
            let conductivity = match stencil.interface {
                Interface::Harmonic => T::splat(1.0) / material,
                Interface::Arithmetic => material,
            };
            (even + odd) * conductivity
        } else {
            for k in 0..m {
                let place = at.wrapping_add_signed(stencil.shifts[k]);
                let both = material + T::load(stencil.material, place);
                let mean = match stencil.interface {
                    Interface::Harmonic => T::splat(2.0) / both,
                    Interface::Arithmetic => T::splat(0.5) * both,
                };
                let mut conductivity = mean;
                if let [incomplete, excess @ ..] = stencil.surface {
                    let both = T::load(incomplete, at) * T::load(incomplete, place);
                    let mut sum = zero;
                    for c in 0..excess.len() {
                        let ends = T::load(&excess[c], at) + T::load(&excess[c], place);
                        sum = ends.mul_add(T::splat(stencil.directions[k][c]), sum);
                    }
                    conductivity = (both * sum).mul_add(mean, mean);
                }
                let difference = T::load(stencil.values, place) - here;
                even = (conductivity * difference)
                    .masked(bonds[k])
                    .mul_add(T::splat(stencil.weights[k]), even);
            }
            even
        };
        let numbers = (flow * T::splat(stencil.scale)).to_array();
        let mut point = chunk.point as usize - first_point;
        for lane in 0..LANES {
            if chunk.lanes >> lane & 1 == 1 {
                out[point] += numbers[lane];
                point += 1;
            }
        }
    }
}

for_each_instruction_set! {
    /// Adds the flows of the points of consecutive chunks to `out`, whose first entry belongs to `first_point`.
    pub(super) fn add_chunks [] <> (
        stencil: &Stencil<'_>,
        chunks: &[Chunk],
        bonds: &[u8],
        first_point: usize,
        out: &mut [f64],
    ) = add_chunks_body on lanes
}
