//! Loops of linear peridynamic solids over the bonds of a neighbour list, generic over dimension and
//! instruction set.
//!
//! The pass over points reads rows of displacements and computes dilatations. The pass over bonds reads rows
//! with the displacement and p = A θ/m of both ends. Bonds are processed in groups of eight. The lanes of a
//! sum are added in a fixed order, so that the values of a point depend on its neighbours only.

use super::bonds::SolidBonds;
use super::breaking::{BreakRule, break_row};
use super::kinematics::Kinematics;
use crate::family::BondList;
use crate::lanes::{F64x8, Lanes, for_each_instruction_set};
use crate::neighbourhood::Tally;
use crate::operator::records::Records;
use crate::operator::rows::Rows;

/// Σ ω r e of a point, and the range of its strains t.
struct Extension<T> {
    sum: T,
    largest: T,
    smallest: T,
}

/// Returns the sum of the lanes in a fixed order.
#[inline(always)]
pub(super) fn sum<T: Lanes>(lanes: T) -> f64 {
    F64x8(lanes.to_array()).sum()
}

/// Returns the groups of a point relative to its block.
#[inline(always)]
pub(super) fn groups_of(list: &BondList, i: usize, first_point: usize) -> std::ops::Range<usize> {
    let start = list.start();
    start[i] - start[first_point]..start[i + 1] - start[first_point]
}

#[inline(always)]
fn extension<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    u: &Records,
    i: usize,
    intact: &[u8],
) -> Extension<T> {
    let here = bonds.here::<T, D>(i, u);
    let zero = T::splat(0.0);
    let mut extension = Extension {
        sum: zero,
        largest: zero,
        smallest: zero,
    };
    let first = bonds.list.start()[i];
    // No closure or adapter here: without inlining it would use baseline instructions.
    for k in 0..intact.len() {
        if intact[k] == 0 {
            continue;
        }
        let bond = bonds.group(first + k, &here, u);
        let t = L::strain(bond.xi, bond.eta, bond.inverse_square).masked(intact[k]);
        extension.largest = t.max(extension.largest);
        extension.smallest = t.min(extension.smallest);
        extension.sum = (bond.weight * bond.square).mul_add(L::stretch(t), extension.sum);
    }
    extension
}

/// Returns Σ ω r e by the exact law, for any strains.
#[inline(always)]
fn exact_extension<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    u: &Records,
    i: usize,
    intact: &[u8],
) -> T {
    let here = bonds.here::<T, D>(i, u);
    let mut total = T::splat(0.0);
    let first = bonds.list.start()[i];
    for k in 0..intact.len() {
        if intact[k] == 0 {
            continue;
        }
        let bond = bonds.group(first + k, &here, u);
        let t = L::strain(bond.xi, bond.eta, bond.inverse_square).masked(intact[k]);
        total = (bond.weight * bond.square).mul_add(L::exact_stretch(t), total);
    }
    total
}

/// Returns whether a strain exceeds the range of the fast form.
#[inline(always)]
fn beyond<T: Lanes, L: Kinematics>(largest: T, smallest: T) -> bool {
    let reach = T::splat(L::REACH);
    largest.greater(reach) | (-smallest).greater(reach) != 0
}

/// Selects the fast or exact form by the strains of the bonds of the point only, so that the sum does not
/// depend on which other points are computed with it.
#[inline(always)]
fn settled<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    u: &Records,
    i: usize,
    intact: &[u8],
    extension: Extension<T>,
) -> f64 {
    if beyond::<T, L>(extension.largest, extension.smallest) {
        sum(exact_extension::<T, L, D>(bonds, u, i, intact))
    } else {
        sum(extension.sum)
    }
}

/// Returns Σ ω r e of a point.
#[inline(always)]
pub(super) fn extension_of<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    u: &Records,
    i: usize,
    intact: &[u8],
) -> f64 {
    let extension = extension::<T, L, D>(bonds, u, i, intact);
    settled::<T, L, D>(bonds, u, i, intact, extension)
}

#[inline(always)]
fn dilatation_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    factors: &[f64],
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 1],
) {
    for k in 0..rows.count() {
        let i = rows.at(k);
        let intact = &intact[groups_of(bonds.list, i, rows.first)];
        let extension = extension_of::<T, L, D>(bonds, u, i, intact);
        out[0][i - rows.first] = factors[i] * extension;
    }
}

