//! Loops at the end of a step: update of inelastic stretches and of the dissipated energy.

use super::super::bonds::SolidBonds;
use super::super::breaking::States;
use super::super::kernels::{groups_of, sum};
use super::super::kinematics::Kinematics;
use super::super::weight::Weight;
use super::history::Part;
use super::laws::{Laws, Relaxation, Trial, mean_square};
use crate::lanes::{LANES, Lanes, for_each_instruction_set};
use crate::material::{Inelasticity, MOST_TERMS, SolidClasses, Yield};
use crate::operator::records::Records;
use crate::operator::rows::Rows;

/// Data of the end of a step read by the loops.
#[derive(Clone, Copy)]
pub(super) struct Advance<'a> {
    pub laws: &'a Laws,
    pub classes: &'a SolidClasses,
    pub states: &'a States,
    pub volumes: &'a [f64],
    /// Influence function w, if a material yields.
    pub influence: Option<&'a Weight>,
    /// Number of viscous terms per bond.
    pub terms: usize,
    /// The time, s.
    pub t: f64,
    /// Whether the run starts: no time has passed and no energy is dissipated.
    pub starts: bool,
}

/// A point with its groups, in the list from `first` on and in its block from `start` on.
#[derive(Clone, Copy)]
struct Point {
    i: usize,
    first: usize,
    start: usize,
    groups: usize,
}

/// Returns the influence function w of a group; one if it is not needed.
#[inline(always)]
pub(super) fn influence_of<T: Lanes>(
    influence: Option<&Weight>,
    group: usize,
    square: T,
    inverse_square: T,
) -> T {
    let (zero, one) = (T::splat(0.0), T::splat(1.0));
    match influence {
        None => one,
        Some(influence) => {
            let inverse = inverse_square.sqrt();
            influence.of_group(group, square * inverse, inverse, one, [zero, zero])
        }
    }
}

/// Returns 1/x, zero for points without bonds.
#[inline(always)]
pub(super) fn inverse(x: f64) -> f64 {
    if x > 0.0 { 1.0 / x } else { 0.0 }
}

#[inline(always)]
fn advance_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    rule: &Advance<'_>,
    u: &Records,
    part: &mut Part<'_>,
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 4],
) {
    let mut relaxation = Relaxation::new(&[], 0.0);
    let mut material = usize::MAX;
    for row in 0..rows.count() {
        let i = rows.at(row);
        let groups = groups_of(bonds.list, i, rows.first);
        let point = Point {
            i,
            first: bonds.list.start()[i],
            start: groups.start,
            groups: groups.len(),
        };
        let at = i - rows.first;
        let own = rule.classes.of_point(bonds.list.site(i));
        let dissipated = match &rule.laws.of_material[own] {
            Inelasticity::Elastic => 0.0,
            Inelasticity::Viscous(terms) => {
                let dt = match rule.starts {
                    true => 0.0,
                    false => (rule.t - out[0][at]).max(0.0),
                };
                if material != own || relaxation.dt != dt {
                    (material, relaxation) = (own, Relaxation::new(terms, dt));
                }
                viscous_row::<T, L, D>(bonds, rule, &relaxation, u, part, point, out[1], at)
            }
            Inelasticity::Plastic(law) => {
                plastic_row::<T, L, D>(bonds, rule, law, u, part, point, out, at)
            }
        };
        if !rule.starts {
            let factor = rule.states.stiffness[bonds.list.site(i)] * rule.volumes[i];
            part.damage.tally.dissipate(i, factor * dissipated);
        }
        out[0][at] = rule.t;
    }
}

