//! [`SplitForce`] and [`LocalForce`] for bond lists.

use super::force::BondForce;
use super::kernels::force_rows;
use crate::operator::fast_law::FastLaw;
use crate::operator::{Breakable, LocalForce, On, SplitForce};
use crate::step_end::StepEnd;

impl<L: FastLaw, const D: usize> SplitForce for BondForce<L, D> {
    fn add_force_from(&self, _t: f64, u: &[f64], on: On<'_>, partners: &[bool], out: &mut [f64]) {
        let partners = self.bonds.sites().spread_marks(partners);
        let bonds = self.view().leading_to(Some(&partners));
        self.with_packed(u, &on, |u| {
            self.sweep::<D>(&on, out, |intact, rows, out| {
                force_rows::<L, D>(self.instruction_set, &bonds, u, intact, rows, out);
            });
        });
    }

    fn end_step_from(
        &mut self,
        step: &StepEnd<'_>,
        on: On<'_>,
        partners: &[bool],
        out: &mut [f64],
    ) {
        if self.can_break() {
            self.decide(step, &on, Some(partners), out);
        } else {
            self.add_force_from(step.t, step.u, on, partners, out);
        }
    }
}

impl<L: FastLaw, const D: usize> LocalForce for BondForce<L, D> {
    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        let sites = self.bonds.sites();
        let family = self.bonds.family(i);
        let near = family.filter(|&(entry, _)| self.bonds.is_present(entry));
        if sites.are_points() {
            return near.for_each(|(_, j)| visit(j));
        }
        // A point may be a neighbour more than once, and its own.
        let mut points: Vec<usize> = near.filter_map(|(_, b)| sites.own_point(b)).collect();
        points.sort_unstable();
        points.dedup();
        points.into_iter().filter(|&j| j != i).for_each(visit);
    }
}
