//! The loops over listed bonds, one text for every law, dimension and instruction set.
//!
//! A point's bonds are taken eight at a time. Neighbours are read as rows of four numbers and turned into lanes in registers. Nothing is read of
//! a bond but its neighbour's number and one bit: ξ and with it |ξ|, weight and volume follow from the positions. The lanes of the sum are added in a fixed order, so a
//! point's force depends on nothing but its neighbours.

use super::breaking::{BreakRule, break_row};
use super::stiffness::Stiffness;
use crate::family::{BondList, LANES};
use crate::operator::damage::Tally;
use crate::operator::fast_law::{FastLaw, FixedBond};
use crate::operator::lanes::{F64x8, Lanes, dot, for_each_instruction_set, vector};
use crate::operator::records::Records;
use crate::operator::rows::Rows;

/// A bond list as the loops see it.
pub(super) struct Bonds<'a> {
    list: &'a BondList,
    /// Reference coordinates in units of `unit`; behind them the volume of the point, m³.
    reference: &'a Records,
    /// Length of one coordinate unit, m.
    unit: f64,
    stiffness: &'a Stiffness,
    /// Marks of the points whose bonds count; all of them if none.
    partners: Option<&'a [bool]>,
}

/// What all bonds of a point share.
struct Here<T, const D: usize> {
    reference: [T; D],
    u: [T; D],
    cell: T,
}

impl<'a> Bonds<'a> {
    /// # Panics
    /// If there are not as many rows as points.
    pub fn new(
        list: &'a BondList,
        reference: &'a Records,
        unit: f64,
        stiffness: &'a Stiffness,
    ) -> Self {
        assert_eq!(reference.len(), list.len(), "a row for every point");
        Self {
            list,
            reference,
            unit,
            stiffness,
            partners: None,
        }
    }

    /// The same bonds, as far as they lead to marked points.
    pub fn leading_to(self, partners: Option<&'a [bool]>) -> Self {
        Self { partners, ..self }
    }

    pub fn list(&self) -> &BondList {
        self.list
    }

    /// ξ of one bond, m.
    pub fn vector<const D: usize>(&self, i: usize, j: usize) -> [f64; D] {
        std::array::from_fn(|c| (self.reference[j][c] - self.reference[i][c]) * self.unit)
    }

    #[inline(always)]
    fn here<T: Lanes, const D: usize>(&self, i: usize, u: &Records) -> Here<T, D> {
        Here {
            reference: vector(|c| T::splat(self.reference[i][c])),
            u: vector(|c| T::splat(u[i][c])),
            cell: T::splat(u[i][3]),
        }
    }

    /// The rows of the neighbours of a group.
    #[inline(always)]
    fn there<T: Lanes>(&self, group: usize, field: &Records) -> [T; 4] {
        assert!(field.len() == self.list.len(), "a row for every point");
        let indices = self.list.group(group);
        // SAFETY: neighbours are below the number of points, which `BondList` guarantees, and the field has as many rows.
        unsafe { T::gather(field, indices) }
    }

    /// The eight bonds of a group, and their η.
    #[inline(always)]
    fn group<T: Lanes, const D: usize>(
        &self,
        group: usize,
        here: &Here<T, D>,
        u: &Records,
    ) -> (FixedBond<T, D>, [T; D]) {
        let reference = self.there::<T>(group, self.reference);
        let there = self.there::<T>(group, u);
        let xi: [T; D] = vector(|c| (reference[c] - here.reference[c]) * T::splat(self.unit));
        let eta = vector(|c| there[c] - here.u[c]);
        let mut square = xi[0] * xi[0];
        for c in 1..D {
            square = xi[c].mul_add(xi[c], square);
        }
        let inverse = square.inverse_root();
        let cells = [here.cell, there[3]];
        let stiffness = self
            .stiffness
            .of_group(group, square * inverse, reference[3], cells);
        let bond = FixedBond {
            xi,
            inverse_square: inverse * inverse,
            stiffness,
            factor: stiffness * inverse,
        };
        (bond, eta)
    }

