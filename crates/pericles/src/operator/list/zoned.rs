//! [`ZonedForce`] for bond lists.

use rayon::prelude::*;

use super::force::BondForce;
use super::kernels::force_rows;
use crate::lanes::LANES;
use crate::operator::fast_law::FastLaw;
use crate::operator::{ForceOperator, On, ZonedForce};
use crate::parallel::{BLOCK, components};
use crate::step_end::StepEnd;

impl<L: FastLaw, const D: usize> ZonedForce for BondForce<L, D> {
    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        let present = self.bonds.present();
        for (entry, j) in self.bonds.family(i) {
            if present[entry / LANES] >> (entry % LANES) & 1 == 1 {
                visit(j);
            }
        }
    }

    fn add_force_from(&self, _t: f64, u: &[f64], on: On<'_>, partners: &[bool], out: &mut [f64]) {
        let bonds = self.view().leading_to(Some(partners));
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
        marks
            .par_iter_mut()
            .enumerate()
            .with_min_len(BLOCK)
            .for_each(|(i, mark)| {
                *mark |= self
                    .bonds
                    .family(i)
                    .any(|(entry, j)| self.is_intact(i, entry) && may_break(entry) && over(i, j));
            });
    }
}
