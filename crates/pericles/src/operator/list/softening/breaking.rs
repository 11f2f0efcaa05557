//! [`Breakable`] for softening bonds.

use std::ops::Range;

use super::force::SofteningForce;
use crate::domain::Field;
use crate::lanes::LANES;
use crate::operator::fast_law::VectorLaw;
use crate::operator::{Breakable, CoarseBreak};
use crate::parallel::{PointSubset, for_each_chunk_of};

impl<L: VectorLaw, const D: usize> Breakable for SofteningForce<L, D> {
    fn dissipated(&self) -> f64 {
        self.list.dissipated()
    }

    fn dissipate(&mut self, i: usize, energy: f64) {
        self.list.dissipate(i, energy);
    }

    fn follow_dissipation(&mut self) {
        self.list.follow_dissipation();
    }

    fn take_dissipated(&mut self, out: &mut [f64]) {
        self.list.take_dissipated(out);
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        self.list.take_coarse_breaks()
    }

    fn broken_bonds(&self) -> u64 {
        self.list.broken_bonds()
    }

    fn can_break(&self) -> bool {
        true
    }

    /// Damage of a point: the missing fraction of its family, in which each bond counts with its damage d.
    fn damage_into(&self, out: &mut [f64]) {
        let (list, bonds) = (&self.list, &self.list.bonds);
        for_each_chunk_of(out, list.bonds.cost(&PointSubset::All), &|first, out| {
            for (i, damage) in (first..).zip(out) {
                let (mut whole, mut left) = (0.0, 0.0);
                let here = bonds.site(i);
                for (entry, b) in bonds.family(i) {
                    if !(bonds.is_present(entry) || list.damage.count_precut) {
                        continue;
                    }
                    let weight = match list.damage.count {
                        true => 1.0,
                        false => bonds.volume_factor(here, b) * bonds.volume(b),
                    };
                    whole += weight;
                    if list.is_intact(i, entry) {
                        left += weight * self.retained(i, entry, b);
                    }
                }
                *damage = if whole > 0.0 { 1.0 - left / whole } else { 0.0 };
            }
        });
    }

    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize)) {
        self.list.for_each_intact(visit);
    }

    fn for_each_broken_count(&self, visit: &mut dyn FnMut(Range<usize>, u64)) {
        self.list.for_each_broken_count(visit);
    }

    fn for_each_intact_of(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.list.for_each_intact_of(i, visit);
    }

    /// The fraction is relative to the stretch at which a bond breaks, the end of its softening curve.
    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        let list = &self.list;
        let ghosts = list.cloud.domain().ghosts(u);
        let (u, sites) = (Field::new(u, &ghosts), list.bonds.sites());
        let heat = list.latest_heat();
        let bonds = list.view().heated(heat.as_deref().map(Vec::as_slice));
        let over = |a: usize, b: usize| {
            let Some((curve, factor)) = self.curves.of(a, b) else {
                return false;
            };
            let eta = u.difference::<D>([a, b].map(|site| sites.point(site)));
            let (xi, eta, _) = bonds.expanded([a, b], bonds.vector(a, b), eta);
            let (measure, square) = L::stretch_measure(xi, eta);
            L::stretch(measure / square) > fraction * factor * curve.end()
        };
        let may_break = |entry: usize| {
            let bits = list.breakable.as_ref();
            bits.is_none_or(|bits| bits[entry / LANES] >> (entry % LANES) & 1 == 1)
        };
        for_each_chunk_of(
            marks,
            list.bonds.cost(&PointSubset::All),
            &|first, marks| {
                for (i, mark) in (first..).zip(marks) {
                    *mark = *mark
                        || list.bonds.family(i).any(|(entry, b)| {
                            list.is_intact(i, entry)
                                && may_break(entry)
                                && over(list.bonds.site(i), b)
                        });
                }
            },
        );
    }
}
