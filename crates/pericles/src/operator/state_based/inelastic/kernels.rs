//! Loops over points and bonds of inelastic solids.

use super::super::bonds::SolidBonds;
use super::super::breaking::States;
use super::super::kernels::{groups_of, sum};
use super::super::kinematics::Kinematics;
use super::super::weight::Weight;
use super::advance::{influence_of, inverse};
use super::history::History;
use super::laws::{Laws, Relaxation, Trial, mean_square};
use crate::lanes::{LANES, Lanes, for_each_instruction_set};
use crate::material::{Inelasticity, SolidClasses, Yield};
use crate::operator::records::Records;
use crate::operator::rows::Rows;

/// Data read by the pass over points at a time within a step.
#[derive(Clone, Copy)]
pub(super) struct Points<'a> {
    pub laws: &'a Laws,
    pub classes: &'a SolidClasses,
    pub states: &'a States,
    pub history: &'a History,
    /// Influence function w, if a material yields.
    pub influence: Option<&'a Weight>,
    /// The time, s.
    pub t: f64,
}

/// Data read by the loops over bonds in addition to displacements.
#[derive(Clone, Copy)]
pub(super) struct Reliefs<'a> {
    /// R of each entry.
    pub of_entries: &'a [f64],
    /// Reverse entry of each entry.
    pub opposite: &'a [u32],
    /// S and G of all sites.
    pub states: &'a Records,
}

/// Force state of a point: the pull of a bond is P + S ψ − G R.
#[derive(Clone, Copy)]
pub(super) struct PointState {
    /// P, N/m³ per ω r.
    pub pull: f64,
    /// S, in the units of P.
    pub stiffness: f64,
}

/// Trial state of a plastic point with the mean of ψ − x over its bonds.
pub(super) struct PlasticPoint {
    pub trial: Trial,
    pub mean: f64,
}

impl<'a> Reliefs<'a> {
    /// Returns R of the entries of a group and of their reverse entries.
    #[inline(always)]
    pub fn of_group<T: Lanes>(&self, group: usize) -> [T; 2] {
        let places = &self.opposite[group * LANES..(group + 1) * LANES];
        let mut numbers = [0.0; LANES];
        for k in 0..LANES {
            numbers[k] = self.of_entries[places[k] as usize];
        }
        [
            T::load(self.of_entries, group * LANES),
            T::load(&numbers, 0),
        ]
    }
}

impl Points<'_> {
    /// Returns the trial state of a plastic point with the dilatation θ.
    #[inline(always)]
    pub fn plastic<T: Lanes, L: Kinematics, const D: usize>(
        &self,
        bonds: &SolidBonds<'_>,
        u: &Records,
        i: usize,
        intact: &[u8],
        theta: f64,
    ) -> PlasticPoint {
        let here = bonds.here::<T, D>(i, u);
        let first = bonds.list.start()[i];
        let (over, factor) = (inverse(self.history.volume[i]), self.states.dilatation[i]);
        let extension = theta * inverse(factor);
        let mean = (extension - self.history.sums(i)[0]) * over;
        let (mut norm, mut square) = (T::splat(0.0), T::splat(0.0));
        for k in 0..intact.len() {
            if intact[k] == 0 {
                continue;
            }
            let bond = bonds.group(first + k, &here, u);
            let weight = bond.weight * bond.square;
            let stretch = L::exact_stretch(L::strain(bond.xi, bond.eta, bond.inverse_square));
            let x = T::load(&self.history.inelastic, (first + k) * LANES);
            let deviator = stretch - x - T::splat(mean);
            let w = influence_of(self.influence, first + k, bond.square, bond.inverse_square);
            let term = (weight * deviator * deviator).masked(intact[k]);
            square = square + term;
            norm = norm + (w * term).masked(intact[k]);
        }
        let trial = Trial {
            strength: self.laws.strength[i],
            strain: self.history.plastic_strain[i],
            norm: self.states.stiffness[bonds.list.site(i)] * sum(norm).sqrt(),
            equivalent: (mean_square(D) * factor / D as f64 * sum(square)).sqrt(),
        };
        PlasticPoint { trial, mean }
    }

    /// Returns P and S of a plastic point at a site with p/θ = A/m.
    #[inline(always)]
    pub fn of_plastic(
        &self,
        site: usize,
        law: &Yield,
        point: &PlasticPoint,
        theta: f64,
    ) -> PointState {
        let (factor, s) = (point.trial.factor(law), self.states.stiffness[site]);
        PointState {
            pull: self.states.pressure[site] * theta + s * (1.0 - factor) * point.mean,
            stiffness: factor * s,
        }
    }

    /// Returns P and S of a viscous point with the dilatation θ.
    #[inline(always)]
    pub fn of_viscous(
        &self,
        i: usize,
        site: usize,
        relaxation: &Relaxation,
        theta: f64,
    ) -> PointState {
        let s = self.states.stiffness[site];
        let over = inverse(self.history.volume[i]);
        let (sums, relaxed) = (self.history.sums(i), relaxation.relaxed());
        let extension = theta * inverse(self.states.dilatation[i]);
        let mut driven = relaxed * extension + relaxation.of_start() * sums[0];
        for k in 0..relaxation.terms {
            driven -= relaxation.share[k] * relaxation.gain[k] * sums[1 + k];
        }
        PointState {
            pull: self.states.pressure[site] * theta + s * driven * over,
            stiffness: (1.0 - relaxed) * s,
        }
    }
}