/// Fraction of the threshold above which bonds of a row are checked individually; the margin exceeds the
/// rounding error of the fast form.
const WATCH: f64 = 1.0 - 1e-9;

#[inline(always)]
fn accept_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    rule: &BreakRule<'_>,
    u: &Records,
    intact: &mut [u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 1],
    tally: &mut Tally,
) {
    let watch = T::splat(rule.threshold * WATCH);
    for k in 0..rows.count() {
        let i = rows.at(k);
        let intact = &mut intact[groups_of(bonds.list, i, rows.first)];
        // Repeated if bonds have broken. A loop gives the compiler a single copy of the body.
        let extension = loop {
            let extension = extension::<T, L, D>(bonds, u, i, intact);
            let endangered = extension.largest.greater(watch) != 0;
            if !(endangered && break_row::<L, D>(bonds, rule, u, i, intact, tally)) {
                break extension;
            }
        };
        let extension = settled::<T, L, D>(bonds, u, i, intact, extension);
        out[0][i - rows.first] = rule.states.dilatation[i] * extension;
    }
}

/// Returns the force on a point by the exact law, for any strains.
#[inline(always)]
fn exact_force<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    u: &Records,
    i: usize,
    intact: &[u8],
) -> [T; D] {
    let here = bonds.here::<T, D>(i, u);
    let mut force = [T::splat(0.0); D];
    let first = bonds.list.start()[i];
    for k in 0..intact.len() {
        if intact[k] == 0 {
            continue;
        }
        let bond = bonds.group(first + k, &here, u);
        let t = L::strain(bond.xi, bond.eta, bond.inverse_square);
        let pull = L::exact_pull(t, bond.last, bond.stiffness);
        let pull = (bond.weight * pull).masked(intact[k]);
        let direction = L::direction(bond.xi, bond.eta);
        for c in 0..D {
            force[c] = pull.mul_add(direction[c], force[c]);
        }
    }
    force
}

#[inline(always)]
fn force_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    for row in 0..rows.count() {
        let i = rows.at(row);
        let intact = &intact[groups_of(bonds.list, i, rows.first)];
        let here = bonds.here::<T, D>(i, u);
        let zero = T::splat(0.0);
        let (mut largest, mut smallest, mut force) = (zero, zero, [zero; D]);
        let first = bonds.list.start()[i];
        for k in 0..intact.len() {
            if intact[k] == 0 {
                continue;
            }
            let bond = bonds.group(first + k, &here, u);
            let t = L::strain(bond.xi, bond.eta, bond.inverse_square).masked(intact[k]);
            largest = t.max(largest);
            smallest = t.min(smallest);
            let pull = L::pull(t, bond.last, bond.stiffness);
            let pull = (bond.weight * pull).masked(intact[k]);
            let direction = L::direction(bond.xi, bond.eta);
            for c in 0..D {
                force[c] = pull.mul_add(direction[c], force[c]);
            }
        }
        if beyond::<T, L>(largest, smallest) {
            force = exact_force::<T, L, D>(bonds, u, i, intact);
        }
        for c in 0..D {
            out[c][i - rows.first] += sum(force[c]);
        }
    }
}

#[inline(always)]
fn square_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
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
            let bond = bonds.group(first + k, &here, u);
            let stretch = L::exact_stretch(L::strain(bond.xi, bond.eta, bond.inverse_square));
            let square = bond.factor * bond.weight * bond.square * stretch * stretch;
            total = total + square.masked(intact[groups.start + k]);
        }
        out[0][i - rows.first] = sum(total);
    }
}

/// Returns the derivative of the stretch ψ in the direction d: (r/|y|) y·d/r².
#[inline(always)]
pub(super) fn stretch_change<T: Lanes, L: Kinematics, const D: usize>(
    xi: [T; D],
    eta: [T; D],
    d: [T; D],
    t: T,
    inverse_square: T,
) -> T {
    let direction = L::direction(xi, eta);
    let mut along = direction[0] * d[0];
    for c in 1..D {
        along = direction[c].mul_add(d[c], along);
    }
    along * L::contraction(t) * inverse_square
}