    /// Stiffness c α κ V of an entry that leads from i to j, whose cells have the sizes given, m.
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

    /// Bits of the bonds of a group that count.
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

/// The force of a point in the fast form, and the range of the strains t it was computed from.
struct Fast<T, const D: usize> {
    sum: [T; D],
    largest: T,
    smallest: T,
}

#[inline(always)]
fn fast_force<T: Lanes, L: FastLaw, const D: usize>(
    bonds: &Bonds<'_>,
    u: &Records,
    i: usize,
    intact: &[u8],
) -> Fast<T, D> {
    let here = bonds.here::<T, D>(i, u);
    let zero = T::splat(0.0);
    let mut fast = Fast {
        sum: [zero; D],
        largest: zero,
        smallest: zero,
    };
    let first = bonds.list.start()[i];
    // No closure and no adapter here: one that is not inlined would take the baseline's instructions.
    for k in 0..intact.len() {
        let group = first + k;
        let mask = intact[k] & bonds.wanted(group);
        if mask == 0 {
            continue;
        }
        let (bond, eta) = bonds.group(group, &here, u);
        let t = L::strain(&bond, eta).masked(mask);
        fast.largest = t.max(fast.largest);
        fast.smallest = t.min(fast.smallest);
        L::add_force(&bond, eta, t, mask, &mut fast.sum);
    }
    fast
}

/// The force of a point by the law itself, however large the strains.
#[inline(always)]
fn exact_force<T: Lanes, L: FastLaw, const D: usize>(
    bonds: &Bonds<'_>,
    u: &Records,
    i: usize,
    intact: &[u8],
) -> [T; D] {
    let here = bonds.here::<T, D>(i, u);
    let mut sum = [T::splat(0.0); D];
    let first = bonds.list.start()[i];
    for k in 0..intact.len() {
        let group = first + k;
        let mask = intact[k] & bonds.wanted(group);
        if mask == 0 {
            continue;
        }
        let (bond, eta) = bonds.group(group, &here, u);
        let force = L::force(bond.xi, eta);
        for c in 0..D {
            sum[c] = sum[c] + (bond.stiffness * force[c]).masked(mask);
        }
    }
    sum
}

/// The sum of the lanes, in a fixed order.
#[inline(always)]
fn sum<T: Lanes>(lanes: T) -> f64 {
    F64x8(lanes.to_array()).sum()
}

/// Adds the force of a point. It takes the exact form if one of its own bonds is strained beyond the fast form's reach, so that a point's force does not depend on
/// which other points are computed beside it.
#[inline(always)]
fn add_point_force<T: Lanes, L: FastLaw, const D: usize>(
    bonds: &Bonds<'_>,
    u: &Records,
    i: usize,
    intact: &[u8],
    fast: Fast<T, D>,
    at: usize,
    out: &mut [&mut [f64]; D],
) {
    let reach = T::splat(L::REACH);
    let beyond = fast.largest.greater(reach) | (-fast.smallest).greater(reach);
    let force = if beyond == 0 {
        fast.sum
    } else {
        exact_force::<T, L, D>(bonds, u, i, intact)
    };
    for c in 0..D {
        out[c][at] += sum(force[c]);
    }
}

/// The groups of a point among those of its block.
#[inline(always)]
fn groups_of(list: &BondList, i: usize, first_point: usize) -> std::ops::Range<usize> {
    let start = list.start();
    start[i] - start[first_point]..start[i + 1] - start[first_point]
}

#[inline(always)]
fn force_rows_body<T: Lanes, L: FastLaw, const D: usize>(
    bonds: &Bonds<'_>,
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    for k in 0..rows.len() {
        let i = rows.at(k);
        let intact = &intact[groups_of(bonds.list, i, rows.first)];
        let fast = fast_force::<T, L, D>(bonds, u, i, intact);
        add_point_force::<T, L, D>(bonds, u, i, intact, fast, i - rows.first, out);
    }
}

/// t above which a row is looked at bond by bond: below the threshold by more than the fast form's rounding.
const WATCH: f64 = 1.0 - 1e-9;

#[inline(always)]
fn accept_rows_body<T: Lanes, L: FastLaw, const D: usize>(
    bonds: &Bonds<'_>,
    rule: &BreakRule<'_, D>,
    u: &Records,
    intact: &mut [u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
    tally: &mut Tally,
) {
    let watch = T::splat(rule.threshold * WATCH);
    for k in 0..rows.len() {
        let i = rows.at(k);
        let intact = &mut intact[groups_of(bonds.list, i, rows.first)];
        // Once more if bonds have broken: a loop, so that the compiler has one copy of its body.
        let fast = loop {
            let fast = fast_force::<T, L, D>(bonds, u, i, intact);
            let endangered = fast.largest.greater(watch) != 0;
            if !(endangered && break_row::<L, D>(bonds, rule, u, i, intact, tally)) {
                break fast;
            }
        };
        add_point_force::<T, L, D>(bonds, u, i, intact, fast, i - rows.first, out);
    }
}

#[inline(always)]
fn energy_rows_body<T: Lanes, L: FastLaw, const D: usize>(
    bonds: &Bonds<'_>,
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 1],
) {
    for k in 0..rows.len() {
        let i = rows.at(k);
        let here = bonds.here::<T, D>(i, u);
        let groups = groups_of(bonds.list, i, rows.first);
        let first = bonds.list.start()[i];
        let mut total = T::splat(0.0);
        for k in 0..groups.len() {
            let (bond, eta) = bonds.group(first + k, &here, u);
            let energy = bond.stiffness * L::energy(bond.xi, eta);
            total = total + energy.masked(intact[groups.start + k]);
        }
        out[0][i - rows.first] += 0.5 * sum(total);
    }
}

#[inline(always)]
fn tangent_rows_body<T: Lanes, L: FastLaw, const D: usize>(
    bonds: &Bonds<'_>,
    u: &Records,
    direction: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    for k in 0..rows.len() {
        let i = rows.at(k);
        let here = bonds.here::<T, D>(i, u);
        let direction_here: [T; D] = vector(|c| T::splat(direction[i][c]));
        let groups = groups_of(bonds.list, i, rows.first);
        let first = bonds.list.start()[i];
        let mut total = [T::splat(0.0); D];
        for k in 0..groups.len() {
            let (bond, eta) = bonds.group(first + k, &here, u);
            let there = bonds.there::<T>(first + k, direction);
            let d = vector(|c| there[c] - direction_here[c]);
            let force = L::tangent(bond.xi, eta, d);
            for c in 0..D {
                total[c] = total[c] + (bond.stiffness * force[c]).masked(intact[groups.start + k]);
            }
        }
        for c in 0..D {
            out[c][i - rows.first] = sum(total[c]);
        }
    }
}

for_each_instruction_set! {
    /// Adds the force density of the rows to `out` (indexed from the block's first point).
    pub(super) fn force_rows [L: FastLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = force_rows_body on lanes
}

for_each_instruction_set! {
    /// Breaks over-stretched bonds of the rows and adds the force density of those that are left.
    pub(super) fn accept_rows [L: FastLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        rule: &BreakRule<'_, D>,
        u: &Records,
        intact: &mut [u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
        tally: &mut Tally,
    ) = accept_rows_body on lanes
}

for_each_instruction_set! {
    /// Adds the energy density of the rows to `out`.
    pub(super) fn energy_rows [L: FastLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
    ) = energy_rows_body on lanes
}

for_each_instruction_set! {
    /// The derivative of the force density in a direction.
    pub(super) fn tangent_rows [L: FastLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        u: &Records,
        direction: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = tangent_rows_body on lanes
}
