//! Arrays of the bonds of a state-based material read by the loops.

use rayon::prelude::*;

use super::weight::Weight;
use crate::domain::Field;
use crate::family::BondList;
use crate::lanes::{Lanes, Row, dot};
use crate::operator::list::stiffness::Stiffness;
use crate::operator::records::Records;
use crate::parallel::BLOCK;
use crate::space::Sites;

/// Data of sites, in rows of four numbers, and of their bonds, read by the loops.
pub(super) struct Layout {
    /// Reference coordinates in units of `unit`, followed by the stiffness s = B/m of the force state of the
    /// point, N/m⁴ per weighted volume, or by the volume of the point if volumes or cells differ.
    reference: Vec<Row>,
    /// s and the cell size, if volumes or cells differ.
    own: Option<Vec<Row>>,
    unit: [f64; 3],
    volume: f64,
    cell: f64,
}

impl Layout {
    /// Creates the layout of sites with the stiffness s.
    pub fn new(sites: &Sites, stiffness: &[f64]) -> Self {
        let cloud = sites.places();
        let volumes = cloud.volumes();
        let first = cloud.cell_size(0);
        let alike =
            (0..cloud.len()).all(|i| volumes[i] == volumes[0] && cloud.cell_size(i) == first);
        let row = |i: usize| {
            let [x, y, z] = match cloud.lattice() {
                Some(lattice) => lattice.coordinates(lattice.node[i]).map(f64::from),
                None => cloud.point(i),
            };
            Row([x, y, z, if alike { stiffness[i] } else { volumes[i] }])
        };
        let own = |i: usize| Row([stiffness[i], cloud.cell_size(i), 0.0, 0.0]);
        Self {
            reference: (0..cloud.len()).map(row).collect(),
            own: (!alike).then(|| (0..cloud.len()).map(own).collect()),
            unit: cloud.lattice().map_or([1.0; 3], |lattice| lattice.spacing),
            volume: volumes.first().copied().unwrap_or(0.0),
            cell: first,
        }
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.reference[..]) + self.own.as_ref().map_or(0, |own| size_of_val(&own[..]))
    }

    fn volume_and_cell(&self, i: usize) -> [f64; 2] {
        match &self.own {
            Some(own) => [self.reference[i][3], own[i][1]],
            None => [self.volume, self.cell],
        }
    }
}

/// Writes a vector on points, followed by a number per site, to the rows of all sites.
pub(super) fn pack<const D: usize>(
    u: Field<'_>,
    sites: &Sites,
    last: impl Fn(usize) -> f64 + Sync,
    rows: &mut [Row],
) {
    rows.par_chunks_mut(8 * BLOCK)
        .enumerate()
        .for_each(|(part, rows)| {
            let first = part * 8 * BLOCK;
            for (site, row) in (first..).zip(rows) {
                let point = sites.point(site);
                for c in 0..D {
                    row[c] = u.at::<D>(c, point);
                }
                row[3] = last(site);
            }
        });
}

/// A neighbour list with layout and weights.
#[derive(Clone, Copy)]
pub(super) struct SolidBonds<'a> {
    pub list: &'a BondList,
    pub layout: &'a Layout,
    pub weight: &'a Weight,
    /// Factors of the stiffness of bonds near surfaces, with surface correction.
    pub factor: Option<&'a Stiffness>,
}

/// Data shared by all bonds of a point.
pub(super) struct Here<T, const D: usize> {
    reference: [T; D],
    u: [T; D],
    /// s of the point.
    stiffness: T,
    cell: T,
    /// Fourth entry of the row of the point.
    last: T,
}

/// Eight bonds in lanes.
pub(super) struct Bond<T, const D: usize> {
    pub xi: [T; D],
    pub eta: [T; D],
    /// |ξ|²
    pub square: T,
    pub inverse_square: T,
    /// ω
    pub weight: T,
    /// Sum of s of both ends times the factor of the bond.
    pub stiffness: T,
    /// Factor of the bond.
    pub factor: T,
    /// Fourth entries of the rows of both ends: p, if rows contain it.
    pub last: T,
}