#[inline(always)]
fn point_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    points: &Points<'_>,
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 3],
) {
    let mut relaxation = Relaxation::new(&[], 0.0);
    let mut material = usize::MAX;
    for row in 0..rows.count() {
        let i = rows.at(row);
        let (at, site) = (i - rows.first, bonds.list.site(i));
        let own = points.classes.of_point(site);
        let theta = out[0][at];
        let state = match &points.laws.of_material[own] {
            Inelasticity::Elastic => PointState {
                pull: points.states.pressure[site] * theta,
                stiffness: points.states.stiffness[site],
            },
            Inelasticity::Viscous(terms) => {
                let dt = (points.t - points.history.time[i]).max(0.0);
                if material != own || relaxation.dt != dt {
                    (material, relaxation) = (own, Relaxation::new(terms, dt));
                }
                points.of_viscous(i, site, &relaxation, theta)
            }
            Inelasticity::Plastic(law) => {
                let intact = &intact[groups_of(bonds.list, i, rows.first)];
                let point = points.plastic::<T, L, D>(bonds, u, i, intact, theta);
                points.of_plastic(site, law, &point, theta)
            }
        };
        out[1][at] = state.pull;
        out[2][at] = state.stiffness;
    }
}

#[inline(always)]
fn force_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    reliefs: &Reliefs<'_>,
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    for row in 0..rows.count() {
        let i = rows.at(row);
        let intact = &intact[groups_of(bonds.list, i, rows.first)];
        let here = bonds.here::<T, D>(i, u);
        let own = &reliefs.states[bonds.list.site(i)];
        let (stiffness, factor) = (T::splat(own[0]), T::splat(own[1]));
        let mut force = [T::splat(0.0); D];
        let first = bonds.list.start()[i];
        for k in 0..intact.len() {
            if intact[k] == 0 {
                continue;
            }
            let bond = bonds.group(first + k, &here, u);
            let there = bonds.there::<T>(first + k, reliefs.states);
            let [forth, back] = reliefs.of_group::<T>(first + k);
            // Bitwise identical from the other end.
            let p = bond.last - (factor * forth + there[1] * back);
            let t = L::strain(bond.xi, bond.eta, bond.inverse_square).masked(intact[k]);
            let pull = L::exact_pull(t, p, stiffness + there[0]);
            let pull = (bond.weight * pull).masked(intact[k]);
            let direction = L::direction(bond.xi, bond.eta);
            for c in 0..D {
                force[c] = pull.mul_add(direction[c], force[c]);
            }
        }
        for c in 0..D {
            out[c][i - rows.first] += sum(force[c]);
        }
    }
}

#[inline(always)]
fn square_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    points: &Points<'_>,
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 1],
) {
    let history = points.history;
    for row in 0..rows.count() {
        let i = rows.at(row);
        let intact = &intact[groups_of(bonds.list, i, rows.first)];
        let here = bonds.here::<T, D>(i, u);
        let law = &points.laws.of_material[points.classes.of_point(bonds.list.site(i))];
        let first = bonds.list.start()[i];
        let mut total = T::splat(0.0);
        for k in 0..intact.len() {
            if intact[k] == 0 {
                continue;
            }
            let bond = bonds.group(first + k, &here, u);
            let stretch = L::exact_stretch(L::strain(bond.xi, bond.eta, bond.inverse_square));
            let x = T::load(&history.inelastic, (first + k) * LANES);
            let mut square = stretch * (stretch - x - x);
            match law {
                Inelasticity::Elastic => {}
                Inelasticity::Plastic(_) => square = x.mul_add(x, square),
                Inelasticity::Viscous(terms) => {
                    for term in 0..terms.len() {
                        let place = ((first + k) * history.terms + term) * LANES;
                        let back = T::load(&history.back, place);
                        square = (T::splat(terms[term].share) * back).mul_add(back, square);
                    }
                }
            }
            total = total + (bond.weight * bond.square * square).masked(intact[k]);
        }
        out[0][i - rows.first] = sum(total);
    }
}

for_each_instruction_set! {
    /// Sets P and S of the rows; the dilatation is the first array of `out`.
    pub(super) fn point_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        points: &Points<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 3],
    ) = point_rows_body on lanes
}

for_each_instruction_set! {
    /// Adds the force density of the rows; the fourth entry of the rows of `u` is P.
    pub(super) fn force_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        reliefs: &Reliefs<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = force_rows_body on lanes
}

for_each_instruction_set! {
    /// Sets Σ ω r² (ψ² − 2 ψ x + c) of the rows, with the inelastic stretches of the last step.
    pub(super) fn square_rows [L: Kinematics, const D: usize] <L, D> (
        bonds: &SolidBonds<'_>,
        points: &Points<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
    ) = square_rows_body on lanes
}
