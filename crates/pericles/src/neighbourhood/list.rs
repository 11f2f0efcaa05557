//! Bonds in a neighbour list.

use std::sync::Arc;

use super::Neighbourhood;
use super::form::{CountedBond, Form};
use super::tally::{BlockDamage, BondPlace, BreakEvent, DamageMeasure, Tally};
use crate::archive::{Archive, Layout, Values};
use crate::domain::Letter;
use crate::error::Result;
use crate::family::BondList;
use crate::lanes::LANES;
use crate::parallel::{BLOCK, Cost, PointSubset, for_each_chunk_of};
use crate::space::PointCloud;

const INTACT: &str = "operator/intact";

impl Form for BondList {
    const NAME: &'static str = "operator";

    fn cloud(&self) -> &Arc<PointCloud> {
        self.sites().cloud()
    }

    fn initial_bits(&self) -> Vec<Vec<u8>> {
        let bits = |block: usize| {
            let [from, to] = [block, block + 1].map(|block| self.start()[self.first_point(block)]);
            self.present()[from..to].to_vec()
        };
        (0..self.len().div_ceil(BLOCK)).map(bits).collect()
    }

    fn first_point(&self, block: usize) -> usize {
        (block * BLOCK).min(self.len())
    }

    fn directed_bonds(&self) -> u64 {
        BondList::directed_bonds(self)
    }

    fn cost(&self, on: &PointSubset<'_>) -> Cost {
        BondList::cost(self, on)
    }

    fn for_each_counted(
        &self,
        block: usize,
        intact: &[u8],
        measure: DamageMeasure,
        mut visit: impl FnMut(CountedBond),
    ) {
        let points = self.first_point(block)..self.first_point(block + 1);
        let first = self.start()[points.start];
        for point in points {
            let here = self.site(point);
            for (entry, there) in self.family(point) {
                if self.is_present(entry) || measure.count_precut {
                    visit(CountedBond {
                        point,
                        entry,
                        weight: match measure.count {
                            true => 1.0,
                            false => self.volume_factor(here, there) * self.volume(there),
                        },
                        intact: intact[entry / LANES - first] >> (entry % LANES) & 1 == 1,
                    });
                }
            }
        }
    }

    fn for_each_intact_of(&self, blocks: &[BlockDamage], i: usize, visit: &mut dyn FnMut(usize)) {
        for (entry, site) in self.family(i) {
            let BondPlace { block, group, lane } = self.place(i, entry);
            let j = self.sites().point(site);
            if j != i && blocks[block].intact[group] >> lane & 1 == 1 {
                visit(j);
            }
        }
    }

    fn for_each_neighbour(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        BondList::for_each_neighbour(self, i, visit);
    }

    fn letter(&self, event: &BreakEvent) -> Letter {
        let (sites, site) = (self.sites(), self.neighbour(event.entry));
        let [x, y, z] = sites.shift(site).map(|periods| -f64::from(periods));
        Letter {
            from: event.point as usize,
            to: sites.point(site),
            numbers: [event.dissipated, x, y, z],
        }
    }

    fn place_of(&self, letter: &Letter) -> Option<BondPlace> {
        let ([_, x, y, z], sites) = (letter.numbers, self.sites());
        let leads_back = |&(_, site): &(usize, usize)| {
            sites.point(site) == letter.from && sites.shift(site).map(f64::from) == [x, y, z]
        };
        let (entry, _) = self.family(letter.to).find(leads_back)?;
        Some(self.place(letter.to, entry))
    }

    fn bytes(&self) -> usize {
        BondList::bytes(self) + self.geometric().len() + self.breakable().map_or(0, <[u8]>::len)
    }

    fn save(&self, blocks: &[BlockDamage], archive: &mut Archive) {
        let bits = blocks.iter().flat_map(|block| &block.intact);
        let all: Vec<u8> = bits.copied().collect();
        let layout = Layout::rows(self.start(), all.len());
        archive.put_as(INTACT.to_owned(), Values::U8(all), layout);
    }

    fn restore(&self, blocks: &mut [BlockDamage], archive: &Archive) -> Result<()> {
        let groups = blocks.iter().map(|block| block.intact.len()).sum();
        let mut rest = archive.exactly(INTACT, groups)?;
        for block in blocks {
            let (own, after) = rest.split_at(block.intact.len());
            block.intact.copy_from_slice(own);
            rest = after;
        }
        Ok(())
    }
}

impl BondList {
    /// Returns the place of an entry of a point.
    pub fn place(&self, i: usize, entry: usize) -> BondPlace {
        let block = i / BLOCK;
        BondPlace {
            block,
            group: entry / LANES - self.start()[block * BLOCK],
            lane: entry % LANES,
        }
    }

    /// Returns the entry at a place.
    pub fn entry_at(&self, place: BondPlace) -> usize {
        (self.start()[place.block * BLOCK] + place.group) * LANES + place.lane
    }

    /// Returns the bytes of a point among those of its block.
    pub fn groups_in_block(&self, i: usize) -> std::ops::Range<usize> {
        let first = self.start()[i / BLOCK * BLOCK];
        let groups = self.groups(i);
        groups.start - first..groups.end - first
    }
}

impl Neighbourhood<BondList> {
    /// Returns whether the bond of an entry of point i is intact.
    pub fn is_intact(&self, i: usize, entry: usize) -> bool {
        let BondPlace { block, group, lane } = self.form().place(i, entry);
        self.blocks()[block].intact[group] >> lane & 1 == 1
    }

    /// Returns the intact bonds of a point, each with its entry and the site of the other end.
    pub fn intact_of(&self, i: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let family = self.form().family(i);
        family.filter(move |&(entry, _)| self.is_intact(i, entry))
    }

    /// Marks the points with an intact breakable bond for which `over(point, entry, site of the other end)` holds. Points
    /// that are already marked are skipped.
    pub fn mark(&self, marks: &mut [bool], over: impl Fn(usize, usize, usize) -> bool + Sync) {
        let list = self.form();
        for_each_chunk_of(marks, list.cost(&PointSubset::All), &|first, marks| {
            for (i, mark) in (first..).zip(marks) {
                *mark = *mark
                    || self
                        .intact_of(i)
                        .any(|(entry, site)| list.may_break(entry) && over(i, entry, site));
            }
        });
    }

    /// Returns the bits of the intact bonds of a point.
    pub fn bits(&self, i: usize) -> &[u8] {
        &self.blocks()[i / BLOCK].intact[self.form().groups_in_block(i)]
    }

    /// Returns these bits for modification.
    pub fn bits_mut(&mut self, i: usize) -> &mut [u8] {
        let groups = self.form.groups_in_block(i);
        &mut self.blocks[i / BLOCK].intact[groups]
    }

    /// Returns the record of broken bonds and dissipated energy of the block of a point for modification.
    pub fn tally_mut(&mut self, i: usize) -> &mut Tally {
        &mut self.blocks[i / BLOCK].tally
    }
}
