//! Bonds of a list on a lattice by their offset.

use std::ops::Range;

use rayon::prelude::*;

use super::force::BondForce;
use crate::operator::fast_law::VectorLaw;
use crate::operator::{LatticeSpring, LatticeSprings};
use crate::parallel::BLOCK;

impl<L: VectorLaw, const D: usize> BondForce<L, D> {
    /// Returns the stiffest intact bond of each offset; `None` for points that are not a lattice of cubic
    /// cells or have different volumes or horizons.
    pub(super) fn springs_of_offsets(&self) -> Option<LatticeSprings> {
        let (sites, domain) = (self.bonds.form().sites(), self.cloud.domain());
        let lattice = sites.places().lattice().filter(|one| one.is_cubic(D))?;
        let spacing = lattice.spacing[0];
        let largest = self.cloud.volumes().iter().copied().fold(0.0, f64::max);
        let volume = domain.max(largest);
        if !domain.all(self.cloud.volumes().iter().all(|own| *own == volume)) {
            return None;
        }
        let list = self.bonds.form();
        let reach = list.correction().reach(list.uniform_horizon()?, spacing);
        let cells = (reach / spacing).floor();
        // Bonds do not exceed the body and its images; for larger reaches plane waves are expensive.
        let most = cells.min(lattice.shape.iter().copied().max()? as f64) as usize;
        let width = 2 * most + 1;
        let places = width.checked_pow(D as u32).filter(|&p| p <= 1 << 20)?;
        let coordinates = |site: usize| lattice.coordinates(lattice.node[site]);
        let offset = |a: usize, b: usize| {
            let (from, to) = (coordinates(a), coordinates(b));
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
                let here = sites.of_point(i);
                for (entry, b) in self.bonds.intact_of(i) {
                    let stiffness = self.stiffness_of(entry, i, b) / list.length(here, b);
                    let largest = &mut stiffest[place(offset(here, b))];
                    // The caller rejects NaN and negative values.
                    *largest = if stiffness >= 0.0 && !largest.is_nan() {
                        largest.max(stiffness)
                    } else {
                        f64::NAN
                    };
                }
            }
            stiffest
        };
        let n = self.cloud.len();
        let blocks = n.div_ceil(BLOCK);
        let parts = rayon::current_num_threads().clamp(1, blocks);
        let mut stiffest = (0..parts)
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
        // A maximum over processes must not contain NaN.
        let usable = domain.all(stiffest.iter().all(|stiffness| !stiffness.is_nan()));
        if usable {
            domain.max_each(&mut stiffest);
        }
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
