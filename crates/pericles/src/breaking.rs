//! Energy correction for bonds that break in a step too coarse for the half-step rule.
//!
//! A breaking bond acts for half of its step. A linear bond with elongation η before and η′ after the step thus
//! dissipates ½ k η η′, which converges to the energy at the critical elongation, ½ k η_c². Where one step
//! stretches a bond to many times η_c the two are unrelated, and a compressed bond (η < 0) would create energy.
//! Points of state-based and correspondence materials, whose energy is not a sum over bonds, dissipate the loss of
//! their energy by all bonds that they lose in a step; the reference is this loss where the bonds reach η_c on the
//! straight path of the step.
//! Such a bond is taken to have broken at η_c within the step: the difference is removed from, or added to, the
//! relative velocity of its ends along the bond by two equal and opposite impulses, which conserve momentum and
//! angular momentum. All bonds of a step are corrected at once from the same velocities, so that the result does
//! not depend on their order. The energy actually removed enters the energy balance, which closes to rounding.

use crate::domain::{Domain, Field};
use crate::neighbourhood::{CoarseBreak, each_once, with_received};
use crate::system::System;

/// Largest number of passes over the broken bonds of a step. One is enough where few bonds share a point; where all
/// bonds of a point break at once, each pass leaves some energy to the next.
const PASSES: usize = 32;
/// Energy that may remain, relative to that of all broken bonds.
const LEFT: f64 = 1e-6;

impl System {
    /// Corrects the velocities v of the ends of the bonds that broke in the step that ends at time t.
    ///
    /// Each pass computes the impulses of all bonds from the same velocities and scales them so that together they
    /// remove the missing energy, or as much of it as possible.
    pub fn settle_breaking(&mut self, t: f64, v: &mut [f64]) {
        let domain = self.domain().clone();
        let Some(breaking) = self.operator_mut().breaking_mut() else {
            return;
        };
        let breaks = breaking.take_coarse_breaks();
        if domain.all(breaks.is_empty()) {
            return;
        }
        let numbers = |bond: &CoarseBreak| bond.points.map(|point| domain.number(point as usize));
        // Neither the order nor the first end must depend on the division among processes: the ends of a bond without relative
        // velocity are pushed in the direction of the force on the first one.
        let oriented = |bond: CoarseBreak| match numbers(&bond) {
            [a, b] if a > b => bond.reversed(),
            _ => bond,
        };
        let (gains, coarse) = breaks.into_iter().partition(|bond| bond.gains);
        let kinds = [(coarse, false), (gains, true)];
        let breaks = kinds.map(|(breaks, gains)| at_both_ends(&domain, breaks, gains));
        let breaks = breaks.into_iter().flatten();
        let mut breaks: Vec<CoarseBreak> = breaks.map(oriented).collect();
        breaks.sort_by_key(|bond| (numbers(bond), bond.gains));
        let own: Vec<usize> = (0..breaks.len())
            .filter(|&k| self.is_ours(&breaks[k]))
            .collect();
        let coarse = own.iter().filter(|&&k| !breaks[k].gains).count();
        self.coarse_breaks.add(coarse as u64);
        let mut ends = Ends::new(self, t, v.len());
        let shares: Vec<f64> = breaks.iter().map(|bond| bond.missing.abs()).collect();
        let all = domain.sum(own.len(), |k| shares[own[k]]);
        let mut left = domain.sum(own.len(), |k| breaks[own[k]].missing);
        for _ in 0..PASSES {
            if left.abs() <= LEFT * all {
                break;
            }
            ends.velocity = domain.ghosts(v);
            let impulse = self.impulses(&breaks, v, &ends);
            let taken = self.push(&impulse, left, v, &ends.free);
            if taken == 0.0 {
                break;
            }
            left -= taken;
            for (bond, share) in breaks.iter_mut().zip(&shares) {
                bond.missing = left * share / all;
            }
        }
    }

    /// Returns whether this process counts a bond: the owner of the end with the smaller number does.
    fn is_ours(&self, bond: &CoarseBreak) -> bool {
        let number = |&point: &u32| self.domain().number(point as usize);
        let first = bond.points.iter().min_by_key(|&point| number(point));
        first.is_some_and(|&point| (point as usize) < self.points())
    }

    /// Applies impulses (N s), scaled so that they remove the energy `missing` (J) or as much of it as possible.
    /// Adds the removed energy to the energy balance and returns it.
    fn push(&mut self, impulse: &[f64], missing: f64, v: &mut [f64], free: &[f64]) -> f64 {
        let (n, domain) = (self.points(), self.domain().clone());
        let pushed: Vec<usize> = (0..impulse.len()).filter(|&k| impulse[k] != 0.0).collect();
        let rate = domain.sum(pushed.len(), |k| impulse[pushed[k]] * v[pushed[k]]);
        let compliance = domain.sum(pushed.len(), |k| {
            let entry = pushed[k];
            free[entry] * impulse[entry] * impulse[entry] / self.mass_of(entry % n)
        });
        let scale = separating_impulse(rate, compliance, missing);
        // Impulses opposite to the impulses of the bonds would not separate their ends.
        if scale <= 0.0 || !scale.is_finite() {
            return 0.0;
        }
        let mut given = Vec::with_capacity(pushed.len());
        let points: Vec<usize> = pushed.iter().map(|entry| entry % n).collect();
        let (mut supports, mut reaction) = (Vec::new(), [const { Vec::new() }; 3]);
        for entry in pushed {
            let push = scale * impulse[entry];
            if free[entry] == 0.0 {
                // The constraint takes the impulse.
                given.push(push * v[entry]);
                supports.push(-push * v[entry]);
                reaction[entry / n].push(-push);
            } else {
                let change = push / self.mass_of(entry % n);
                given.push(push * (v[entry] + 0.5 * change));
                v[entry] += change;
            }
        }
        let sum = |terms: &[f64]| domain.sum(terms.len(), |k| terms[k]);
        let taken = -sum(&given);
        self.book_reaction(sum(&supports), reaction.each_ref().map(|terms| sum(terms)));
        if let Some(breaking) = self.operator_mut().breaking_mut() {
            // Added one by one, so that the sum over all processes does not depend on the division.
            for (i, given) in points.into_iter().zip(&given) {
                breaking.bonds_mut().dissipate(i, -given);
            }
        }
        taken
    }

