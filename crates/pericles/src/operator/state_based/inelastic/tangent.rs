//! Directional derivatives of both passes of inelastic solids.

use super::super::bonds::SolidBonds;
use super::super::kernels::{groups_of, stretch_change, sum};
use super::super::kinematics::Kinematics;
use super::advance::{influence_of, inverse};
use super::kernels::{Points, Reliefs};
use super::laws::{Relaxation, mean_square};
use crate::lanes::{LANES, Lanes, for_each_instruction_set};
use crate::material::{Inelasticity, Yield};
use crate::operator::records::Records;
use crate::operator::rows::Rows;

/// A direction with the displacement at which the derivative is taken.
#[derive(Clone, Copy)]
pub(super) struct Along<'a> {
    pub u: &'a Records,
    pub direction: &'a Records,
}

/// Returns the change of the stretches of a group.
#[inline(always)]
fn stretch_changes<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    along: &Along<'_>,
    group: usize,
    from: [T; D],
    bond: &super::super::bonds::Bond<T, D>,
) -> ([T; D], T) {
    let there = bonds.there::<T>(group, along.direction);
    let mut d = from;
    for c in 0..D {
        d[c] = there[c] - from[c];
    }
    let t = L::strain(bond.xi, bond.eta, bond.inverse_square);
    let change = stretch_change::<T, L, D>(bond.xi, bond.eta, d, t, bond.inverse_square);
    (d, change)
}

#[inline(always)]
fn vector_at<T: Lanes, const D: usize>(rows: &Records, i: usize) -> [T; D] {
    let mut vector = [T::splat(0.0); D];
    for c in 0..D {
        vector[c] = T::splat(rows[i][c]);
    }
    vector
}

#[inline(always)]
fn change_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    points: &Points<'_>,
    thetas: &[f64],
    along: &Along<'_>,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 3],
) {
    for row in 0..rows.count() {
        let i = rows.at(row);
        let (at, site) = (i - rows.first, bonds.list.site(i));
        let change = out[0][at];
        let pressure = points.states.pressure[site] * change;
        let extension = change * inverse(points.states.dilatation[i]);
        let over = inverse(points.history.volume[i]);
        let s = points.states.stiffness[site];
        [out[1][at], out[2][at]] = match &points.laws.of_material[points.classes.of_point(site)] {
            Inelasticity::Elastic => [pressure, 0.0],
            Inelasticity::Viscous(terms) => {
                let dt = (points.t - points.history.time[i]).max(0.0);
                let relaxed = Relaxation::new(terms, dt).relaxed();
                [pressure + s * relaxed * extension * over, 0.0]
            }
            Inelasticity::Plastic(law) => {
                let intact = &intact[groups_of(bonds.list, i, rows.first)];
                let [mean, stiffness] = plastic_change::<T, L, D>(
                    bonds,
                    points,
                    law,
                    along,
                    intact,
                    i,
                    [thetas[i], extension * over],
                );
                [pressure + mean, stiffness]
            }
        };
    }
}

