//! [`SplitForce`] and [`LocalForce`] for neighbour lists.

use super::force::BondForce;
use super::kernels::force_rows;
use crate::operator::fast_law::VectorLaw;
use crate::operator::{Breakable, LocalForce, PointSubset, SplitForce};
use crate::step_end::StepEnd;

impl<L: VectorLaw, const D: usize> SplitForce for BondForce<L, D> {
    fn add_force_from(
        &self,
        t: f64,
        u: &[f64],
        on: PointSubset<'_>,
        partners: &[bool],
        out: &mut [f64],
    ) {
        let partners = self.bonds.form().sites().spread_marks(partners);
        let heat = self.heat_at(t);
        let bonds = self.view().leading_to(Some(&partners));
        let bonds = bonds.heated(heat.as_deref().map(Vec::as_slice));
        self.with_packed(u, &on, |u| {
            self.sweep::<D>(&on, out, |intact, rows, out| {
                force_rows::<L, D>(self.instruction_set, &bonds, u, intact, rows, out);
            });
        });
    }

    fn end_step_from(
        &mut self,
        step: &StepEnd<'_>,
        on: PointSubset<'_>,
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

impl<L: VectorLaw, const D: usize> LocalForce for BondForce<L, D> {
    fn bonded(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.bonds.form().for_each_neighbour(i, visit);
    }
}
