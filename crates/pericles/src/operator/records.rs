//! Vectors on points as rows of four numbers: a bond reads its neighbour with one load.

use rayon::prelude::*;

use crate::domain::Field;
use crate::lanes::Row;
use crate::parallel::BLOCK;
use crate::space::Sites;

/// One row per point or site. The meaning of entries after the components depends on the owner.
pub type Records = [Row];

/// Writes a component-major field to the first entries of the rows.
pub fn pack<const D: usize>(field: &[f64], records: &mut Records) {
    let n = records.len();
    records
        .par_chunks_mut(8 * BLOCK)
        .enumerate()
        .for_each(|(part, records)| pack_part::<D>(field, n, part * 8 * BLOCK, records));
}

/// Writes a component-major field to the rows of the points from `first` on.
pub fn pack_part<const D: usize>(field: &[f64], n: usize, first: usize, records: &mut Records) {
    for c in 0..D {
        let component = &field[c * n + first..][..records.len()];
        for (record, number) in records.iter_mut().zip(component) {
            record[c] = *number;
        }
    }
}

/// Writes a vector on points to the rows of all sites.
pub fn pack_sites<const D: usize>(field: Field<'_>, sites: &Sites, records: &mut Records) {
    records
        .par_chunks_mut(8 * BLOCK)
        .enumerate()
        .for_each(|(part, records)| {
            for (site, record) in (part * 8 * BLOCK..).zip(records) {
                for c in 0..D {
                    record[c] = field.at::<D>(c, sites.point(site));
                }
            }
        });
}