/// Returns the changes of s (1 − γ) q and of γ s of a plastic point with the mean q of ψ − x, from its
/// dilatation and the change of q.
#[inline(always)]
fn plastic_change<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    points: &Points<'_>,
    law: &Yield,
    along: &Along<'_>,
    intact: &[u8],
    i: usize,
    [theta, mean_change]: [f64; 2],
) -> [f64; 2] {
    let site = bonds.list.site(i);
    let here = bonds.here::<T, D>(i, along.u);
    let from = vector_at::<T, D>(along.direction, site);
    let point = points.plastic::<T, L, D>(bonds, along.u, i, intact, theta);
    let first = bonds.list.start()[i];
    let (mut norm, mut square) = (T::splat(0.0), T::splat(0.0));
    for k in 0..intact.len() {
        if intact[k] == 0 {
            continue;
        }
        let bond = bonds.group(first + k, &here, along.u);
        let stretch = L::exact_stretch(L::strain(bond.xi, bond.eta, bond.inverse_square));
        let x = T::load(&points.history.inelastic, (first + k) * LANES);
        let deviator = stretch - x - T::splat(point.mean);
        let (_, change) = stretch_changes::<T, L, D>(bonds, along, first + k, from, &bond);
        let change = change - T::splat(mean_change);
        let w = influence_of(
            points.influence,
            first + k,
            bond.square,
            bond.inverse_square,
        );
        let term = (bond.weight * bond.square * deviator * change).masked(intact[k]);
        square = square + term;
        norm = norm + (w * term).masked(intact[k]);
    }
    let (s, trial) = (points.states.stiffness[site], &point.trial);
    let over_volume = points.states.dilatation[i] / D as f64;
    let norm = s * s * sum(norm) * inverse(trial.norm);
    let equivalent = mean_square(D) * over_volume * sum(square) * inverse(trial.equivalent);
    let (factor, change) = (
        trial.factor(law),
        trial.factor_change(law, norm, equivalent),
    );
    [
        s * ((1.0 - factor) * mean_change - change * point.mean),
        s * change,
    ]
}

#[inline(always)]
fn tangent_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    reliefs: &Reliefs<'_>,
    changes: &Records,
    along: &Along<'_>,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    for row in 0..rows.count() {
        let i = rows.at(row);
        let site = bonds.list.site(i);
        let intact = &intact[groups_of(bonds.list, i, rows.first)];
        let here = bonds.here::<T, D>(i, along.u);
        let from = vector_at::<T, D>(along.direction, site);
        let pull_here = T::splat(along.direction[site][3]);
        let (own, own_change) = (&reliefs.states[site], &changes[site]);
        let first = bonds.list.start()[i];
        let mut total = [T::splat(0.0); D];
        for k in 0..intact.len() {
            if intact[k] == 0 {
                continue;
            }
            let bond = bonds.group(first + k, &here, along.u);
            let there = bonds.there::<T>(first + k, reliefs.states);
            let change_there = bonds.there::<T>(first + k, changes);
            let pull_there = bonds.there::<T>(first + k, along.direction)[3];
            let [forth, back] = reliefs.of_group::<T>(first + k);
            let p = bond.last - (T::splat(own[1]) * forth + there[1] * back);
            let s = T::splat(own[0]) + there[0];
            let t = L::strain(bond.xi, bond.eta, bond.inverse_square);
            let (d, stretch) = stretch_changes::<T, L, D>(bonds, along, first + k, from, &bond);
            // Changes of P, S and G at both ends.
            let relief = T::splat(own_change[1]) * forth + change_there[1] * back;
            let stiffness = T::splat(own_change[0]) + change_there[0];
            let pull = pull_here + pull_there - relief;
            let pull = L::exact_stretch(t).mul_add(stiffness, pull);
            let radial = bond.weight * L::pull_change(t, p, s, stretch, pull);
            let radial = radial.masked(intact[k]);
            let axis = L::direction(bond.xi, bond.eta);
            for c in 0..D {
                total[c] = radial.mul_add(axis[c], total[c]);
            }
            if !L::LINEAR {
                let turn = (bond.weight * L::exact_pull(t, p, s)).masked(intact[k]);
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
    /// Sets the derivatives of P and S of the rows in a direction; the change of the dilatation is the first
    /// array of `out`.
    pub(super) fn change_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        points: &Points<'_>,
        thetas: &[f64],
        along: &Along<'_>,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 3],
    ) = change_rows_body on lanes
}

for_each_instruction_set! {
    /// Adds the derivative of the force density of the rows in a direction; the fourth entry of the rows of
    /// the direction is the change of P, and `changes` contains the changes of S and G.
    pub(super) fn tangent_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        reliefs: &Reliefs<'_>,
        changes: &Records,
        along: &Along<'_>,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = tangent_rows_body on lanes
}
