//! [`Breakable`] for neighbour lists.

use super::force::BondForce;
use crate::domain::Field;
use crate::neighbourhood::BondSet;
use crate::operator::fast_law::VectorLaw;
use crate::operator::{Breakable, CoarseBreak};

impl<L: VectorLaw, const D: usize> Breakable for BondForce<L, D> {
    fn bonds(&self) -> &dyn BondSet {
        &self.bonds
    }

    fn bonds_mut(&mut self) -> &mut dyn BondSet {
        &mut self.bonds
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        self.bonds.take_coarse_breaks()
    }

    fn can_break(&self) -> bool {
        self.critical_stretch.is_finite()
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
        let (u, sites) = (Field::new(u, &ghosts), self.bonds.form().sites());
        let heat = self.latest_heat();
        let bonds = self.view().heated(heat.as_deref().map(Vec::as_slice));
        let over = |entry: usize, a: usize, b: usize| {
            let eta = u.difference::<D>([a, b].map(|site| sites.point(site)));
            let (xi, eta, _) = bonds.relative::<L, D>(entry, [a, b], bonds.vector(a, b), eta);
            let (measure, square) = L::stretch_measure(xi, eta);
            measure > threshold(a, b) * square
        };
        let list = self.bonds.form();
        self.bonds
            .mark(marks, |i, entry, site| over(entry, list.site(i), site));
    }
}
