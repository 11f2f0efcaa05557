//! Arrays of a neighbour list read by the loops.

use super::stiffness::Stiffness;
use crate::family::BondList;
use crate::lanes::LANES;
use crate::lanes::{Lanes, dot, vector};
use crate::material::PairForce;
use crate::neighbourhood::{Neighbourhood, origin_of_entry};
use crate::operator::fast_law::FixedBond;
use crate::operator::records::Records;

/// Arrays of a neighbour list read by the loops.
pub(super) struct Bonds<'a> {
    pub(super) list: &'a BondList,
    /// Reference coordinates in units of `unit`, followed by the volume of the point, m³.
    reference: &'a Records,
    /// Length of one unit along each axis, m.
    unit: [f64; 3],
    stiffness: &'a Stiffness,
    /// Marks of the sites whose bonds are included; `None`: all.
    pub(super) partners: Option<&'a [bool]>,
    /// Rows that begin with the thermal stretch τ of a site; `None` for a body without thermal expansion.
    heat: Option<&'a Records>,
    /// η₀ of the bonds of a growing body, as in [`Neighbourhood::origin`](crate::neighbourhood::Neighbourhood::origin).
    origin: &'a [f64],
}

/// Data shared by all bonds of a point.
pub(super) struct Here<T, const D: usize> {
    reference: [T; D],
    u: [T; D],
    cell: T,
    /// Thermal stretch τ.
    heat: T,
}

impl<'a> Bonds<'a> {
    /// # Panics
    /// If the numbers of rows and sites differ.
    pub fn new(
        bonds: &'a Neighbourhood<BondList>,
        reference: &'a Records,
        unit: [f64; 3],
        stiffness: &'a Stiffness,
    ) -> Self {
        let list = bonds.form();
        assert_eq!(reference.len(), list.sites().len(), "a row for every site");
        Self {
            list,
            reference,
            unit,
            stiffness,
            partners: None,
            heat: None,
            origin: bonds.origin(),
        }
    }

    /// Restricts the bonds to those that lead to marked sites.
    pub fn leading_to(self, partners: Option<&'a [bool]>) -> Self {
        Self { partners, ..self }
    }

    /// Sets the thermal stretches of sites.
    pub fn heated(self, heat: Option<&'a Records>) -> Self {
        Self { heat, ..self }
    }

    /// Returns the vectors (1 + τ) ξ₀ and η − η₀ − τ ξ₀ of the bond of an entry between two sites, to which its law is
    /// applied, and the factor 1 + τ of its stiffness. ξ₀ is ξ + η₀, or ξ for a linear law.
    pub fn relative<L: PairForce, const D: usize>(
        &self,
        entry: usize,
        [i, j]: [usize; 2],
        xi: [f64; D],
        eta: [f64; D],
    ) -> ([f64; D], [f64; D], f64) {
        let origin: [f64; D] = origin_of_entry(self.origin, entry);
        let eta = std::array::from_fn(|c| eta[c] - origin[c]);
        let xi = match L::LINEAR {
            true => xi,
            false => std::array::from_fn(|c| xi[c] + origin[c]),
        };
        let Some(heat) = self.heat else {
            return (xi, eta, 1.0);
        };
        let stretch = 0.5 * (heat[i][0] + heat[j][0]);
        let scale = 1.0 + stretch;
        let pulled = std::array::from_fn(|c| eta[c] - stretch * xi[c]);
        (xi.map(|x| scale * x), pulled, scale)
    }

    pub fn list(&self) -> &BondList {
        self.list
    }

    /// Returns ξ of the bond between two sites, m.
    pub fn vector<const D: usize>(&self, i: usize, j: usize) -> [f64; D] {
        std::array::from_fn(|c| (self.reference[j][c] - self.reference[i][c]) * self.unit[c])
    }

    /// Returns the data shared by all bonds of point i.
    #[inline(always)]
    pub(super) fn here<T: Lanes, const D: usize>(&self, i: usize, u: &Records) -> Here<T, D> {
        let i = self.list.site(i);
        Here {
            reference: vector(|c| T::splat(self.reference[i][c])),
            u: vector(|c| T::splat(u[i][c])),
            cell: T::splat(u[i][3]),
            heat: T::splat(self.heat.map_or(0.0, |heat| heat[i][0])),
        }
    }

    /// Returns the rows of the neighbours of a group.
    #[inline(always)]
    pub(super) fn there<T: Lanes>(&self, group: usize, field: &Records) -> [T; 4] {
        assert!(field.len() == self.reference.len(), "a row for every site");
        let indices = self.list.group(group);
        // SAFETY: `BondList` guarantees that neighbours are below the number of sites, which is the number of
        // rows of the field.
        unsafe { T::gather(field, indices) }
    }

    /// Returns the eight bonds of a group, with ξ₀ in place of ξ, and their η − η₀; see [`Bonds::relative`].
    #[inline(always)]
    pub(super) fn group<T: Lanes, L: PairForce, const D: usize>(
        &self,
        group: usize,
        here: &Here<T, D>,
        u: &Records,
    ) -> (FixedBond<T, D>, [T; D]) {
        let reference = self.there::<T>(group, self.reference);
        let there = self.there::<T>(group, u);
        let mut xi: [T; D] =
            vector(|c| (reference[c] - here.reference[c]) * T::splat(self.unit[c]));
        let mut eta: [T; D] = vector(|c| there[c] - here.u[c]);
        let mut square = xi[0] * xi[0];
        for c in 1..D {
            square = xi[c].mul_add(xi[c], square);
        }
        let mut inverse = square.inverse_root();
        let cells = [here.cell, there[3]];
        let stiffness = self
            .stiffness
            .of_group(group, square * inverse, reference[3], cells);
        if !self.origin.is_empty() {
            for c in 0..D {
                let origin = T::load(self.origin, (group * D + c) * LANES);
                eta[c] = eta[c] - origin;
                if !L::LINEAR {
                    xi[c] = xi[c] + origin;
                }
            }
            if !L::LINEAR {
                let mut square = xi[0] * xi[0];
                for c in 1..D {
                    square = xi[c].mul_add(xi[c], square);
                }
                inverse = square.inverse_root();
            }
        }
        let bond = FixedBond {
            xi,
            inverse_square: inverse * inverse,
            stiffness,
            factor: stiffness * inverse,
        };
        if let Some(heat) = self.heat {
            let both = here.heat + self.there::<T>(group, heat)[0];
            return bond.expanded(T::splat(0.5) * both, eta);
        }
        (bond, eta)
    }

    /// Returns the stiffness c α κ V of an entry from site i to site j, whose cells have the given sizes, m.
    pub fn stiffness_of<const D: usize>(
        &self,
        entry: usize,
        [i, j]: [usize; 2],
        cells: [f64; 2],
    ) -> f64 {
        let xi: [f64; D] = self.vector(i, j);
        let volume = self.reference[j][3];
        self.stiffness
            .of_entry(entry, dot(xi, xi).sqrt(), volume, cells)
    }

    /// Returns the bits of the included bonds of a group.
    #[inline(always)]
    pub fn wanted(&self, group: usize) -> u8 {
        let Some(marks) = self.partners else {
            return 0xFF;
        };
        let neighbours = self.list.group(group);
        let mut bits = 0;
        for k in 0..LANES {
            bits |= u8::from(marks[neighbours[k]]) << k;
        }
        bits
    }
}
