//! [`Breakable`] for bond lists.

use super::force::BondForce;
use crate::lanes::LANES;
use crate::operator::fast_law::FastLaw;
use crate::operator::{Breakable, CoarseBreak, Force, damage};
use crate::parallel::{components, for_each_chunk};

impl<L: FastLaw, const D: usize> Breakable for BondForce<L, D> {
    fn dissipated(&self) -> f64 {
        damage::dissipated(&self.blocks)
    }

    fn dissipate(&mut self, energy: f64) {
        damage::dissipate(&mut self.blocks, energy);
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        damage::take_coarse_breaks(&mut self.blocks)
    }

    fn broken_bonds(&self) -> u64 {
        damage::broken_bonds(&self.blocks)
    }

    fn can_break(&self) -> bool {
        self.critical_stretch.is_finite()
    }

    fn damage_into(&self, out: &mut [f64]) {
        for_each_chunk(out, &|first, out| {
            for (i, damage) in (first..).zip(out) {
                let (mut whole, mut left) = (0.0, 0.0);
                for (entry, j) in self.bonds.family(i) {
                    let present = self.bonds.present()[entry / LANES] >> (entry % LANES) & 1 == 1;
                    if !(present || self.damage.count_precut) {
                        continue;
                    }
                    let weight = if self.damage.count {
                        1.0
                    } else {
                        self.bonds.volume_factor(&self.cloud, i, j) * self.cloud.volumes()[j]
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
        for i in 0..self.points() {
            let family = self.bonds.family(i);
            for (_, j) in family.filter(|&(entry, j)| j > i && self.is_intact(i, entry)) {
                visit(i, j);
            }
        }
    }

    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        if !self.can_break() {
            return;
        }
        let threshold = |i: usize, j: usize| {
            let stretch = match &self.pairs {
                Some(pairs) => pairs.classes.critical_stretch(i, j),
                None => self.critical_stretch,
            };
            L::threshold(fraction * stretch)
        };
        let u = components::<D>(u, self.points());
        let bonds = self.view();
        let over = |i: usize, j: usize| {
            let eta: [f64; D] = std::array::from_fn(|c| u[c][j] - u[c][i]);
            let (measure, square) = L::stretch_measure(bonds.vector(i, j), eta);
            measure > threshold(i, j) * square
        };
        let may_break = |entry: usize| {
            self.breakable
                .as_ref()
                .is_none_or(|bits| bits[entry / LANES] >> (entry % LANES) & 1 == 1)
        };
        for_each_chunk(marks, &|first, marks| {
            for (i, mark) in (first..).zip(marks) {
                *mark |= self
                    .bonds
                    .family(i)
                    .any(|(entry, j)| self.is_intact(i, entry) && may_break(entry) && over(i, j));
            }
        });
    }
}
