//! Displacements packed as rows once per evaluation.

use rayon::prelude::*;

use crate::domain::Field;
use crate::family::BondList;
use crate::lanes::Row;
use crate::operator::PointSubset;
use crate::operator::records::{Records, pack, pack_part, pack_sites};
use crate::operator::rows::Rows;
use crate::parallel::BLOCK;
use crate::space::Sites;

/// Blocks of points that the bonds of each block lead to, including itself; empty if bonds lead to ghosts or
/// images.
#[derive(Debug, Clone)]
pub(super) struct Reach {
    start: Vec<usize>,
    blocks: Vec<u32>,
}

impl Reach {
    pub fn new(bonds: &BondList) -> Self {
        let n = match bonds.sites().are_points() {
            true => bonds.len(),
            false => 0,
        };
        let rows: Vec<Vec<u32>> = (0..n.div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| {
                let mut seen = vec![block as u32];
                let mut last = block;
                for i in block * BLOCK..((block + 1) * BLOCK).min(n) {
                    for (_, j) in bonds.family(i) {
                        if j / BLOCK != last {
                            last = j / BLOCK;
                            if let Err(at) = seen.binary_search(&(last as u32)) {
                                seen.insert(at, last as u32);
                            }
                        }
                    }
                }
                seen
            })
            .collect();
        let mut start = vec![0];
        start.extend(rows.iter().scan(0, |sum, row| {
            *sum += row.len();
            Some(*sum)
        }));
        Self {
            start,
            blocks: rows.concat(),
        }
    }

    fn of(&self, block: usize) -> &[u32] {
        &self.blocks[self.start[block]..self.start[block + 1]]
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.start[..]) + size_of_val(&self.blocks[..])
    }
}

/// A work array of rows.
pub(super) struct Packed {
    /// Components of a vector field, followed by the cell size of the point.
    rows: Vec<Row>,
    /// Whether each block is packed in this evaluation.
    done: Vec<bool>,
}

impl Packed {
    /// Creates rows with the sizes of cells.
    pub fn new(cells: impl Iterator<Item = f64>) -> Self {
        let rows: Vec<Row> = cells.map(|cell| Row([0.0, 0.0, 0.0, cell])).collect();
        Self {
            done: vec![false; rows.len().div_ceil(BLOCK)],
            rows,
        }
    }

    /// Packs a field for the requested points and their neighbours.
    pub fn fill<const D: usize>(
        &mut self,
        field: Field<'_>,
        on: &PointSubset<'_>,
        sites: &Sites,
        reach: &Reach,
    ) -> &Records {
        if !sites.are_points() {
            pack_sites::<D>(field, sites, &mut self.rows);
            return &self.rows;
        }
        let field = field.owned;
        if let PointSubset::All = on {
            pack::<D>(field, &mut self.rows);
            return &self.rows;
        }
        let n = self.rows.len();
        self.done.fill(false);
        for block in 0..self.done.len() {
            let first = block * BLOCK;
            if Rows::of_block(on, first, n.min(first + BLOCK) - first).is_none() {
                continue;
            }
            for &near in reach.of(block) {
                if !std::mem::replace(&mut self.done[near as usize], true) {
                    let first = near as usize * BLOCK;
                    let end = n.min(first + BLOCK);
                    pack_part::<D>(field, n, first, &mut self.rows[first..end]);
                }
            }
        }
        &self.rows
    }
}