/// Updates the back-stretches of a point and returns the dissipated energy divided by s V.
#[allow(clippy::too_many_arguments)]
#[inline(always)]
fn viscous_row<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    rule: &Advance<'_>,
    relaxation: &Relaxation,
    u: &Records,
    part: &mut Part<'_>,
    point: Point,
    volumes: &mut [f64],
    at: usize,
) -> f64 {
    let (zero, half) = (T::splat(0.0), T::splat(0.5));
    let here = bonds.here::<T, D>(point.i, u);
    let (mut volume, mut before, mut now) = (zero, zero, zero);
    let mut backs = [zero; MOST_TERMS];
    for k in 0..point.groups {
        let group = point.start + k;
        let intact = part.damage.intact[group];
        if intact == 0 {
            continue;
        }
        let bond = bonds.group(point.first + k, &here, u);
        let weight = (bond.weight * bond.square).masked(intact);
        let stretch = L::exact_stretch(L::strain(bond.xi, bond.eta, bond.inverse_square));
        volume = volume + weight;
        before = weight.mul_add(T::load(part.last, group * LANES), before);
        now = weight.mul_add(stretch.masked(intact), now);
        for term in 0..relaxation.terms {
            let back = T::load(part.back, (group * rule.terms + term) * LANES);
            backs[term] = weight.mul_add(back, backs[term]);
        }
    }
    let (before, now) = (sum(before), sum(now));
    let over = inverse(sum(volume));
    let sums = &mut part.sums[at * (1 + rule.terms)..(at + 1) * (1 + rule.terms)];
    sums[0] = now;
    let mut shifts = [[zero; 2]; MOST_TERMS];
    for term in 0..relaxation.terms {
        let back = sum(backs[term]);
        sums[1 + term] = back;
        shifts[term] = [
            T::splat((back - before) * over),
            T::splat((back - now) * over),
        ];
    }
    volumes[at] = sum(volume);
    let mut dissipated = zero;
    for k in 0..point.groups {
        let group = point.start + k;
        let intact = part.damage.intact[group];
        if intact == 0 {
            continue;
        }
        let bond = bonds.group(point.first + k, &here, u);
        let weight = (bond.weight * bond.square).masked(intact);
        let stretch = L::exact_stretch(L::strain(bond.xi, bond.eta, bond.inverse_square));
        let stretch = stretch.masked(intact);
        let last = T::load(part.last, group * LANES);
        let mut inelastic = zero;
        for term in 0..relaxation.terms {
            let place = (group * rule.terms + term) * LANES;
            let old = T::load(part.back, place);
            let (start, end) = (last + shifts[term][0], stretch + shifts[term][1]);
            let new = T::splat(relaxation.gain[term]).mul_add(start - old, old);
            let new = T::splat(relaxation.slope[term]).mul_add(end - start, new);
            let new = new.masked(intact);
            let share = T::splat(relaxation.share[term]);
            let push = half * ((last - old) + (stretch - new));
            dissipated = (share * weight * push).mul_add(new - old, dissipated);
            inelastic = share.mul_add(new, inelastic);
            part.back[place..place + LANES].copy_from_slice(&new.to_array());
        }
        let entries = group * LANES..(group + 1) * LANES;
        part.inelastic[entries.clone()].copy_from_slice(&inelastic.to_array());
        part.last[entries].copy_from_slice(&stretch.to_array());
    }
    sum(dissipated)
}

