//! Loops over the bonds of a neighbour list, generic over law, dimension and instruction set.
//!
//! The bonds of a point are processed in groups of eight. Neighbours are read as rows of four numbers and
//! transposed to lanes in registers. The only data read per bond are the index of the neighbour and one bit:
//! ξ, |ξ|, weight and volume follow from positions. The lanes of the sum are added in a fixed order, so that
//! the force on a point depends on its neighbours only.

use super::arrays::Bonds;
use super::breaking::{BreakRule, break_row};
use crate::family::BondList;
use crate::lanes::{F64x8, Lanes, for_each_instruction_set, vector};
use crate::neighbourhood::Tally;
use crate::operator::fast_law::VectorLaw;
use crate::operator::records::Records;
use crate::operator::rows::Rows;

/// Force on a point in the fast form, and the range of its strains t.
struct Fast<T, const D: usize> {
    sum: [T; D],
    largest: T,
    smallest: T,
}

#[inline(always)]
fn fast_force<T: Lanes, L: VectorLaw, const D: usize>(
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
    // No closure or adapter here: without inlining it would use baseline instructions.
    for k in 0..intact.len() {
        let group = first + k;
        let mask = intact[k] & bonds.wanted(group);
        if mask == 0 {
            continue;
        }
        let (bond, eta) = bonds.group::<T, L, D>(group, &here, u);
        let t = L::strain(&bond, eta).masked(mask);
        fast.largest = t.max(fast.largest);
        fast.smallest = t.min(fast.smallest);
        L::add_force(&bond, eta, t, mask, &mut fast.sum);
    }
    fast
}

/// Returns the force on a point by the exact law, for any strains.
#[inline(always)]
fn exact_force<T: Lanes, L: VectorLaw, const D: usize>(
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
        let (bond, eta) = bonds.group::<T, L, D>(group, &here, u);
        let force = L::force(bond.xi, eta);
        for c in 0..D {
            sum[c] = sum[c] + (bond.stiffness * force[c]).masked(mask);
        }
    }
    sum
}

/// Returns the sum of the lanes in a fixed order.
#[inline(always)]
fn sum<T: Lanes>(lanes: T) -> f64 {
    F64x8(lanes.to_array()).sum()
}

/// Adds the force on a point. The exact law is used if the strain of one of its own bonds exceeds the range
/// of the fast form, so that the force does not depend on which other points are computed with it.
#[inline(always)]
fn add_point_force<T: Lanes, L: VectorLaw, const D: usize>(
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

/// Returns the groups of a point relative to its block.
#[inline(always)]
fn groups_of(list: &BondList, i: usize, first_point: usize) -> std::ops::Range<usize> {
    let start = list.start();
    start[i] - start[first_point]..start[i + 1] - start[first_point]
}

#[inline(always)]
fn force_rows_body<T: Lanes, L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    for k in 0..rows.count() {
        let i = rows.at(k);
        let intact = &intact[groups_of(bonds.list, i, rows.first)];
        let fast = fast_force::<T, L, D>(bonds, u, i, intact);
        add_point_force::<T, L, D>(bonds, u, i, intact, fast, i - rows.first, out);
    }
}

/// Fraction of the threshold above which bonds of a row are checked individually; the margin exceeds the
/// rounding error of the fast form.
const WATCH: f64 = 1.0 - 1e-9;

#[inline(always)]
fn accept_rows_body<T: Lanes, L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    rule: &BreakRule<'_>,
    u: &Records,
    intact: &mut [u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
    tally: &mut Tally,
) {
    let watch = T::splat(rule.threshold * WATCH);
    for k in 0..rows.count() {
        let i = rows.at(k);
        let intact = &mut intact[groups_of(bonds.list, i, rows.first)];
        // Repeated if bonds have broken. A loop gives the compiler a single copy of the body.
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
fn energy_rows_body<T: Lanes, L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 1],
) {
    for k in 0..rows.count() {
        let i = rows.at(k);
        let here = bonds.here::<T, D>(i, u);
        let groups = groups_of(bonds.list, i, rows.first);
        let first = bonds.list.start()[i];
        let mut total = T::splat(0.0);
        for k in 0..groups.len() {
            let (bond, eta) = bonds.group::<T, L, D>(first + k, &here, u);
            let energy = bond.stiffness * L::energy(bond.xi, eta);
            total = total + energy.masked(intact[groups.start + k]);
        }
        out[0][i - rows.first] += 0.5 * sum(total);
    }
}

#[inline(always)]
fn tangent_rows_body<T: Lanes, L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    u: &Records,
    direction: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    for k in 0..rows.count() {
        let i = rows.at(k);
        let here = bonds.here::<T, D>(i, u);
        let site = bonds.list.site(i);
        let direction_here: [T; D] = vector(|c| T::splat(direction[site][c]));
        let groups = groups_of(bonds.list, i, rows.first);
        let first = bonds.list.start()[i];
        let mut total = [T::splat(0.0); D];
        for k in 0..groups.len() {
            let (bond, eta) = bonds.group::<T, L, D>(first + k, &here, u);
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
    /// Adds the force density of the rows to `out` (indexed from the first point of the block).
    pub(super) fn force_rows [L: VectorLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = force_rows_body on lanes
}

for_each_instruction_set! {
    /// Breaks over-stretched bonds of the rows and adds the force density of the intact bonds.
    pub(super) fn accept_rows [L: VectorLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        rule: &BreakRule<'_>,
        u: &Records,
        intact: &mut [u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
        tally: &mut Tally,
    ) = accept_rows_body on lanes
}

for_each_instruction_set! {
    /// Adds the energy density of the rows to `out`.
    pub(super) fn energy_rows [L: VectorLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
    ) = energy_rows_body on lanes
}

for_each_instruction_set! {
    /// Adds the derivative of the force density in a direction to `out`.
    pub(super) fn tangent_rows [L: VectorLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        u: &Records,
        direction: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = tangent_rows_body on lanes
}
