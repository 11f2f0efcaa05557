//! Stiffness of bonds that depends on both ends: several materials, inclusions, surface correction.

use std::collections::HashMap;

use rayon::prelude::*;

use super::numbers::GridNumber;
use crate::lanes::LANES;
use crate::neighbourhood::{Form, Lattice, Neighbourhood};
use crate::operator::StiffnessFactors;

/// Stiffness of bonds relative to the stencil, per chunk.
///
/// A row has one factor per offset and lane, offsets slowest. Row 0 is one everywhere. Equal rows are stored
/// once: all chunks in the interior of a material share a row, and so do chunks at the same position relative
/// to a straight interface or surface.
#[derive(Debug, Clone)]
pub(super) struct Factors<N> {
    /// Row of each chunk.
    rows: Vec<u32>,
    /// All rows.
    values: Vec<N>,
    /// Largest factor of the bonds of each offset in the body.
    largest: Vec<f64>,
}

/// Factor of the bond from the site of an own point to another site, with its vector ξ, m.
pub(in crate::operator) type OfBond<'a> = dyn Fn(usize, usize, [f64; 3]) -> f64 + Sync + 'a;

/// Distinct rows of a block, and the row of each chunk.
struct BlockRows {
    rows: Vec<Vec<f64>>,
    of_chunk: Vec<usize>,
    /// Largest factor of each offset.
    largest: Vec<f64>,
}

impl Factors<f64> {
    /// Creates the factors of the intact bonds of each block.
    pub fn new(bonds: &Neighbourhood<Lattice>, of: &OfBond<'_>) -> Self {
        let (layout, stencil) = (bonds.form().layout(), bonds.form().stencil());
        let length = stencil.len() * LANES;
        let blocks: Vec<BlockRows> = bonds
            .blocks()
            .par_iter()
            .enumerate()
            .map(|(block, state)| block_rows(bonds.form(), block, &state.intact, of))
            .collect();
        let ones = vec![1.0; length];
        let mut known = HashMap::from([(bits(&ones), 0)]);
        let mut values = ones;
        let mut rows = Vec::with_capacity(layout.chunks().len());
        let mut largest = vec![0.0; stencil.len()];
        for block in blocks {
            for (largest, of_block) in largest.iter_mut().zip(&block.largest) {
                *largest = of_block.max(*largest);
            }
            let mut number = Vec::with_capacity(block.rows.len());
            for row in &block.rows {
                let next = known.len() as u32;
                let found = *known.entry(bits(row)).or_insert(next);
                if found == next {
                    values.extend_from_slice(row);
                }
                number.push(found);
            }
            rows.extend(block.of_chunk.iter().map(|&row| number[row]));
        }
        bonds.form().cloud().domain().max_each(&mut largest);
        Self {
            rows,
            values,
            largest,
        }
    }

    /// Returns the factors in single precision.
    pub fn in_floats(&self) -> Factors<f32> {
        Factors {
            rows: self.rows.clone(),
            values: self
                .values
                .iter()
                .map(|&value| f32::rounded(value))
                .collect(),
            largest: self.largest.clone(),
        }
    }

    /// Returns the factors as data.
    pub fn data(&self) -> StiffnessFactors<'_> {
        StiffnessFactors {
            rows: &self.rows,
            values: &self.values,
        }
    }

    /// Returns the largest factor of an offset.
    pub fn largest(&self, offset: usize) -> f64 {
        self.largest[offset]
    }
}

impl<N: GridNumber> Factors<N> {
    /// Returns the first entries of the factors of the first and last of `count` chunks from `first` on;
    /// `None` if all their bonds have the stiffness of the stencil.
    #[inline(always)]
    pub fn places(&self, first: usize, count: usize) -> Option<[usize; 2]> {
        let length = self.largest.len() * LANES;
        let (low, high) = (self.rows[first], self.rows[first + count - 1]);
        // No iterator adapter here: without inlining it would pass all registers through memory.
        match low | high {
            0 => None,
            _ => Some([low as usize * length, high as usize * length]),
        }
    }

    /// Returns the factors, eight per offset of a row.
    #[inline(always)]
    pub fn values(&self) -> &[N] {
        &self.values
    }

    /// Returns the factor of the bond of an offset and lane of a chunk.
    pub fn of_bond(&self, chunk: usize, offset: usize, lane: usize) -> f64 {
        let length = self.largest.len() * LANES;
        self.values[self.rows[chunk] as usize * length + offset * LANES + lane].into()
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.rows[..]) + size_of_val(&self.values[..])
    }
}

fn block_rows(bonds: &Lattice, block: usize, intact: &[u8], of: &OfBond<'_>) -> BlockRows {
    let (sites, layout, stencil) = (bonds.sites(), bonds.layout(), bonds.stencil());
    let m = stencil.len();
    let mut known = HashMap::new();
    let mut block_rows = BlockRows {
        rows: Vec::new(),
        of_chunk: Vec::new(),
        largest: vec![0.0; m],
    };
    let chunks = &layout.chunks()[layout.chunks_of(block)];
    for (chunk, intact) in chunks.iter().zip(intact.chunks(m)) {
        let mut row = vec![1.0; m * LANES];
        for (lane, i) in chunk.points() {
            let here = sites.of_point(i);
            let place = chunk.place as usize * LANES + lane;
            for (k, &shift) in stencil.shifts().iter().enumerate() {
                if intact[k] >> lane & 1 == 1 {
                    let there = layout.site_at(place.wrapping_add_signed(shift));
                    let factor = of(here, there, stencil.vectors()[k]);
                    row[k * LANES + lane] = factor;
                    block_rows.largest[k] = factor.max(block_rows.largest[k]);
                }
            }
        }
        // If all bonds have the same factor, the row does not depend on which bonds exist.
        if let Some(factor) = common(&row, intact) {
            row.fill(factor);
        }
        let next = block_rows.rows.len();
        let number = *known.entry(bits(&row)).or_insert(next);
        if number == next {
            block_rows.rows.push(row);
        }
        block_rows.of_chunk.push(number);
    }
    block_rows
}

/// Returns the common factor of all bonds of a row; `None` if they differ.
fn common(row: &[f64], intact: &[u8]) -> Option<f64> {
    let mut bonds = row.chunks(LANES).zip(intact).flat_map(|(lanes, &bits)| {
        (0..LANES)
            .filter(move |k| bits >> k & 1 == 1)
            .map(|k| lanes[k])
    });
    let first = bonds.next()?;
    bonds.all(|factor| factor == first).then_some(first)
}

/// Returns the bits of numbers as a key.
fn bits(row: &[f64]) -> Vec<u64> {
    row.iter().map(|factor| factor.to_bits()).collect()
}