    /// Number of bonds so far that broke in a step too coarse for the half-step rule.
    pub fn coarse_breaks(&self) -> u64 {
        self.domain().count(self.coarse_breaks.get())
    }

    /// Returns the impulse on every unknown, N s.
    fn impulses(&self, breaks: &[CoarseBreak], v: &[f64], ends: &Ends) -> Vec<f64> {
        let (n, dimension) = (self.points(), self.dimension());
        let velocity = Field::new(v, &ends.velocity);
        let free = Field::new(&ends.free, &ends.free_ghosts);
        let mut impulse = vec![0.0; v.len()];
        for bond in breaks {
            let [i, j] = bond.points.map(|point| point as usize);
            let length = bond.along.iter().map(|x| x * x).sum::<f64>().sqrt();
            if length == 0.0 {
                continue;
            }
            let (mut rate, mut compliance) = (0.0, 0.0);
            for c in 0..dimension {
                let e = bond.along[c] / length;
                let of = |field: Field<'_>, point| field.entry(dimension, c, point);
                rate += e * (of(velocity, j) - of(velocity, i));
                compliance += e * e * (of(free, j) / ends.mass[j] + of(free, i) / ends.mass[i]);
            }
            let push = separating_impulse(rate, compliance, bond.missing);
            for c in 0..dimension {
                let push = push * bond.along[c] / length;
                for (point, push) in [(j, push), (i, -push)] {
                    if point < n {
                        impulse[c * n + point] += push;
                    }
                }
            }
        }
        impulse
    }

    /// ρ V of a point, kg.
    pub(crate) fn mass_of(&self, i: usize) -> f64 {
        self.density().at(i) * self.cloud().volumes()[i]
    }
}

/// Returns the bonds that broke at own points, each once. All processes must call it together.
fn at_both_ends(domain: &Domain, breaks: Vec<CoarseBreak>, gains: bool) -> Vec<CoarseBreak> {
    match domain.is_divided() {
        true => each_once(with_received(domain, breaks, gains)),
        false => breaks,
    }
}

/// Data of the ends of bonds, including those owned by other processes.
struct Ends {
    /// 1 where the motion is free, 0 where it is prescribed; by entry.
    free: Vec<f64>,
    free_ghosts: Vec<f64>,
    /// Masses, kg; own points first, then ghosts.
    mass: Vec<f64>,
    /// Velocities of ghosts, m/s.
    velocity: Vec<f64>,
}

impl Ends {
    fn new(system: &System, t: f64, entries: usize) -> Self {
        let mut free = vec![1.0; entries];
        system.hold_at(t, &mut free);
        let mass: Vec<f64> = (0..system.points()).map(|i| system.mass_of(i)).collect();
        Self {
            free_ghosts: system.domain().ghosts(&free),
            mass: system.domain().with_ghosts(&mass).into_owned(),
            velocity: Vec::new(),
            free,
        }
    }
}

/// Returns the impulse p along a bond that changes the energy of its ends by −`missing`: p rate + ½ p² compliance =
/// −missing, where their distance grows with `rate` and their inverse masses add up to `compliance`. Of two
/// solutions it is the smaller one; without a solution, the impulse that removes the most energy.
fn separating_impulse(rate: f64, compliance: f64, missing: f64) -> f64 {
    let square = rate * rate - 2.0 * compliance * missing;
    if square < 0.0 {
        return -rate / compliance;
    }
    let sum = rate + square.sqrt().copysign(rate);
    if sum == 0.0 {
        0.0
    } else {
        -2.0 * missing / sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separating_impulses_remove_the_missing_energy_or_all_of_it() {
        for (rate, compliance, missing) in [(2.0, 0.5, 1.0), (-3.0, 2.0, 0.7), (0.1, 1.0, -4.0)] {
            let p = separating_impulse(rate, compliance, missing);
            let change = p * rate + 0.5 * p * p * compliance;
            assert!((change + missing).abs() < 1e-12, "{rate}: {p}");
        }
        // A relative velocity of 1 m/s of two masses of 2 kg has the energy 1/2 J.
        assert_eq!(separating_impulse(1.0, 1.0, 3.0), -1.0);
        assert_eq!(separating_impulse(0.0, 1.0, 3.0), 0.0);
        // Ends that cannot move.
        assert_eq!(separating_impulse(2.0, 0.0, 3.0), -1.5);
    }
}