impl<'a> SolidBonds<'a> {
    #[inline(always)]
    pub fn here<T: Lanes, const D: usize>(&self, i: usize, u: &Records) -> Here<T, D> {
        let i = self.list.site(i);
        let reference = &self.layout.reference[i];
        let (stiffness, cell) = match &self.layout.own {
            Some(own) => (own[i][0], own[i][1]),
            None => (reference[3], self.layout.cell),
        };
        // No closures here: without inlining they would use baseline instructions.
        let (mut place, mut moved) = ([T::splat(0.0); D], [T::splat(0.0); D]);
        for c in 0..D {
            place[c] = T::splat(reference[c]);
            moved[c] = T::splat(u[i][c]);
        }
        Here {
            reference: place,
            u: moved,
            stiffness: T::splat(stiffness),
            cell: T::splat(cell),
            last: T::splat(u[i][3]),
        }
    }

    /// Returns the rows of the neighbours of a group.
    #[inline(always)]
    pub fn there<T: Lanes>(&self, group: usize, rows: &Records) -> [T; 4] {
        assert!(
            rows.len() == self.layout.reference.len(),
            "a row for every site"
        );
        let indices = self.list.group(group);
        // SAFETY: `BondList` guarantees that neighbours are below the number of sites, which is the number of
        // rows.
        unsafe { T::gather(rows, indices) }
    }

    /// Returns the eight bonds of a group.
    #[inline(always)]
    pub fn group<T: Lanes, const D: usize>(
        &self,
        group: usize,
        here: &Here<T, D>,
        u: &Records,
    ) -> Bond<T, D> {
        let reference = self.there::<T>(group, &self.layout.reference);
        let there = self.there::<T>(group, u);
        let (mut xi, mut eta) = ([T::splat(0.0); D], [T::splat(0.0); D]);
        for c in 0..D {
            xi[c] = (reference[c] - here.reference[c]) * T::splat(self.layout.unit[c]);
            eta[c] = there[c] - here.u[c];
        }
        let mut square = xi[0] * xi[0];
        for c in 1..D {
            square = xi[c].mul_add(xi[c], square);
        }
        let inverse = square.inverse_root();
        let r = square * inverse;
        let (stiffness, volume, cell) = match &self.layout.own {
            None => (reference[3], T::splat(self.layout.volume), here.cell),
            Some(own) => {
                let own = self.there::<T>(group, own);
                (own[0], reference[3], own[1])
            }
        };
        let factor = match self.factor {
            None => T::splat(1.0),
            Some(factors) => factors.of_group(group, r, volume, [cell, cell]),
        };
        Bond {
            xi,
            eta,
            square,
            inverse_square: inverse * inverse,
            weight: self
                .weight
                .of_group(group, r, inverse, volume, [here.cell, cell]),
            stiffness: factor * (here.stiffness + stiffness),
            factor,
            last: here.last + there[3],
        }
    }

    /// Returns ξ of the bond between two sites, m.
    pub fn vector<const D: usize>(&self, a: usize, b: usize) -> [f64; D] {
        let (from, to) = (&self.layout.reference[a], &self.layout.reference[b]);
        std::array::from_fn(|c| (to[c] - from[c]) * self.layout.unit[c])
    }

    /// Returns ω of an entry from site a to site b along ξ.
    pub fn weight_of<const D: usize>(&self, entry: usize, [a, b]: [usize; 2], xi: [f64; D]) -> f64 {
        let [_, from] = self.layout.volume_and_cell(a);
        let [volume, to] = self.layout.volume_and_cell(b);
        let r = dot(xi, xi).sqrt();
        self.weight.of_entry(entry, r, volume, [from, to])
    }
}

impl SolidBonds<'_> {
    /// Returns the factor of the stiffness of an entry.
    pub fn factor_of(&self, entry: usize) -> f64 {
        self.factor
            .map_or(1.0, |factors| factors.of_entry(entry, 0.0, 0.0, [0.0; 2]))
    }
}

/// Returns the difference of the vectors of two sites.
pub(super) fn difference<const D: usize>(u: &Records, a: usize, b: usize) -> [f64; D] {
    std::array::from_fn(|c| u[b][c] - u[a][c])
}
