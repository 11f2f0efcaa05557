//! Bonds of the nodes of a regular lattice.

mod build;
mod layout;
mod rows;
mod runs;
mod stencil;
mod stored;

use std::sync::Arc;

use rayon::prelude::*;

pub(crate) use build::NO_LATTICE;
pub use layout::{Chunk, GridLayout};
pub use stencil::Stencil;

use super::Neighbourhood;
use super::form::{CountedBond, Form};
use super::tally::{BlockDamage, BondPlace, BreakEvent, DamageMeasure};
use crate::archive::Archive;
use crate::domain::Letter;
use crate::error::{PericlesError, Result};
use crate::family::BondCut;
use crate::lanes::LANES;
use crate::parallel::{Cost, PointSubset};
use crate::space::{PointCloud, Sites};

/// The bonds of a lattice body: one stencil for all nodes.
///
/// Eight nodes of a row along x are a [`Chunk`]. The bits of a block are one byte per chunk and offset of the stencil,
/// offsets fastest: bit l of a byte is the bond of lane l of the chunk.
#[derive(Debug, Clone)]
pub struct Lattice {
    sites: Sites,
    layout: Arc<GridLayout>,
    stencil: Stencil,
    /// All bonds before pre-cracks by blocks, if points have different horizons or pieces; otherwise they follow from the
    /// layout.
    geometric: Option<Vec<Vec<u8>>>,
    /// Sites whose bonds never break, one byte per place (in chunks).
    held: Option<Vec<u8>>,
    /// Bonds removed by each pre-crack.
    cuts: Vec<BondCut>,
    /// Bonds cut by pre-cracks: groups (chunk · offsets + offset) in ascending order with bits of their bonds.
    precut: Vec<(u64, u8)>,
    directed_bonds: u64,
}

impl Lattice {
    /// The sites: end points of bonds.
    pub fn sites(&self) -> &Sites {
        &self.sites
    }

    /// Points and their places in padded rows.
    pub fn layout(&self) -> &Arc<GridLayout> {
        &self.layout
    }

    /// The family of a node.
    pub fn stencil(&self) -> &Stencil {
        &self.stencil
    }

    /// The bonds removed by each pre-crack.
    pub fn cuts(&self) -> &[BondCut] {
        &self.cuts
    }

    /// Returns the point at the other end of a bond of an offset from a place; ghosts are numbered after own points.
    pub fn point_beyond(&self, place: usize, offset: usize) -> usize {
        let there = place.wrapping_add_signed(self.stencil.shifts()[offset]);
        self.layout.point_at(there)
    }

