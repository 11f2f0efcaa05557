//! Which bonds of a lattice body exist: geometry, pre-cracks, points that never fail.

use rayon::prelude::*;

use super::layout::GridLayout;
use super::stencil::Stencil;
use crate::error::{PericlesError, Result};
use crate::family::{Crack, Cut, EndRule};
use crate::lanes::LANES;
use crate::operator::damage::BlockDamage;
use crate::space::Sites;

/// All bonds of the geometric families.
pub(super) fn geometric_blocks<const D: usize>(
    layout: &GridLayout,
    stencil: &Stencil<D>,
) -> Vec<BlockDamage> {
    (0..layout.blocks())
        .into_par_iter()
        .map(|block| {
            let chunks = &layout.chunks()[layout.chunks_of(block)];
            let mut intact = Vec::with_capacity(chunks.len() * stencil.len());
            for chunk in chunks {
                let bits = |&cell: &[i32; 3]| layout.neighbours(chunk, cell);
                intact.extend(stencil.cells().iter().map(bits));
            }
            BlockDamage::new(intact)
        })
        .collect()
}

/// Removes the bonds that meet a crack.
///
/// # Errors
/// A crack of another dimension than the cloud's, or without extent.
pub(super) fn cut<const D: usize>(
    sites: &Sites,
    layout: &GridLayout,
    stencil: &Stencil<D>,
    (crack, rule): &(Crack, EndRule),
    blocks: &mut [BlockDamage],
) -> Result<Cut> {
    if crack.dimension() != D {
        return Err(PericlesError::WrongDimension {
            what: "a crack of this kind",
            needed: ["1", "2", "3"][crack.dimension() - 1],
            dimension: D,
        });
    }
    let spacing = sites.cloud().spacing();
    let cutter = crack.cutter(*rule, 1e-9 * spacing)?;
    let longest = stencil.lengths().iter().copied().fold(0.0, f64::max);
    let near = longest + 1e-6 * spacing;
    let removed: Vec<Vec<(u32, u64)>> = blocks
        .par_iter_mut()
        .enumerate()
        .map(|(block, state)| {
            let mut removed = Vec::new();
            let chunks = &layout.chunks()[layout.chunks_of(block)];
            for (chunk, intact) in chunks.iter().zip(state.intact.chunks_mut(stencil.len())) {
                for (lane, i) in chunk.points() {
                    let here = sites.of_point(i);
                    let place = chunk.place as usize * LANES + lane;
                    // Beyond a periodic face the crack has images.
                    let alone = sites.are_points();
                    if alone && crack.distance(sites.places().point(here)) > near {
                        continue;
                    }
                    let mut count = 0;
                    for (mask, offset) in intact.iter_mut().zip(stencil.offsets()) {
                        if *mask >> lane & 1 == 0 {
                            continue;
                        }
                        let there = layout.site_at(place.wrapping_add_signed(offset.shift));
                        if cutter.cuts_bond(sites, here, there) {
                            *mask &= !(1 << lane);
                            count += 1;
                        }
                    }
                    if count > 0 {
                        removed.push((i as u32, count));
                    }
                }
            }
            removed
        })
        .collect();
    let directed = removed.iter().flatten().map(|&(_, count)| count).sum();
    let mut cut = Cut {
        bonds: sites.cloud().domain().count(directed) / 2,
        points: removed.iter().flatten().map(|&(i, _)| i).collect(),
    };
    cut.points.sort_unstable();
    Ok(cut)
}

/// The groups (chunk · offsets + offset) that lost bonds to cracks, ascending, with the bonds lost.
pub(super) fn precut_bonds<const D: usize>(
    layout: &GridLayout,
    stencil: &Stencil<D>,
    blocks: &[BlockDamage],
) -> Vec<(u64, u8)> {
    let m = stencil.len();
    let lost: Vec<Vec<(u64, u8)>> = blocks
        .par_iter()
        .enumerate()
        .map(|(block, state)| {
            let mut lost = Vec::new();
            for (k, number) in layout.chunks_of(block).enumerate() {
                let chunk = &layout.chunks()[number];
                for (offset, &cell) in stencil.cells().iter().enumerate() {
                    let bits = layout.neighbours(chunk, cell) & !state.intact[k * m + offset];
                    if bits != 0 {
                        lost.push(((number * m + offset) as u64, bits));
                    }
                }
            }
            lost
        })
        .collect();
    lost.concat()
}
