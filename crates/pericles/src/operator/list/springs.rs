//! The bonds of a list on a lattice by their offset.

use std::ops::Range;

use rayon::prelude::*;

use super::force::BondForce;
use crate::operator::fast_law::FastLaw;
use crate::operator::{LatticeSpring, LatticeSprings};
use crate::parallel::BLOCK;

impl<L: FastLaw, const D: usize> BondForce<L, D> {
    /// The stiffest intact bond of every offset; none of points that are no lattice, or of different volumes or horizons.
    pub(super) fn springs_of_offsets(&self) -> Option<LatticeSprings> {
        let lattice = self.cloud.lattice()?;
        let volumes = self.cloud.volumes();
        if volumes.iter().any(|volume| *volume != volumes[0]) {
            return None;
        }
        let reach = self
            .bonds
            .correction()
            .reach(self.bonds.uniform_horizon()?, lattice.spacing);
        let cells = (reach / lattice.spacing).floor();
        // Bonds reach no farther than the body; beyond that size plane waves are dear.
        let most = cells.min(lattice.shape.iter().copied().max()? as f64) as usize;
        let width = 2 * most + 1;
        let places = width.checked_pow(D as u32).filter(|&p| p <= 1 << 20)?;
        let coordinates = |i: usize| lattice.coordinates(lattice.node[i]);
        let offset = |i: usize, j: usize| {
            let (from, to) = (coordinates(i), coordinates(j));
            std::array::from_fn::<i32, 3, _>(|c| to[c] - from[c])
        };
        let place = |offset: [i32; 3]| {
            (0..D).rev().fold(0, |place, c| {
                place * width + (offset[c] + most as i32) as usize
            })
        };
        let of_block = |points: Range<usize>| {
            let mut stiffest = vec![f64::NEG_INFINITY; places];
            for i in points {
                for (entry, j) in self.bonds.family(i) {
                    if self.is_intact(i, entry) {
                        let length = self.bonds.length(&self.cloud, i, j);
                        let stiffness = self.stiffness_of(entry, i, j) / length;
                        let largest = &mut stiffest[place(offset(i, j))];
                        // NaN and negative numbers are refused by the caller.
                        *largest = if stiffness >= 0.0 && !largest.is_nan() {
                            largest.max(stiffness)
                        } else {
                            f64::NAN
                        };
                    }
                }
            }
            stiffest
        };
        let n = self.cloud.len();
        let blocks = n.div_ceil(BLOCK);
        let parts = rayon::current_num_threads().clamp(1, blocks);
        let stiffest = (0..parts)
            .into_par_iter()
            .map(|part| of_block(part * n / parts..(part + 1) * n / parts))
            .reduce_with(|mut a, b| {
                for (a, b) in a.iter_mut().zip(b) {
                    *a = if a.is_nan() || b.is_nan() {
                        f64::NAN
                    } else {
                        a.max(b)
                    };
                }
                a
            })?;
        let springs = stiffest
            .iter()
            .enumerate()
            .filter(|(_, w)| **w != f64::NEG_INFINITY);
        LatticeSprings::new(
            D,
            springs.map(|(place, &stiffness)| LatticeSpring {
                offset: std::array::from_fn(|c| {
                    if c < D {
                        (place / width.pow(c as u32) % width) as i32 - most as i32
                    } else {
                        0
                    }
                }),
                stiffness,
            }),
        )
    }
}
