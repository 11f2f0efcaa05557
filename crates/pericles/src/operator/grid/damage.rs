//! [`Breakable`] for lattice bodies.

use std::ops::Range;

use super::arrays::Grid;
use super::block::{ChunkBlock, scatter};
use super::force::GridForce;
use super::layout::Chunk;
use crate::lanes::LANES;
use crate::lanes::{Lanes, for_each_instruction_set};
use crate::operator::fast_law::VectorLaw;
use crate::operator::{Breakable, CoarseBreak, Force, PointSubset, damage};

impl<L: VectorLaw, const D: usize> Breakable for GridForce<L, D> {
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
        self.families().damage_into(out);
    }

    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize)) {
        self.families().for_each_intact(visit);
    }

    fn for_each_broken_count(&self, visit: &mut dyn FnMut(Range<usize>, u64)) {
        let first = |block| self.layout.first_point(block);
        damage::broken_counts(&self.blocks, self.cloud.len(), &first, visit);
    }

    fn for_each_intact_of(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.families().for_each_intact_of(i, visit);
    }

    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        if !self.can_break() {
            return;
        }
        let threshold = L::threshold(fraction * self.critical_stretch);
        let mut found = vec![0.0; self.points()];
        let families = self.families();
        let breakable = |chunk: &Chunk, offset: usize| families.breakable(chunk, offset);
        let part = |place: usize, shift: isize| match &self.pairs {
            None => [threshold; LANES],
            Some(pairs) => pairs.of_part::<L>(fraction, place, shift),
        };
        let endangered = Endangered {
            threshold,
            of_lanes: &part,
            breakable: &breakable,
        };
        self.sweep::<f64, 1>(
            &self.doubles,
            (u, self.latest_stretches()),
            &PointSubset::All,
            &mut found,
            |grid, block, intact, out| {
                endangered_chunks::<L, D>(
                    self.instruction_set,
                    grid,
                    &endangered,
                    block,
                    intact,
                    out,
                );
            },
        );
        for (mark, found) in marks.iter_mut().zip(found) {
            *mark |= found > 0.0;
        }
    }
}

/// Criterion for bonds close to their critical stretch.
struct Endangered<'a> {
    /// Smallest threshold of all bonds.
    threshold: f64,
    /// Thresholds of eight bonds from a place on, by the shift to their other ends.
    of_lanes: &'a (dyn Fn(usize, isize) -> [f64; LANES] + Sync),
    /// Bits of the bonds of a chunk and offset that may break.
    breakable: &'a (dyn Fn(&Chunk, usize) -> u8 + Sync),
}

#[inline(always)]
fn endangered_chunks_body<T: Lanes, L: VectorLaw, const D: usize>(
    grid: &Grid<'_, f64, D>,
    rule: &Endangered<'_>,
    block: &ChunkBlock<'_>,
    intact: &[u8],
    out: &mut [&mut [f64]; 1],
) {
    let m = grid.offsets.len();
    let threshold = T::splat(rule.threshold);
    // Called for few bonds only: function pointers keep the code out of the vector loop.
    let breakable = std::hint::black_box(rule.breakable);
    let of_lanes = std::hint::black_box(rule.of_lanes);
    for (number, chunk) in block.chunks.iter().enumerate() {
        let place = grid.place(chunk);
        let here = grid.here::<T>(place);
        let mut endangered = 0;
        let intact = &intact[number * m..(number + 1) * m];
        for k in 0..m {
            let (offset, mask) = (&grid.offsets[k], intact[k]);
            let (bond, eta) = grid.pulled::<T>(place, k, None, &here);
            let strain = L::strain(&bond, eta);
            let over = strain.greater(threshold) & mask;
            if over & !endangered != 0 {
                let own = T::load(&of_lanes(place - grid.margin, offset.shift), 0);
                endangered |= over & strain.greater(own) & breakable(chunk, k);
            }
        }
        if endangered != 0 {
            let mut ones = [0.0; LANES];
            for lane in 0..LANES {
                ones[lane] = f64::from(endangered >> lane & 1);
            }
            scatter(ones, chunk, chunk.lanes, block.first_point, out[0]);
        }
    }
}

for_each_instruction_set! {
    /// Adds one for points with a breakable bond whose strain exceeds the threshold.
    fn endangered_chunks [L: VectorLaw, const D: usize] <L, D> (
        grid: &Grid<'_, f64, D>,
        rule: &Endangered<'_>,
        block: &ChunkBlock<'_>,
        intact: &[u8],
        out: &mut [&mut [f64]; 1],
    ) = endangered_chunks_body on lanes
}
