//! Neighbourhoods: who is bonded to whom, and which bonds are broken.
//!
//! A [`Neighbourhood`] owns the bonds of a body: their members and order, bonds cut by pre-cracks, bonds that never
//! break, one bit per intact bond, and the energy that broken bonds dissipate. All forces of bonds use it; they differ
//! in what they compute from a bond only. Bonds are stored in one of two [forms](Form):
//!
//! | form | bonds | storage |
//! |---|---|---|
//! | [`BondList`](crate::family::BondList) | of any points | listed in groups of eight per point, 2.5 bytes each |
//! | [`Lattice`] | of the nodes of a regular lattice | one [`Stencil`] for all nodes; one bit each |
//!
//! **Blocks.** Points are divided into blocks of consecutive points, which one thread computes. A block has the bits of
//! its bonds, eight in a byte: a group of eight bonds of a point in a list, one offset of eight nodes of a row on a
//! lattice. Blocks do not depend on the number of threads.

mod coarse;
mod dissipation;
mod form;
mod growth;
mod lattice;
mod list;
mod set;
mod tally;

use std::ops::Range;

pub use coarse::{
    CoarseBreak, Crossing, Dissipated, LostBond, Released, both_ends, each_once, turns_around,
    with_received,
};
pub use dissipation::PointDissipation;
pub use form::{CountedBond, Form};
pub(crate) use growth::origin_of_entry;
pub(crate) use lattice::NO_LATTICE;
pub use lattice::{Chunk, GridLayout, Lattice, Stencil};
pub use set::BondSet;
pub use tally::{BlockDamage, BondPlace, BreakEvent, DamageMeasure, Tally};

use crate::archive::{Archive, Checkpointed, Counter};
use crate::error::Result;
use crate::parallel::{Cost, PointSubset, components_mut, for_each_part};
use crate::sum::BinnedSum;

use self::growth::Growth;

/// The bonds of a body in a form, with their state.
#[derive(Debug, Clone)]
pub struct Neighbourhood<F> {
    form: F,
    blocks: Vec<BlockDamage>,
    measure: DamageMeasure,
    growth: Growth,
}

/// The other end of a bond that broke in a sweep over a subset of points.
#[derive(Debug, Clone, Copy)]
pub struct OtherEnd {
    /// The point.
    pub point: usize,
    /// Its entry for the bond.
    pub place: BondPlace,
    /// Energy recorded for the first end, J.
    pub dissipated: f64,
}

impl<F: Form> Neighbourhood<F> {
    /// Creates the neighbourhood of the bonds of a form, none of which is broken.
    pub fn new(form: F, measure: DamageMeasure) -> Self {
        let blocks = form.initial_bits().into_iter().map(BlockDamage::new);
        Self {
            blocks: blocks.collect(),
            form,
            measure,
            growth: Growth::default(),
        }
    }

    /// The members and their order.
    pub fn form(&self) -> &F {
        &self.form
    }

    /// The state of the bonds of all blocks.
    pub fn blocks(&self) -> &[BlockDamage] {
        &self.blocks
    }

    /// Takes the state of the bonds for a loop that changes it; [`Neighbourhood::put_blocks`] puts it back.
    pub fn take_blocks(&mut self) -> Vec<BlockDamage> {
        std::mem::take(&mut self.blocks)
    }

    /// Puts the state of the bonds back.
    pub fn put_blocks(&mut self, blocks: Vec<BlockDamage>) {
        self.blocks = blocks;
    }

    /// Calls `visit(block, its intact bonds, its parts of the components of `out`)` for all blocks in parallel.
    pub fn for_each_block<const C: usize>(
        &self,
        cost: Cost,
        out: &mut [f64],
        visit: impl Fn(usize, &[u8], &mut [&mut [f64]; C]) + Sync,
    ) {
        // A vector of units takes no memory: the state of blocks is only read.
        let mut nothing = vec![(); self.blocks.len()];
        for_each_part(
            components_mut::<C>(out, self.form.points()),
            &mut nothing,
            cost,
            &|block| self.form.first_point(block),
            &|block, mut out, ()| visit(block, &self.blocks[block].intact, &mut out),
        );
    }

    /// Returns the number of broken directed bonds of each block: a changed number shows where bonds broke.
    pub fn broken_by_blocks(&self) -> Vec<u64> {
        let broken = |block: &BlockDamage| block.tally.broken.get();
        self.blocks.iter().map(broken).collect()
    }

    /// Calls `visit(first point of the block, bond, parts of the components of `out`)` for all bonds that count in the
    /// damage; bonds of points that are not active yet do not.
    pub fn for_each_counted<const C: usize>(
        &self,
        out: &mut [f64],
        visit: impl Fn(usize, CountedBond, &mut [&mut [f64]; C]) + Sync,
    ) {
        let cost = self.form.cost(&PointSubset::All);
        self.for_each_block::<C>(cost, out, |block, intact, out| {
            let first = self.form.first_point(block);
            self.form
                .for_each_counted(block, intact, self.measure, |bond| {
                    if !self.growth.is_pending(bond.entry) {
                        visit(first, bond, out);
                    }
                });
        });
    }

