//! Damage: intact bonds, broken bonds and the energy they dissipated, for all force kernels.

use std::ops::Range;

use super::coarse::{CoarseBreak, Dissipated, LostBond, both_ends, each_once};
use super::dissipation::PointDissipation;
use crate::archive::{Archive, Counter, Layout, SavedUnder, Storage, Values};
use crate::domain::Domain;
use crate::error::Result;
use crate::step_end::{BreakingBond, StepEnd};
use crate::sum::BinnedSum;

/// Definition of damage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DamageMeasure {
    /// Whether bonds are counted instead of weighted by their volume Vκ.
    pub count: bool,
    /// Whether bonds cut by pre-cracks count as broken. Otherwise they are not part of the family.
    pub count_precut: bool,
}

/// Failure criterion of bonds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Breaking<'a> {
    /// Critical stretch s₀; infinite if bonds never break.
    pub critical_stretch: f64,
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
}

/// An entry that broke and the energy recorded for it.
#[derive(Debug, Clone, Copy)]
pub(super) struct BreakEvent {
    pub point: u32,
    pub entry: usize,
    pub dissipated: f64,
}

/// Broken bonds and dissipated energy of a block.
#[derive(Debug, Clone, Default)]
pub(super) struct Tally {
    /// Bonds whose failure the time step did not resolve, once per end that detected the failure. They are not saved,
    /// because each step corrects its own.
    pub coarse: Vec<CoarseBreak>,
    /// Σ over broken directed bonds of V/2 times the dissipated energy, J.
    dissipated: BinnedSum,
    /// Its terms by points.
    of_points: PointDissipation,
    /// Number of broken directed bonds.
    pub broken: Counter,
    /// Entries broken in the last sweep, if requested.
    pub events: Vec<BreakEvent>,
}

/// Damage of a block of points.
#[derive(Debug, Clone)]
pub(super) struct BlockDamage {
    /// Intact bonds, one byte per group of eight.
    pub intact: Vec<u8>,
    pub tally: Tally,
}

impl Tally {
    /// Adds energy dissipated by point i, J.
    pub fn dissipate(&mut self, i: usize, energy: f64) {
        self.dissipated.add(energy);
        self.of_points.add(i, energy);
    }

    /// Records the energy that point i dissipates by losing bonds.
    pub fn lose<const D: usize>(&mut self, i: usize, energy: Dissipated, lost: &[LostBond<D>]) {
        self.dissipate(i, energy.dissipated);
        self.coarse.extend(energy.records(i, lost));
    }

    /// Records half of the energy that a bond dissipates at the end of a step, for its first end, and returns
    /// that half, J. `before` is the argument of [`CoarseBreak::dissipated`].
    pub fn book<const D: usize>(
        &mut self,
        step: &StepEnd<'_>,
        bond: &BreakingBond<D>,
        before: impl FnOnce([f64; D]) -> Option<([f64; D], f64)>,
    ) -> f64 {
        let (dissipated, coarse) = CoarseBreak::dissipated(step, bond, before);
        let half = 0.5 * dissipated;
        self.dissipate(bond.ends[0], half);
        self.broken.add(1);
        self.coarse.extend(coarse);
        half
    }
}

/// Returns and clears the bonds that broke in steps too large for them, each once, in the order of their
/// ends.
pub(super) fn take_coarse_breaks(blocks: &mut [BlockDamage]) -> Vec<CoarseBreak> {
    let mut coarse: Vec<CoarseBreak> = Vec::new();
    for block in blocks {
        coarse.append(&mut block.tally.coarse);
    }
    each_once(coarse)
}

/// Returns and clears the bonds of points whose energy is not a sum over bonds, of which each end has recorded its part.
pub(super) fn take_coarse_parts(domain: &Domain, blocks: &mut [BlockDamage]) -> Vec<CoarseBreak> {
    let parts = blocks.iter_mut();
    let parts = parts.flat_map(|block| std::mem::take(&mut block.tally.coarse));
    both_ends(domain, parts.collect())
}

/// Adds energy dissipated by point i, J.
pub(super) fn dissipate(blocks: &mut [BlockDamage], i: usize, energy: f64) {
    if let Some(block) = blocks.first_mut() {
        block.tally.dissipate(i, energy);
    }
}

/// Records the dissipated energy by points from now on.
pub(super) fn follow_dissipation(blocks: &mut [BlockDamage]) {
    for block in blocks {
        block.tally.of_points.follow();
    }
}

/// Adds the energy that each point has dissipated since the last call to `out`, J.
pub(super) fn take_dissipated(blocks: &mut [BlockDamage], out: &mut [f64]) {
    for block in blocks {
        block.tally.of_points.take_into(out);
    }
}