#[inline(always)]
fn dilatation_change_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    factors: &[f64],
    u: &Records,
    direction: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 1],
) {
    for k in 0..rows.count() {
        let i = rows.at(k);
        let here = bonds.here::<T, D>(i, u);
        let mut direction_here = [T::splat(0.0); D];
        for c in 0..D {
            direction_here[c] = T::splat(direction[i][c]);
        }
        let groups = groups_of(bonds.list, i, rows.first);
        let first = bonds.list.start()[i];
        let mut total = T::splat(0.0);
        for k in 0..groups.len() {
            let bond = bonds.group(first + k, &here, u);
            let there = bonds.there::<T>(first + k, direction);
            let mut d = direction_here;
            for c in 0..D {
                d[c] = there[c] - direction_here[c];
            }
            let t = L::strain(bond.xi, bond.eta, bond.inverse_square);
            let stretch = stretch_change::<T, L, D>(bond.xi, bond.eta, d, t, bond.inverse_square);
            let change = bond.weight * bond.square * stretch;
            total = total + change.masked(intact[groups.start + k]);
        }
        out[0][i - rows.first] = factors[i] * sum(total);
    }
}

#[inline(always)]
fn tangent_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    u: &Records,
    direction: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    for k in 0..rows.count() {
        let i = rows.at(k);
        let here = bonds.here::<T, D>(i, u);
        let mut direction_here = [T::splat(0.0); D];
        for c in 0..D {
            direction_here[c] = T::splat(direction[i][c]);
        }
        let change_here = T::splat(direction[i][3]);
        let groups = groups_of(bonds.list, i, rows.first);
        let first = bonds.list.start()[i];
        let mut total = [T::splat(0.0); D];
        for k in 0..groups.len() {
            let bond = bonds.group(first + k, &here, u);
            let there = bonds.there::<T>(first + k, direction);
            let mut d = direction_here;
            for c in 0..D {
                d[c] = there[c] - direction_here[c];
            }
            let (xi, eta, p, s) = (bond.xi, bond.eta, bond.last, bond.stiffness);
            let t = L::strain(xi, eta, bond.inverse_square);
            let stretch = stretch_change::<T, L, D>(xi, eta, d, t, bond.inverse_square);
            let along = bond.weight * L::pull_change(t, p, s, stretch, change_here + there[3]);
            let along = along.masked(intact[groups.start + k]);
            let axis = L::direction(xi, eta);
            for c in 0..D {
                total[c] = along.mul_add(axis[c], total[c]);
            }
            if !L::LINEAR {
                let turn = bond.weight * L::exact_pull(t, p, s);
                let turn = turn.masked(intact[groups.start + k]);
                for c in 0..D {
                    total[c] = turn.mul_add(d[c], total[c]);
                }
            }
        }
        for c in 0..D {
            out[c][i - rows.first] += sum(total[c]);
        }
    }
}

for_each_instruction_set! {
    /// Sets the dilatations of the rows: `factors` (D/m of each point) times Σ ω r e.
    pub(super) fn dilatation_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        factors: &[f64],
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
    ) = dilatation_rows_body on lanes
}

for_each_instruction_set! {
    /// Breaks over-stretched bonds of the rows and sets the dilatations from the intact bonds.
    pub(super) fn accept_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        rule: &BreakRule<'_>,
        u: &Records,
        intact: &mut [u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
        tally: &mut Tally,
    ) = accept_rows_body on lanes
}

for_each_instruction_set! {
    /// Adds the force density of the rows; the fourth entry of the rows of `u` is p.
    pub(super) fn force_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = force_rows_body on lanes
}

for_each_instruction_set! {
    /// Sets Σ g ω e² of the rows, with the factors g of bonds near surfaces.
    pub(super) fn square_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
    ) = square_rows_body on lanes
}

for_each_instruction_set! {
    /// Sets the derivative of the dilatation of the rows in a direction.
    pub(super) fn dilatation_change_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        factors: &[f64],
        u: &Records,
        direction: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
    ) = dilatation_change_rows_body on lanes
}

for_each_instruction_set! {
    /// Adds the derivative of the force density of the rows in a direction; the fourth entry of the rows of
    /// the direction is the change of p.
    pub(super) fn tangent_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        u: &Records,
        direction: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = tangent_rows_body on lanes
}
