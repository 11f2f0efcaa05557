//! Queries of individual bonds and families of a lattice body, shared by all stencil kernels.

use super::layout::{Chunk, GridLayout};
use super::stencil::Stencil;
use crate::error::{PericlesError, Result};
use crate::lanes::LANES;
use crate::operator::DamageMeasure;
use crate::operator::damage::BlockDamage;
use crate::parallel::{Cost, components_mut, for_each_part};
use crate::space::PointCloud;

/// The intact bonds of a lattice body and those cut by pre-cracks.
#[derive(Clone, Copy)]
pub(in crate::operator) struct Families<'a, const D: usize> {
    pub cloud: &'a PointCloud,
    pub layout: &'a GridLayout,
    pub stencil: &'a Stencil<D>,
    /// Intact bonds: one byte per chunk and offset, offsets fastest.
    pub blocks: &'a [BlockDamage],
    /// All bonds before pre-cracks, as in `blocks`; `None` if they follow from the layout.
    pub geometric: Option<&'a [Vec<u8>]>,
    /// Sites whose bonds never break, one byte per place (in chunks).
    pub held: Option<&'a [u8]>,
    /// Bonds cut by pre-cracks: groups in ascending order with bits of their bonds.
    pub precut: &'a [(u64, u8)],
    pub damage: DamageMeasure,
}

