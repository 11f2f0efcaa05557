//! Damage by breaking bonds: which are left, and what those lost took with them. One account for every form of operator.

use crate::archive::{Archive, Counter, SavedUnder, Values};
use crate::domain::Domain;
use crate::error::Result;
use crate::step_end::{BreakingBond, StepEnd};
use crate::sum::BinnedSum;

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

/// A bond that a step too coarse for it broke: the energy booked for it is far from what it stored at its critical stretch.
///
/// The work of its force over the step decides what a breaking bond dissipates ([`StepEnd::dissipated`]). A bond that was compressed at the
/// start of the step and is over-stretched at its end has negative work booked, as if breaking made energy; one that was pulled far beyond its critical stretch dissipates many times its energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoarseBreak {
    /// Its ends, the smaller number first.
    pub points: [u32; 2],
    /// The direction of its force, of either sign; any length but zero, missing components are zero.
    pub along: [f64; 3],
    /// Energy at its critical stretch minus the energy booked, J.
    pub missing: f64,
}

/// Energies booked for a broken bond that are taken as they are, over its energy at the critical stretch. The errors of both signs within these bounds cancel: they are of first
/// order in the step for one bond, of second order in the mean.
const RESOLVED: std::ops::RangeInclusive<f64> = 0.0..=4.0;

/// What breaking did to a block.
#[derive(Debug, Clone, Default)]
pub(super) struct Tally {
    /// Bonds broken by steps too coarse for them, once for each end that found it; not saved, as every step settles its own.
    pub coarse: Vec<CoarseBreak>,
    /// Σ over directed bonds broken of V/2 times the energy dissipated, J.
    pub dissipated: BinnedSum,
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

impl CoarseBreak {
    /// A bond that broke and dissipated so much, J, if that is far from its energy at the critical stretch; none where that energy is not known.
    pub fn of<const D: usize>(bond: &BreakingBond<D>, dissipated: f64) -> Option<Self> {
        let critical = bond.weight * bond.critical?;
        let resolved = critical * RESOLVED.start()..=critical * RESOLVED.end();
        let [i, j] = bond.ends.map(|end| end as u32);
        (!resolved.contains(&dissipated)).then(|| Self {
            points: [i.min(j), i.max(j)],
            along: std::array::from_fn(|c| bond.force.get(c).copied().unwrap_or(0.0)),
            missing: critical - dissipated,
        })
    }
}

impl Tally {
    /// Books half of what a bond dissipates at the end of a step for one of its ends; returns that half, J.
    pub fn book<const D: usize>(&mut self, step: &StepEnd<'_>, bond: &BreakingBond<D>) -> f64 {
        let dissipated = step.dissipated(bond);
        let half = 0.5 * dissipated;
        self.dissipated.add(half);
        self.broken.add(1);
        self.coarse.extend(CoarseBreak::of(bond, dissipated));
        half
    }
}

/// Takes the bonds that steps too coarse for them broke, each once, by their ends.
pub(super) fn take_coarse_breaks(blocks: &mut [BlockDamage]) -> Vec<CoarseBreak> {
    let mut coarse: Vec<CoarseBreak> = Vec::new();
    for block in blocks {
        coarse.append(&mut block.tally.coarse);
    }
    each_once(coarse)
}

/// Bonds in the order of their ends, without the second copies.
pub fn each_once(mut coarse: Vec<CoarseBreak>) -> Vec<CoarseBreak> {
    coarse.sort_by_key(|bond| bond.points);
    coarse.dedup_by_key(|bond| bond.points);
    coarse
}

/// Books energy, J.
pub(super) fn dissipate(blocks: &mut [BlockDamage], energy: f64) {
    if let Some(block) = blocks.first_mut() {
        block.tally.dissipated.add(energy);
    }
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
    pub fn break_other_end(&mut self, group: usize, lane: usize, dissipated: f64) {
        if self.intact[group] >> lane & 1 == 1 {
            self.intact[group] &= !(1 << lane);
            self.tally.broken.add(1);
            self.tally.dissipated.add(dissipated);
        }
    }
}

/// Energy dissipated by all processes, J.
pub(super) fn dissipated(domain: &Domain, blocks: &[BlockDamage]) -> f64 {
    domain.total(own_dissipation(blocks))
}

fn own_dissipation(blocks: &[BlockDamage]) -> BinnedSum {
    let sums = blocks.iter().map(|block| block.tally.dissipated);
    sums.fold(BinnedSum::default(), BinnedSum::merged)
}

/// Bonds broken in all processes, each counted once.
pub(super) fn broken_bonds(domain: &Domain, blocks: &[BlockDamage]) -> u64 {
    let directed: Counter = blocks.iter().map(|block| block.tally.broken).sum();
    domain.count(directed.get()) / 2
}

/// Bonds left, each counted twice.
pub(super) fn bonds_left(blocks: &[BlockDamage]) -> u64 {
    let bytes = blocks.iter().flat_map(|block| &block.intact);
    bytes.map(|byte| u64::from(byte.count_ones())).sum()
}

impl SavedUnder for Vec<BlockDamage> {
    fn save_under(&self, name: &str, archive: &mut Archive) {
        let groups = self.iter().map(|block| block.intact.len()).sum();
        let mut all = Vec::with_capacity(groups);
        let mut directed = Vec::new();
        for BlockDamage { intact, tally } in self {
            let Tally {
                broken,
                dissipated: _,
                coarse: _,
                events: _,
            } = tally;
            all.extend_from_slice(intact);
            directed.push(broken.get());
        }
        archive.put(format!("{name}/intact"), Values::U8(all));
        archive.put(format!("{name}/broken"), Values::U64(directed));
        own_dissipation(self).save_under(&format!("{name}/dissipated"), archive);
    }

    fn restore_under(&mut self, name: &str, archive: &Archive) -> Result<()> {
        let groups = self.iter().map(|block| block.intact.len()).sum();
        let mut rest = archive.exactly(&format!("{name}/intact"), groups)?;
        let broken = archive.exactly::<u64>(&format!("{name}/broken"), self.len())?;
        let mut dissipated = BinnedSum::default();
        let energies = format!("{name}/dissipated");
        match archive.numbers::<f64>(&energies) {
            // As earlier versions saved it: by blocks.
            Ok(of_blocks) => of_blocks.iter().for_each(|&energy| dissipated.add(energy)),
            Err(_) => dissipated.restore_under(&energies, archive)?,
        }
        for (k, block) in self.iter_mut().enumerate() {
            let (own, after) = rest.split_at(block.intact.len());
            block.intact.copy_from_slice(own);
            rest = after;
            block.tally.broken = Counter::from(broken[k]);
            block.tally.dissipated = std::mem::take(&mut dissipated);
        }
        Ok(())
    }
}
