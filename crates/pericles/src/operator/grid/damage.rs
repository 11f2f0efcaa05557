//! [`Breakable`] for lattice bodies.

use super::arrays::Grid;
use super::block::{ChunkBlock, scatter};
use super::force::GridForce;
use crate::lanes::LANES;
use crate::lanes::{Lanes, for_each_instruction_set};
use crate::neighbourhood::{BondSet, Chunk};
use crate::operator::fast_law::VectorLaw;
use crate::operator::{Breakable, CoarseBreak, Force, PointSubset};

impl<L: VectorLaw, const D: usize> Breakable for GridForce<L, D> {
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
        let threshold = L::threshold(fraction * self.critical_stretch);
        let mut found = vec![0.0; self.points()];
        let breakable = |chunk: &Chunk, offset: usize| self.bonds.form().breakable(chunk, offset);
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
