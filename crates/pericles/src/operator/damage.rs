//! Damage by breaking bonds: which are left, and what those lost took with them. One account for every form of operator.

use crate::archive::{Archive, Counter, Values};
use crate::error::Result;

/// How damage weighs bonds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DamageMeasure {
    /// Count bonds instead of weighing them by the volume Vκ they stand for.
    pub count: bool,
    /// Let bonds cut by pre-cracks count as broken; else they never belonged to the family.
    pub count_precut: bool,
}

/// When and which bonds break.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Breaking<'a> {
    /// Critical stretch s₀; infinite: never.
    pub critical_stretch: f64,
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
}

/// An entry that broke, and the energy it booked.
#[derive(Debug, Clone, Copy)]
pub(super) struct BreakEvent {
    pub point: u32,
    pub entry: usize,
    pub dissipated: f64,
}

/// What breaking did to a block.
#[derive(Debug, Clone, Default)]
pub(super) struct Tally {
    /// Σ over directed bonds broken of V/2 times the energy dissipated, J.
    pub dissipated: f64,
    /// Directed bonds broken.
    pub broken: Counter,
    /// The entries broken in the last sweep, if they were asked for.
    pub events: Vec<BreakEvent>,
}

/// Damage of a block of points.
#[derive(Debug, Clone)]
pub(super) struct BlockDamage {
    /// Bonds left, one byte per group of eight.
    pub intact: Vec<u8>,
    pub tally: Tally,
}

impl BlockDamage {
    /// A block that nothing has happened to yet.
    pub fn new(intact: Vec<u8>) -> Self {
        Self {
            intact,
            tally: Tally::default(),
        }
    }

    /// The second end of a bond whose first one broke: clears it, and books its half of the energy, unless that is done.
    pub fn break_other_end(&mut self, group: usize, lane: usize, event: &BreakEvent) {
        if self.intact[group] >> lane & 1 == 1 {
            self.intact[group] &= !(1 << lane);
            self.tally.broken.add(1);
            self.tally.dissipated += event.dissipated;
        }
    }
}

/// Energy dissipated, J.
pub(super) fn dissipated(blocks: &[BlockDamage]) -> f64 {
    blocks.iter().map(|block| block.tally.dissipated).sum()
}

/// Bonds broken, each counted once.
pub(super) fn broken_bonds(blocks: &[BlockDamage]) -> u64 {
    let directed: Counter = blocks.iter().map(|block| block.tally.broken).sum();
    directed.get() / 2
}

/// Bonds left, each counted twice.
pub(super) fn bonds_left(blocks: &[BlockDamage]) -> u64 {
    let bytes = blocks.iter().flat_map(|block| &block.intact);
    bytes.map(|byte| u64::from(byte.count_ones())).sum()
}

/// Writes the blocks under names that begin with `prefix`.
pub(super) fn save(blocks: &[BlockDamage], prefix: &str, archive: &mut Archive) {
    let intact = blocks.iter().flat_map(|block| &block.intact).copied();
    let broken = blocks.iter().map(|block| block.tally.broken.get());
    let dissipated = blocks.iter().map(|block| block.tally.dissipated);
    archive.put(format!("{prefix}/intact"), Values::U8(intact.collect()));
    archive.put(format!("{prefix}/broken"), Values::U64(broken.collect()));
    archive.put(
        format!("{prefix}/dissipated"),
        Values::F64(dissipated.collect()),
    );
}

/// Takes back what [`save`] wrote.
///
/// # Errors
/// An archive of other blocks.
pub(super) fn restore(blocks: &mut [BlockDamage], prefix: &str, archive: &Archive) -> Result<()> {
    let groups = blocks.iter().map(|block| block.intact.len()).sum();
    let mut intact = vec![0; groups];
    let mut broken = vec![0; blocks.len()];
    let mut dissipated = vec![0.0; blocks.len()];
    archive.u8_into(&format!("{prefix}/intact"), &mut intact)?;
    archive.u64_into(&format!("{prefix}/broken"), &mut broken)?;
    archive.f64_into(&format!("{prefix}/dissipated"), &mut dissipated)?;
    let mut rest = &intact[..];
    for (k, block) in blocks.iter_mut().enumerate() {
        let (own, after) = rest.split_at(block.intact.len());
        block.intact.copy_from_slice(own);
        rest = after;
        block.tally.broken = broken[k].into();
        block.tally.dissipated = dissipated[k];
    }
    Ok(())
}
