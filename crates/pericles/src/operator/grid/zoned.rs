//! [`SplitForce`] and [`LocalForce`] for lattice bodies.

use super::block::{ChunkBlock, Partners};
use super::force::GridForce;
use super::kernels::force_chunks;
use crate::neighbourhood::Form;
use crate::operator::fast_law::VectorLaw;
use crate::operator::{Breakable, LocalForce, PointSubset, SplitForce};
use crate::step_end::StepEnd;

impl<L: VectorLaw, const D: usize> GridForce<L, D> {
    fn partners(&self, marks: &[bool]) -> Partners {
        let marks = self.cloud.domain().marks_with_ghosts(marks);
        Partners(self.layout().marked(|point| marks[point]))
    }

    /// Returns the intact bonds of the requested chunks of a block that lead to partners; no bonds for other
    /// chunks.
    pub(super) fn bonds_to(
        &self,
        partners: &Partners,
        block: &ChunkBlock<'_>,
        intact: &[u8],
    ) -> Vec<u8> {
        let bits = |place: usize| partners.0[place];
        let mut left = vec![0; intact.len()];
        let rows = left
            .chunks_mut(self.stencil().len())
            .zip(intact.chunks(self.stencil().len()));
        for (number, (chunk, (left, intact))) in block.chunks.iter().zip(rows).enumerate() {
            if block.wanted(number) == 0 {
                continue;
            }
            for (k, &cell) in self.stencil().cells().iter().enumerate() {
                if intact[k] != 0 {
                    left[k] = intact[k] & self.layout().neighbour_bits(chunk, cell, bits);
                }
            }
        }
        left
    }
}

impl<L: VectorLaw, const D: usize> SplitForce for GridForce<L, D> {
    /// Needs a work array of one byte per bond group of the affected blocks.
    fn add_force_from(
        &self,
        t: f64,
        u: &[f64],
        on: PointSubset<'_>,
        partners: &[bool],
        out: &mut [f64],
    ) {
        let partners = self.partners(partners);
        let u = (u, self.stretches(t));
        self.sweep::<f64, D>(&self.doubles, u, &on, out, |grid, block, intact, out| {
            let left = self.bonds_to(&partners, block, intact);
            force_chunks::<L, D>(self.instruction_set, grid, block, &left, out);
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
            let partners = self.partners(partners);
            self.decide(step, &on, Some(&partners), out);
        } else {
            self.add_force_from(step.t, step.u, on, partners, out);
        }
    }
}

impl<L: VectorLaw, const D: usize> LocalForce for GridForce<L, D> {
    fn bonded(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.bonds.form().for_each_neighbour(i, visit);
    }
}
