//! [`Breakable`] for neighbour lists.

use std::ops::Range;

use super::force::BondForce;
use crate::domain::Field;
use crate::lanes::LANES;
use crate::operator::fast_law::VectorLaw;
use crate::operator::{Breakable, CoarseBreak, Force, damage};
use crate::parallel::{BLOCK, PointSubset, for_each_chunk_of};

impl<L: VectorLaw, const D: usize> Breakable for BondForce<L, D> {
    fn dissipated(&self) -> f64 {
        damage::dissipated(self.cloud.domain(), &self.blocks)
    }

    fn dissipate(&mut self, i: usize, energy: f64) {
        damage::dissipate(&mut self.blocks, i, energy);
    }

    fn follow_dissipation(&mut self) {
        damage::follow_dissipation(&mut self.blocks);
    }

    fn take_dissipated(&mut self, out: &mut [f64]) {
        damage::take_dissipated(&mut self.blocks, out);
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        damage::take_coarse_breaks(&mut self.blocks)
    }

    fn broken_bonds(&self) -> u64 {
        damage::broken_bonds(self.cloud.domain(), &self.blocks)
    }

    fn can_break(&self) -> bool {
        self.critical_stretch.is_finite()
    }

    fn damage_into(&self, out: &mut [f64]) {
        for_each_chunk_of(out, self.bonds.cost(&PointSubset::All), &|first, out| {
            for (i, damage) in (first..).zip(out) {
                let (mut whole, mut left) = (0.0, 0.0);
                let here = self.bonds.site(i);
                for (entry, b) in self.bonds.family(i) {
                    if !(self.bonds.is_present(entry) || self.damage.count_precut) {
                        continue;
                    }
                    let weight = if self.damage.count {
                        1.0
                    } else {
                        self.bonds.volume_factor(here, b) * self.bonds.volume(b)
                    };
                    whole += weight;
                    if self.is_intact(i, entry) {
                        left += weight;
                    }
                }
                *damage = if whole > 0.0 { 1.0 - left / whole } else { 0.0 };
            }
        });
    }

    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize)) {
        let sites = self.bonds.sites();
        for i in 0..self.points() {
            let family = self.bonds.family(i);
            for (_, b) in family.filter(|&(entry, _)| self.is_intact(i, entry)) {
                let j = sites.point(b);
                if j > i {
                    visit(i, j);
                }
            }
        }
    }

    fn for_each_broken_count(&self, visit: &mut dyn FnMut(Range<usize>, u64)) {
        damage::broken_counts(
            &self.blocks,
            self.cloud.len(),
            &|block| block * BLOCK,
            visit,
        );
    }

    fn for_each_intact_of(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        let (family, sites) = (self.bonds.family(i), self.bonds.sites());
        let intact = family.filter(|&(entry, _)| self.is_intact(i, entry));
        intact.for_each(|(_, b)| visit(sites.point(b)));
    }

    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        if !self.can_break() {
            return;
        }
        let threshold = |a: usize, b: usize| {
            let stretch = match &self.pairs {
                Some(pairs) => pairs.critical_stretch(a, b),
                None => self.critical_stretch,
            };
            L::threshold(fraction * stretch)
        };
        let ghosts = self.cloud.domain().ghosts(u);
        let (u, sites) = (Field::new(u, &ghosts), self.bonds.sites());
        let heat = self.latest_heat();
        let bonds = self.view().heated(heat.as_deref().map(Vec::as_slice));
        let over = |a: usize, b: usize| {
            let eta = u.difference::<D>([a, b].map(|site| sites.point(site)));
            let (xi, eta, _) = bonds.expanded([a, b], bonds.vector(a, b), eta);
            let (measure, square) = L::stretch_measure(xi, eta);
            measure > threshold(a, b) * square
        };
        let may_break = |entry: usize| {
            self.breakable
                .as_ref()
                .is_none_or(|bits| bits[entry / LANES] >> (entry % LANES) & 1 == 1)
        };
        for_each_chunk_of(
            marks,
            self.bonds.cost(&PointSubset::All),
            &|first, marks| {
                for (i, mark) in (first..).zip(marks) {
                    *mark = *mark
                        || self.bonds.family(i).any(|(entry, b)| {
                            self.is_intact(i, entry)
                                && may_break(entry)
                                && over(self.bonds.site(i), b)
                        });
                }
            },
        );
    }
}
