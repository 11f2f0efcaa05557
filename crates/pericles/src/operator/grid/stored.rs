//! The bonds of a lattice body in checkpoints.

use super::layout::GridLayout;
use crate::archive::{Archive, Layout, Storage, Values};
use crate::error::Result;
use crate::operator::damage::{BlockDamage, restore_tallies, save_tallies};

/// Saves the intact bonds of each point, one bit per offset of the stencil. Unlike chunks, points and offsets do not
/// depend on the division among processes.
pub(in crate::operator) struct StencilStorage<'a> {
    /// Begins the names of the arrays.
    pub name: &'static str,
    pub layout: &'a GridLayout,
    /// Number of offsets of the stencil.
    pub offsets: usize,
}

const BITS: usize = u8::BITS as usize;

impl StencilStorage<'_> {
    /// Number of own points.
    fn points(&self) -> usize {
        self.layout.first_point(self.layout.blocks())
    }

    /// Calls `visit(entry of the array, bit, offset, lane, index in the block)` for each offset of each point of a block.
    fn for_each(&self, block: usize, mut visit: impl FnMut(usize, usize, usize, usize)) {
        let (n, m) = (self.points(), self.offsets);
        for (k, number) in self.layout.chunks_of(block).enumerate() {
            for (lane, i) in self.layout.chunks()[number].points() {
                for offset in 0..m {
                    visit(offset / BITS * n + i, offset % BITS, k * m + offset, lane);
                }
            }
        }
    }

    fn array(&self) -> String {
        format!("{}/bonds", self.name)
    }
}

impl Storage<Vec<BlockDamage>> for StencilStorage<'_> {
    fn save(&self, blocks: &Vec<BlockDamage>, archive: &mut Archive) {
        let mut bits = vec![0u8; self.offsets.div_ceil(BITS) * self.points()];
        for (block, damage) in blocks.iter().enumerate() {
            self.for_each(block, |entry, bit, group, lane| {
                bits[entry] |= (damage.intact[group] >> lane & 1) << bit;
            });
        }
        archive.put_as(self.array(), Values::U8(bits), Layout::Points);
        save_tallies(self.name, blocks, archive);
    }

    fn restore(&self, blocks: &mut Vec<BlockDamage>, archive: &Archive) -> Result<()> {
        let bytes = self.offsets.div_ceil(BITS);
        let bits: &[u8] = archive.exactly(&self.array(), bytes * self.points())?;
        for (block, damage) in blocks.iter_mut().enumerate() {
            damage.intact.fill(0);
            self.for_each(block, |entry, bit, group, lane| {
                damage.intact[group] |= (bits[entry] >> bit & 1) << lane;
            });
        }
        restore_tallies(self.name, blocks, archive)
    }
}