    /// Returns the points of a chunk with a bond of an offset before pre-cracks.
    fn family(&self, number: usize, offset: usize) -> u8 {
        match &self.geometric {
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

    /// Returns the bonds cut by pre-cracks from a chunk on.
    fn precut_from(&self, chunk: usize) -> &[(u64, u8)] {
        let first = (chunk * self.stencil.len()) as u64;
        &self.precut[self.precut.partition_point(|&(group, _)| group < first)..]
    }

    /// Returns the places whose bonds never break, one byte per chunk of places; `None` if there are none.
    pub fn held_places(&self) -> Option<&[u8]> {
        self.held.as_deref()
    }

    /// Returns the bonds of a chunk and offset that may break.
    pub fn breakable(&self, chunk: &Chunk, offset: usize) -> u8 {
        let Some(held) = &self.held else { return 0xFF };
        let cell = self.stencil.cells()[offset];
        let there = self.layout.neighbour_bits(chunk, cell, |place| held[place]);
        !(held[chunk.place as usize] | there)
    }

    /// Returns the place of the bond of an offset in a lane of a chunk.
    fn place_in(&self, chunk: usize, offset: usize, lane: usize) -> BondPlace {
        let block = self.layout.block_of(chunk);
        let first = self.layout.chunks_of(block).start;
        BondPlace {
            block,
            group: (chunk - first) * self.stencil.len() + offset,
            lane,
        }
    }

    /// Checks that all intact bonds are bonds of the body: others would lead beyond its points.
    fn check_bonds(&self, blocks: &[BlockDamage]) -> Result<()> {
        let m = self.stencil.len();
        let mut precut = self.precut.iter().peekable();
        for (block, state) in blocks.iter().enumerate() {
            let numbers = self.layout.chunks_of(block);
            for (number, intact) in numbers.zip(state.intact.chunks(m)) {
                let chunk = &self.layout.chunks()[number];
                for offset in 0..m {
                    let group = (number * m + offset) as u64;
                    let cut = precut.next_if(|&&(at, _)| at == group);
                    let family = self.family(number, offset) & !cut.map_or(0, |cut| cut.1);
                    if intact[offset] & !family != 0 {
                        let point = self.cloud().user_number(chunk.point as usize);
                        let reason =
                            format!("its bonds near point {point} are not bonds of the body");
                        return Err(PericlesError::BadArchive { reason });
                    }
                }
            }
        }
        Ok(())
    }
}

impl Form for Lattice {
    const NAME: &'static str = "operator/grid";

    fn cloud(&self) -> &Arc<PointCloud> {
        self.sites.cloud()
    }

    fn initial_bits(&self) -> Vec<Vec<u8>> {
        let m = self.stencil.len();
        let bits = |block: usize| -> Vec<u8> {
            let chunks = self.layout.chunks_of(block);
            let mut precut = self.precut_from(chunks.start).iter().peekable();
            let groups = chunks.flat_map(|number| (0..m).map(move |offset| (number, offset)));
            let bits = groups.map(|(number, offset)| {
                let group = (number * m + offset) as u64;
                let cut = precut.next_if(|&&(at, _)| at == group);
                self.family(number, offset) & !cut.map_or(0, |cut| cut.1)
            });
            bits.collect()
        };
        let blocks = (0..self.layout.blocks()).into_par_iter();
        blocks.map(bits).collect()
    }

    fn first_point(&self, block: usize) -> usize {
        self.layout.first_point(block)
    }

    fn directed_bonds(&self) -> u64 {
        self.directed_bonds
    }

    fn cost(&self, on: &PointSubset<'_>) -> Cost {
        Cost::bonds(self.directed_bonds).on(on, self.points())
    }

    fn for_each_counted(
        &self,
        block: usize,
        intact: &[u8],
        measure: DamageMeasure,
        mut visit: impl FnMut(CountedBond),
    ) {
        let (m, chunks) = (self.stencil.len(), self.layout.chunks_of(block));
        let mut precut = self.precut_from(chunks.start).iter().peekable();
        for (number, intact) in chunks.zip(intact.chunks(m)) {
            let chunk = &self.layout.chunks()[number];
            for offset in 0..m {
                let group = number * m + offset;
                let cut = precut.next_if(|&&(at, _)| at == group as u64);
                let mut family = self.family(number, offset);
                if let (Some((_, cut)), false) = (cut, measure.count_precut) {
                    family &= !cut;
                }
                for (lane, point) in chunk.points().filter(|(lane, _)| family >> lane & 1 == 1) {
                    visit(CountedBond {
                        point,
                        entry: group * LANES + lane,
                        weight: match measure.count {
                            true => 1.0,
                            false => self.stencil.volumes()[offset],
                        },
                        intact: intact[offset] >> lane & 1 == 1,
                    });
                }
            }
        }
    }

    fn for_each_intact_of(&self, blocks: &[BlockDamage], i: usize, visit: &mut dyn FnMut(usize)) {
        let place = self.layout.place_of(i);
        let (chunk, lane) = self.layout.chunk_at(place);
        let BondPlace { block, group, .. } = self.place_in(chunk, 0, lane);
        let intact = &blocks[block].intact[group..group + self.stencil.len()];
        for (&bits, &shift) in intact.iter().zip(self.stencil.shifts()) {
            if bits >> lane & 1 == 1 {
                let j = self.layout.point_at(place.wrapping_add_signed(shift));
                if j != i {
                    visit(j);
                }
            }
        }
    }

    fn for_each_neighbour(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        let place = self.layout.place_of(i);
        let (number, lane) = self.layout.chunk_at(place);
        let m = self.stencil.len();
        let mut near = Vec::new();
        for k in 0..m {
            let mut family = self.family(number, k);
            let group = (number * m + k) as u64;
            let cut = self.precut.binary_search_by_key(&group, |&(at, _)| at);
            if let Ok(found) = cut {
                family &= !self.precut[found].1;
            }
            if family >> lane & 1 == 1 {
                near.push(self.point_beyond(place, k));
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

    fn letter(&self, event: &BreakEvent) -> Letter {
        let (group, lane) = (event.entry / LANES, event.entry % LANES);
        let (chunk, offset) = (group / self.stencil.len(), group % self.stencil.len());
        let place = self.layout.chunks()[chunk].place as usize * LANES + lane;
        let back = self.stencil.opposite(offset) as f64;
        Letter {
            from: self.layout.point_at(place),
            to: self.point_beyond(place, offset),
            numbers: [event.dissipated, back, 0.0, 0.0],
        }
    }

    fn place_of(&self, letter: &Letter) -> Option<BondPlace> {
        let (chunk, lane) = self.layout.chunk_at(self.layout.place_of(letter.to));
        Some(self.place_in(chunk, letter.numbers[1] as usize, lane))
    }

    fn bytes(&self) -> usize {
        let masks = |blocks: &Vec<Vec<u8>>| blocks.iter().map(Vec::len).sum();
        self.layout.bytes()
            + self.geometric.as_ref().map_or(0, masks)
            + self.held.as_ref().map_or(0, Vec::len)
            + size_of_val(&self.precut[..])
    }

    fn save(&self, blocks: &[BlockDamage], archive: &mut Archive) {
        stored::save(self, blocks, archive);
    }

    fn restore(&self, blocks: &mut [BlockDamage], archive: &Archive) -> Result<()> {
        stored::restore(self, blocks, archive)?;
        self.check_bonds(blocks)
    }
}

impl Neighbourhood<Lattice> {
    /// Returns the place of an own point in the padded rows and the offsets of its intact bonds.
    pub fn bonds_of(&self, i: usize) -> (usize, impl Iterator<Item = usize> + '_) {
        let (layout, m) = (self.form().layout(), self.form().stencil().len());
        let place = layout.place_of(i);
        let (chunk, lane) = layout.chunk_at(place);
        let BondPlace { block, group, .. } = self.form().place_in(chunk, 0, lane);
        let intact = &self.blocks()[block].intact[group..group + m];
        let left = (0..m).filter(move |&k| intact[k] >> lane & 1 == 1);
        (place, left)
    }

    /// Calls `visit(first point of the block, number of the chunk, its intact bonds, values of the block)` for all chunks.
    pub fn for_each_chunk(
        &self,
        values: &mut [f64],
        visit: impl Fn(usize, usize, &[u8], &mut [f64]) + Sync,
    ) {
        let (form, m) = (self.form(), self.form().stencil().len());
        let cost = form.cost(&PointSubset::All);
        self.for_each_block::<1>(cost, values, |block, intact, [values]| {
            let first = form.first_point(block);
            for (number, intact) in form.layout.chunks_of(block).zip(intact.chunks(m)) {
                visit(first, number, intact, values);
            }
        });
    }
}
