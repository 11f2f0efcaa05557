//! State of the bonds of a block of points: intact bonds, broken bonds and the energy they dissipated.

use super::coarse::{CoarseBreak, Dissipated, LostBond};
use super::dissipation::PointDissipation;
use crate::archive::{Archive, Counter, Layout, SavedUnder, Values};
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

/// The place of a directed bond among the bits of all blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BondPlace {
    /// The block of its first end.
    pub block: usize,
    /// Byte of the block.
    pub group: usize,
    /// Bit of the byte.
    pub lane: usize,
}

/// An entry that broke and the energy recorded for it.
#[derive(Debug, Clone, Copy)]
pub struct BreakEvent {
    /// A point of the group of the entry: the first end in a list, the first point of the chunk on a lattice.
    pub point: u32,
    /// Number of the directed bond.
    pub entry: usize,
    /// Energy recorded for the first end, J.
    pub dissipated: f64,
}

/// Broken bonds and dissipated energy of a block.
#[derive(Debug, Clone, Default)]
pub struct Tally {
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
pub struct BlockDamage {
    /// Intact bonds, one byte per group of eight.
    pub intact: Vec<u8>,
    /// Broken bonds and dissipated energy.
    pub tally: Tally,
}

impl Tally {
    /// Adds energy dissipated by point i, J.
    pub fn dissipate(&mut self, i: usize, energy: f64) {
        self.dissipated.add(energy);
        self.of_points.add(i, energy);
    }

    /// Returns the dissipated energy, J.
    pub fn dissipated(&self) -> BinnedSum {
        self.dissipated
    }

    /// Records the dissipated energy by points from now on.
    pub fn follow(&mut self) {
        self.of_points.follow();
    }

    /// Adds the energy that each point has dissipated since the last call to `out`, J.
    pub fn take_dissipated(&mut self, out: &mut [f64]) {
        self.of_points.take_into(out);
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
    pub fn break_other_end(&mut self, i: usize, place: BondPlace, dissipated: f64) {
        let BondPlace { group, lane, .. } = place;
        if self.intact[group] >> lane & 1 == 1 {
            self.intact[group] &= !(1 << lane);
            self.tally.broken.add(1);
            self.tally.dissipate(i, dissipated);
        }
    }
}

/// Saves the number of broken directed bonds of all blocks, and the energy that they dissipated.
pub(super) fn save(name: &str, blocks: &[BlockDamage], archive: &mut Archive) {
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
    let sums = blocks.iter().map(|block| block.tally.dissipated);
    let own = sums.fold(BinnedSum::default(), BinnedSum::merged);
    own.save_under(&format!("{name}/dissipated"), archive);
}

/// Restores the number of broken bonds and the dissipated energy; the first block gets the sum of all blocks.
pub(super) fn restore(name: &str, blocks: &mut [BlockDamage], archive: &Archive) -> Result<()> {
    let mut broken = [0];
    archive.u64_into(&format!("{name}/broken"), &mut broken)?;
    let mut dissipated = BinnedSum::default();
    dissipated.restore_under(&format!("{name}/dissipated"), archive)?;
    let mut broken = Counter::from(broken[0]);
    for block in blocks {
        block.tally.of_points.clear();
        block.tally.coarse.clear();
        block.tally.broken = std::mem::take(&mut broken);
        block.tally.dissipated = std::mem::take(&mut dissipated);
    }
    Ok(())
}
