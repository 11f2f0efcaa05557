//! [`Breakable`] for softening bonds.

use super::force::SofteningForce;
use crate::domain::Field;
use crate::neighbourhood::BondSet;
use crate::operator::fast_law::VectorLaw;
use crate::operator::{Breakable, CoarseBreak};

impl<L: VectorLaw, const D: usize> Breakable for SofteningForce<L, D> {
    fn bonds(&self) -> &dyn BondSet {
        &self.list.bonds
    }

    fn bonds_mut(&mut self) -> &mut dyn BondSet {
        &mut self.list.bonds
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        self.list.bonds.take_coarse_breaks()
    }

    fn can_break(&self) -> bool {
        true
    }

    /// Damage of a point: the missing fraction of its family, in which each bond counts with its damage d.
    fn damage_into(&self, out: &mut [f64]) {
        let bonds = &self.list.bonds;
        bonds.damage_with(out, |i, entry| {
            self.retained(i, entry, bonds.form().neighbour(entry))
        });
    }

    /// The fraction is relative to the stretch at which a bond breaks, the end of its softening curve.
    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        let list = &self.list;
        let ghosts = list.cloud.domain().ghosts(u);
        let (u, sites) = (Field::new(u, &ghosts), list.bonds.form().sites());
        let heat = list.latest_heat();
        let bonds = list.view().heated(heat.as_deref().map(Vec::as_slice));
        let kept = self.kept();
        let over = |entry: usize, a: usize, b: usize| {
            let Some((curve, factor)) = kept.curve(entry, [a, b]) else {
                return false;
            };
            let eta = u.difference::<D>([a, b].map(|site| sites.point(site)));
            let (xi, eta, _) = bonds.relative::<L, D>(entry, [a, b], bonds.vector(a, b), eta);
            let (measure, square) = L::stretch_measure(xi, eta);
            L::stretch(measure / square) > fraction * factor * curve.end()
        };
        let families = list.bonds.form();
        list.bonds
            .mark(marks, |i, entry, site| over(entry, families.site(i), site));
    }
}