/// Applies plastic flow to a point if its deviatoric force state lies outside the yield surface, and returns
/// the dissipated energy divided by s V.
#[allow(clippy::too_many_arguments)]
#[inline(always)]
fn plastic_row<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    rule: &Advance<'_>,
    law: &Yield,
    u: &Records,
    part: &mut Part<'_>,
    point: Point,
    out: &mut [&mut [f64]; 4],
    at: usize,
) -> f64 {
    let (zero, half) = (T::splat(0.0), T::splat(0.5));
    let here = bonds.here::<T, D>(point.i, u);
    let (mut volume, mut elastic, mut plastic) = (zero, zero, zero);
    for k in 0..point.groups {
        let group = point.start + k;
        let intact = part.damage.intact[group];
        if intact == 0 {
            continue;
        }
        let bond = bonds.group(point.first + k, &here, u);
        let weight = (bond.weight * bond.square).masked(intact);
        let stretch = L::exact_stretch(L::strain(bond.xi, bond.eta, bond.inverse_square));
        let x = T::load(part.inelastic, group * LANES);
        volume = volume + weight;
        elastic = weight.mul_add((stretch - x).masked(intact), elastic);
        plastic = weight.mul_add(x, plastic);
    }
    out[1][at] = sum(volume);
    part.sums[at * (1 + rule.terms)] = sum(plastic);
    let mean = T::splat(sum(elastic) * inverse(sum(volume)));
    let (mut norm, mut square) = (zero, zero);
    for k in 0..point.groups {
        let group = point.start + k;
        let intact = part.damage.intact[group];
        if intact == 0 {
            continue;
        }
        let bond = bonds.group(point.first + k, &here, u);
        let weight = (bond.weight * bond.square).masked(intact);
        let stretch = L::exact_stretch(L::strain(bond.xi, bond.eta, bond.inverse_square));
        let deviator = (stretch - T::load(part.inelastic, group * LANES) - mean).masked(intact);
        let w = influence_of(
            rule.influence,
            point.first + k,
            bond.square,
            bond.inverse_square,
        );
        let term = weight * deviator * deviator;
        square = square + term;
        norm = norm + (w * term).masked(intact);
    }
    let stiffness = rule.states.stiffness[bonds.list.site(point.i)];
    // B/(s m) = 1, and D/m divided by D is 1/m.
    let over_volume = rule.states.dilatation[point.i] / D as f64;
    let trial = Trial {
        strength: rule.laws.strength[point.i],
        strain: out[2][at],
        norm: stiffness * sum(norm).sqrt(),
        equivalent: (mean_square(D) * over_volume * sum(square)).sqrt(),
    };
    let factor = trial.factor(law);
    let flow = T::splat(1.0 - factor);
    let mut dissipated = zero;
    for k in 0..point.groups {
        let group = point.start + k;
        let intact = part.damage.intact[group];
        if intact == 0 {
            continue;
        }
        let bond = bonds.group(point.first + k, &here, u);
        let weight = (bond.weight * bond.square).masked(intact);
        let stretch = L::exact_stretch(L::strain(bond.xi, bond.eta, bond.inverse_square));
        let stretch = stretch.masked(intact);
        let entries = group * LANES..(group + 1) * LANES;
        let old = T::load(part.inelastic, group * LANES);
        let last = T::load(part.last, group * LANES);
        part.last[entries.clone()].copy_from_slice(&stretch.to_array());
        let new = flow.mul_add(stretch - old - mean, old).masked(intact);
        let push = half * ((last - old) + (stretch - new));
        dissipated = (weight * push).mul_add(new - old, dissipated);
        part.inelastic[entries].copy_from_slice(&new.to_array());
    }
    if factor < 1.0 {
        out[2][at] += (1.0 - factor) * trial.equivalent;
        out[3][at] += (1.0 / factor - 1.0) / stiffness;
    }
    sum(dissipated)
}

#[inline(always)]
fn sum_rows_body<T: Lanes, const D: usize>(
    bonds: &SolidBonds<'_>,
    rule: &Advance<'_>,
    u: &Records,
    part: &mut Part<'_>,
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 1],
) {
    for row in 0..rows.count() {
        let i = rows.at(row);
        let groups = groups_of(bonds.list, i, rows.first);
        let (first, zero) = (bonds.list.start()[i], T::splat(0.0));
        let here = bonds.here::<T, D>(i, u);
        let own = &rule.laws.of_material[rule.classes.of_point(bonds.list.site(i))];
        let viscous = own.terms().len();
        let (mut volume, mut whole, mut backs) = (zero, zero, [zero; MOST_TERMS]);
        for k in 0..groups.len() {
            let group = groups.start + k;
            let intact = part.damage.intact[group];
            if intact == 0 {
                continue;
            }
            let bond = bonds.group(first + k, &here, u);
            let weight = (bond.weight * bond.square).masked(intact);
            let kept = match viscous {
                0 => T::load(part.inelastic, group * LANES),
                _ => T::load(part.last, group * LANES),
            };
            volume = volume + weight;
            whole = weight.mul_add(kept, whole);
            for term in 0..viscous {
                let back = T::load(part.back, (group * rule.terms + term) * LANES);
                backs[term] = weight.mul_add(back, backs[term]);
            }
        }
        let at = i - rows.first;
        out[0][at] = sum(volume);
        let sums = &mut part.sums[at * (1 + rule.terms)..(at + 1) * (1 + rule.terms)];
        sums[0] = sum(whole);
        for term in 0..viscous {
            sums[1 + term] = sum(backs[term]);
        }
    }
}

for_each_instruction_set! {
    /// Updates the inelastic stretches of the rows to the end of a step, and the time, intact weighted
    /// volume, plastic strain and plastic multiplier of the points.
    pub(super) fn advance_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        rule: &Advance<'_>,
        u: &Records,
        part: &mut Part<'_>,
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 4],
    ) = advance_rows_body on lanes
}

for_each_instruction_set! {
    /// Sets the sums of points over their intact bonds, and their intact weighted volume.
    pub(super) fn sum_rows [const D: usize] <D> (
        bonds: &SolidBonds<'_>,
        rule: &Advance<'_>,
        u: &Records,
        part: &mut Part<'_>,
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
    ) = sum_rows_body on lanes
}