impl<const D: usize> Families<'_, D> {
    /// Returns the points of a chunk with a bond of an offset before pre-cracks.
    pub fn family(&self, number: usize, offset: usize) -> u8 {
        match self.geometric {
            None => {
                let chunk = &self.layout.chunks()[number];
                self.layout.neighbours(chunk, self.stencil.cells()[offset])
            }
            Some(geometric) => {
                let block = self.layout.block_of(number);
                let first = self.layout.chunks_of(block).start;
                geometric[block][(number - first) * self.stencil.len() + offset]
            }
        }
    }

    /// Returns the bonds of a chunk and offset that may break.
    pub fn breakable(&self, chunk: &Chunk, offset: usize) -> u8 {
        let Some(held) = self.held else { return 0xFF };
        let cell = self.stencil.cells()[offset];
        let there = self.layout.neighbour_bits(chunk, cell, |place| held[place]);
        !(held[chunk.place as usize] | there)
    }

    /// Checks that all intact bonds are bonds of the body: others would lead beyond its points.
    pub fn check_bonds(&self) -> Result<()> {
        let m = self.stencil.len();
        let mut precut = self.precut.iter().peekable();
        for (block, state) in self.blocks.iter().enumerate() {
            let numbers = self.layout.chunks_of(block);
            for (number, intact) in numbers.zip(state.intact.chunks(m)) {
                let chunk = &self.layout.chunks()[number];
                for offset in 0..m {
                    let group = (number * m + offset) as u64;
                    let cut = precut.next_if(|&&(at, _)| at == group);
                    let family = self.family(number, offset) & !cut.map_or(0, |cut| cut.1);
                    if intact[offset] & !family != 0 {
                        let point = self.cloud.user_number(chunk.point as usize);
                        let reason =
                            format!("its bonds near point {point} are not bonds of the body");
                        return Err(PericlesError::BadArchive { reason });
                    }
                }
            }
        }
        Ok(())
    }

    /// Calls `visit(first point of the block, chunk, its intact bonds, values of the block)` for each chunk,
    /// in parallel.
    pub fn for_each_block(
        &self,
        values: &mut [f64],
        visit: impl Fn(usize, usize, &[u8], &mut [f64]) + Sync,
    ) {
        let m = self.stencil.len();
        let mut nothing = vec![(); self.blocks.len()];
        for_each_part(
            components_mut::<1>(values, self.cloud.len()),
            &mut nothing,
            Cost::bonds((m * self.cloud.len()) as u64),
            &|block| self.layout.first_point(block),
            &|block, [values], ()| {
                let first = self.layout.first_point(block);
                let intact = self.blocks[block].intact.chunks(m);
                for (number, intact) in self.layout.chunks_of(block).zip(intact) {
                    visit(first, number, intact, values);
                }
            },
        );
    }

    /// Calls `visit((lane, point), offset, intact)` for all bonds of the geometric families of a chunk that
    /// count in the damage, point by point.
    pub fn for_each_counted(
        &self,
        number: usize,
        intact: &[u8],
        mut visit: impl FnMut((usize, usize), usize, bool),
    ) {
        let m = self.stencil.len();
        let chunk = &self.layout.chunks()[number];
        let first = self
            .precut
            .partition_point(|&(group, _)| group < (number * m) as u64);
        let mut precut = self.precut[first..].iter().peekable();
        for offset in 0..m {
            let mut family = self.family(number, offset);
            if let Some((_, cut)) =
                precut.next_if(|&&(group, _)| group == (number * m + offset) as u64)
                && !self.damage.count_precut
            {
                family &= !cut;
            }
            for (lane, point) in chunk.points() {
                if family >> lane & 1 == 1 {
                    visit((lane, point), offset, intact[offset] >> lane & 1 == 1);
                }
            }
        }
    }

    /// Sets the damage of each point, 0 … 1.
    pub fn damage_into(&self, out: &mut [f64]) {
        let volumes = self.stencil.volumes();
        let mut whole = vec![0.0; self.cloud.len()];
        out.fill(0.0);
        for (sums, all) in [(&mut whole[..], true), (&mut *out, false)] {
            self.for_each_block(sums, |first, number, intact, sums| {
                self.for_each_counted(number, intact, |(_, point), offset, intact| {
                    if intact || all {
                        let weight = if self.damage.count {
                            1.0
                        } else {
                            volumes[offset]
                        };
                        sums[point - first] += weight;
                    }
                });
            });
        }
        for (damage, whole) in out.iter_mut().zip(whole) {
            *damage = if whole > 0.0 {
                1.0 - *damage / whole
            } else {
                0.0
            };
        }
    }

    /// Calls `visit` with both ends of each intact bond, once or twice per bond: an own point, and an own point or a ghost.
    pub fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize)) {
        let (n, offsets) = (self.cloud.len(), self.stencil.offsets());
        let to_ghosts = self.cloud.domain().ghost_points() > 0;
        for (number, block) in self.blocks.iter().enumerate() {
            let chunks = self.layout.chunks_of(number);
            for (chunk, intact) in chunks.zip(block.intact.chunks(offsets.len())) {
                let chunk = &self.layout.chunks()[chunk];
                // Other bonds are visited from their other end, which another process may own.
                let wanted = intact.iter().zip(offsets);
                for (mask, offset) in wanted.filter(|(_, o)| o.shift > 0 || to_ghosts) {
                    for (lane, i) in chunk.points().filter(|(lane, _)| mask >> lane & 1 == 1) {
                        let place = chunk.place as usize * LANES + lane;
                        let there = place.wrapping_add_signed(offset.shift);
                        let j = self.layout.point_at(there);
                        if j != i && (offset.shift > 0 || j >= n) {
                            visit(i, j);
                        }
                    }
                }
            }
        }
    }

    /// Calls `visit` with the other end of each intact bond of point i; ghosts are counted after the own points.
    pub fn for_each_intact_of(self, i: usize, visit: &mut dyn FnMut(usize)) {
        let offsets = self.stencil.offsets();
        let (place, intact) = self.bonds_of(i);
        for k in intact {
            let there = place.wrapping_add_signed(offsets[k].shift);
            let j = self.layout.point_at(there);
            if j != i {
                visit(j);
            }
        }
    }

    /// Calls `visit` once for each point other than i that is initially bonded to own point i; ghosts are counted after the
    /// own points.
    pub fn for_each_neighbour(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        let place = self.layout.place_of(i);
        let (number, lane) = self.layout.chunk_at(place);
        let m = self.stencil.len();
        let mut near = Vec::new();
        for k in 0..m {
            let mut family = self.family(number, k);
            let group = (number * m + k) as u64;
            if let Ok(found) = self
                .precut
                .binary_search_by_key(&group, |&(group, _)| group)
            {
                family &= !self.precut[found].1;
            }
            if family >> lane & 1 == 1 {
                let there = place.wrapping_add_signed(self.stencil.offsets()[k].shift);
                near.push(self.layout.point_at(there));
            }
        }
        if !self.layout.is_of_points() {
            // A point can be a neighbour several times, and its own neighbour.
            near.retain(|&j| j != i);
            near.sort_unstable();
            near.dedup();
        }
        near.into_iter().for_each(visit);
    }
}

impl<'a, const D: usize> Families<'a, D> {
    /// Returns the place of an own point and the offsets of its intact bonds.
    pub fn bonds_of(self, i: usize) -> (usize, impl Iterator<Item = usize> + use<'a, D>) {
        let place = self.layout.place_of(i);
        let (chunk, lane) = self.layout.chunk_at(place);
        let block = self.layout.block_of(chunk);
        let m = self.stencil.len();
        let first = (chunk - self.layout.chunks_of(block).start) * m;
        let intact: &'a [u8] = &self.blocks[block].intact[first..first + m];
        let left = (0..m).filter(move |&k| intact[k] >> lane & 1 == 1);
        (place, left)
    }
}