    /// Sets the damage of each point, 0 … 1: the missing fraction of its family, in which an intact bond counts with the
    /// fraction `retained(point, entry)` of its stiffness.
    pub fn damage_with(&self, out: &mut [f64], retained: impl Fn(usize, usize) -> f64 + Sync) {
        let n = out.len();
        let mut sums = vec![0.0; 2 * n];
        self.for_each_counted::<2>(&mut sums, |first, bond, [whole, left]| {
            whole[bond.point - first] += bond.weight;
            if bond.intact {
                left[bond.point - first] += bond.weight * retained(bond.point, bond.entry);
            }
        });
        let (whole, left) = sums.split_at(n);
        for (damage, (whole, left)) in out.iter_mut().zip(whole.iter().zip(left)) {
            *damage = match *whole > 0.0 {
                true => 1.0 - left / whole,
                false => 0.0,
            };
        }
    }

    /// Clears the bonds recorded as broken in a sweep over a subset of points, and returns the other end of each. A bond
    /// whose other end belongs to another process is sent to that process and returned there. All processes must call it
    /// together.
    pub fn other_ends(&self, blocks: &mut [BlockDamage]) -> Vec<OtherEnd> {
        let mut letters = Vec::new();
        for block in blocks {
            let events = block.tally.events.drain(..);
            letters.extend(events.map(|event| self.form.letter(&event)));
        }
        let letters = self.form.cloud().domain().deliver(letters);
        let found = letters.iter().filter_map(|letter| {
            Some(OtherEnd {
                point: letter.to,
                place: self.form.place_of(letter)?,
                dissipated: letter.numbers[0],
            })
        });
        found.collect()
    }

    /// Breaks the other end of bonds that broke in a sweep over a subset of points, and records its half of the energy.
    /// All processes must call it together.
    pub fn break_other_ends(&mut self) {
        let mut blocks = self.take_blocks();
        for end in self.other_ends(&mut blocks) {
            blocks[end.place.block].break_other_end(end.point, end.place, end.dissipated);
        }
        self.put_blocks(blocks);
    }

    /// Returns and clears the bonds that broke in steps too large for them, each once, in the order of their ends.
    pub fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        each_once(self.take_coarse_records())
    }

    /// Returns and clears the bonds of points whose energy is not a sum over bonds, of which each end has recorded its
    /// part.
    pub fn take_coarse_parts(&mut self) -> Vec<CoarseBreak> {
        let parts = self.take_coarse_records();
        both_ends(self.form.cloud().domain(), parts)
    }

    fn take_coarse_records(&mut self) -> Vec<CoarseBreak> {
        let blocks = self.blocks.iter_mut();
        let records = blocks.flat_map(|block| std::mem::take(&mut block.tally.coarse));
        records.collect()
    }

    /// Returns the number of bytes of the bits of all bonds.
    pub fn bytes_of_bits(&self) -> usize {
        self.blocks.iter().map(|block| block.intact.len()).sum()
    }
}

impl<F: Form> BondSet for Neighbourhood<F> {
    fn broken_bonds(&self) -> u64 {
        let directed: Counter = self.blocks.iter().map(|block| block.tally.broken).sum();
        self.form.cloud().domain().count(directed.get()) / 2
    }

    fn dissipated(&self) -> f64 {
        let sums = self.blocks.iter().map(|block| block.tally.dissipated());
        let own = sums.fold(BinnedSum::default(), BinnedSum::merged);
        self.form.cloud().domain().total(own)
    }

    fn dissipate(&mut self, i: usize, energy: f64) {
        if let Some(block) = self.blocks.first_mut() {
            block.tally.dissipate(i, energy);
        }
    }

    fn follow_dissipation(&mut self) {
        for block in &mut self.blocks {
            block.tally.follow();
        }
    }

    fn take_dissipated(&mut self, out: &mut [f64]) {
        for block in &mut self.blocks {
            block.tally.take_dissipated(out);
        }
    }

    fn damage_into(&self, out: &mut [f64]) {
        self.damage_with(out, |_, _| 1.0);
    }

    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize)) {
        for i in 0..self.form.points() {
            self.for_each_intact_of(i, &mut |j| {
                if j > i {
                    visit(i, j);
                }
            });
        }
    }

    fn for_each_intact_of(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.form.for_each_intact_of(&self.blocks, i, visit);
    }

    fn for_each_change_count(&self, visit: &mut dyn FnMut(Range<usize>, u64)) {
        for (number, broken) in self.broken_by_blocks().into_iter().enumerate() {
            let points = [number, number + 1].map(|block| self.form.first_point(block));
            visit(points[0]..points[1], broken + self.growth.changes(number));
        }
    }
}

impl<F: Form> Checkpointed for Neighbourhood<F> {
    fn save(&self, archive: &mut Archive) {
        self.form.save(&self.blocks, archive);
        tally::save(F::NAME, &self.blocks, archive);
        self.growth.save(archive);
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        self.form.restore(&mut self.blocks, archive)?;
        tally::restore(F::NAME, &mut self.blocks, archive)?;
        self.growth.restore(archive)
    }
}