impl BlockDamage {
    /// Creates a block without broken bonds.
    pub fn new(intact: Vec<u8>) -> Self {
        Self {
            intact,
            tally: Tally::default(),
        }
    }

    /// Breaks a bond at its second end, point i: clears the entry and records its half of the energy, unless this
    /// is already done.
    pub fn break_other_end(&mut self, i: usize, group: usize, lane: usize, dissipated: f64) {
        if self.intact[group] >> lane & 1 == 1 {
            self.intact[group] &= !(1 << lane);
            self.tally.broken.add(1);
            self.tally.dissipate(i, dissipated);
        }
    }
}

/// Returns the energy dissipated in all processes, J.
pub(super) fn dissipated(domain: &Domain, blocks: &[BlockDamage]) -> f64 {
    domain.total(own_dissipation(blocks))
}

fn own_dissipation(blocks: &[BlockDamage]) -> BinnedSum {
    let sums = blocks.iter().map(|block| block.tally.dissipated);
    sums.fold(BinnedSum::default(), BinnedSum::merged)
}

/// Returns the number of broken bonds of all processes, each counted once.
pub(super) fn broken_bonds(domain: &Domain, blocks: &[BlockDamage]) -> u64 {
    let directed: Counter = blocks.iter().map(|block| block.tally.broken).sum();
    domain.count(directed.get()) / 2
}

/// Calls `visit` with the points of each block, which starts at point `first`, and the number of broken directed bonds
/// in it.
pub(super) fn broken_counts(
    blocks: &[BlockDamage],
    points: usize,
    first: &dyn Fn(usize) -> usize,
    visit: &mut dyn FnMut(Range<usize>, u64),
) {
    for (number, block) in blocks.iter().enumerate() {
        let end = match number + 1 == blocks.len() {
            true => points,
            false => first(number + 1),
        };
        visit(first(number)..end, block.tally.broken.get());
    }
}

/// Returns the number of intact bonds, each counted twice.
pub(super) fn bonds_left(blocks: &[BlockDamage]) -> u64 {
    let bytes = blocks.iter().flat_map(|block| &block.intact);
    bytes.map(|byte| u64::from(byte.count_ones())).sum()
}

/// Saves the bonds of a neighbour list: one row of groups of eight bonds per point.
pub(super) struct ListStorage<'a> {
    /// Begins the names of the arrays.
    pub name: &'static str,
    /// First group of each point, and at the end the number of groups.
    pub start: &'a [usize],
}

impl Storage<Vec<BlockDamage>> for ListStorage<'_> {
    fn save(&self, blocks: &Vec<BlockDamage>, archive: &mut Archive) {
        let all: Vec<u8> = blocks
            .iter()
            .flat_map(|block| &block.intact)
            .copied()
            .collect();
        let layout = Layout::rows(self.start, all.len());
        archive.put_as(format!("{}/intact", self.name), Values::U8(all), layout);
        save_tallies(self.name, blocks, archive);
    }

    fn restore(&self, blocks: &mut Vec<BlockDamage>, archive: &Archive) -> Result<()> {
        let groups = blocks.iter().map(|block| block.intact.len()).sum();
        let mut rest = archive.exactly(&format!("{}/intact", self.name), groups)?;
        for block in blocks.iter_mut() {
            let (own, after) = rest.split_at(block.intact.len());
            block.intact.copy_from_slice(own);
            rest = after;
            block.tally.of_points.clear();
        }
        restore_tallies(self.name, blocks, archive)
    }
}

/// Saves the number of broken directed bonds of all blocks, and the energy that they dissipated.
pub(super) fn save_tallies(name: &str, blocks: &[BlockDamage], archive: &mut Archive) {
    let of_block = |block: &BlockDamage| {
        let Tally {
            broken,
            dissipated: _,
            of_points: _,
            coarse: _,
            events: _,
        } = &block.tally;
        *broken
    };
    let broken: Counter = blocks.iter().map(of_block).sum();
    let broken = Values::U64(vec![broken.get()]);
    archive.put_as(format!("{name}/broken"), broken, Layout::Count);
    own_dissipation(blocks).save_under(&format!("{name}/dissipated"), archive);
}

/// Restores the number of broken bonds and the dissipated energy; the first block gets the sum of all blocks.
pub(super) fn restore_tallies(
    name: &str,
    blocks: &mut [BlockDamage],
    archive: &Archive,
) -> Result<()> {
    let mut broken = [0];
    archive.u64_into(&format!("{name}/broken"), &mut broken)?;
    let mut dissipated = BinnedSum::default();
    dissipated.restore_under(&format!("{name}/dissipated"), archive)?;
    let mut broken = Counter::from(broken[0]);
    for block in blocks {
        block.tally.broken = std::mem::take(&mut broken);
        block.tally.dissipated = std::mem::take(&mut dissipated);
    }
    Ok(())
}
