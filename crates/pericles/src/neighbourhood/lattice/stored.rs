//! The bonds of a lattice body in checkpoints: the intact bonds of each point, one bit per offset of the stencil. Unlike
//! chunks, points and offsets do not depend on the division among processes.

use super::{Form, Lattice};
use crate::archive::{Archive, Layout, Values};
use crate::error::Result;
use crate::neighbourhood::BlockDamage;

const BONDS: &str = "operator/grid/bonds";
const BITS: usize = u8::BITS as usize;

/// Calls `visit(entry of the array, bit, index in the block, lane)` for each offset of each point of a block.
fn for_each(lattice: &Lattice, block: usize, mut visit: impl FnMut(usize, usize, usize, usize)) {
    let (n, m) = (lattice.points(), lattice.stencil.len());
    for (k, number) in lattice.layout.chunks_of(block).enumerate() {
        for (lane, i) in lattice.layout.chunks()[number].points() {
            for offset in 0..m {
                visit(offset / BITS * n + i, offset % BITS, k * m + offset, lane);
            }
        }
    }
}

/// Returns the number of bytes of the array.
fn bytes(lattice: &Lattice) -> usize {
    lattice.stencil.len().div_ceil(BITS) * lattice.points()
}

pub(super) fn save(lattice: &Lattice, blocks: &[BlockDamage], archive: &mut Archive) {
    let mut bits = vec![0u8; bytes(lattice)];
    for (block, damage) in blocks.iter().enumerate() {
        for_each(lattice, block, |entry, bit, group, lane| {
            bits[entry] |= (damage.intact[group] >> lane & 1) << bit;
        });
    }
    archive.put_as(BONDS, Values::U8(bits), Layout::Points);
}

pub(super) fn restore(
    lattice: &Lattice,
    blocks: &mut [BlockDamage],
    archive: &Archive,
) -> Result<()> {
    let bits: &[u8] = archive.exactly(BONDS, bytes(lattice))?;
    for (block, damage) in blocks.iter_mut().enumerate() {
        damage.intact.fill(0);
        for_each(lattice, block, |entry, bit, group, lane| {
            damage.intact[group] |= (bits[entry] >> bit & 1) << lane;
        });
    }
    Ok(())
}
