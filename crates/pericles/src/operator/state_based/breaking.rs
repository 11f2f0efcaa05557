//! Breaking of a point's bonds, and the energy that it dissipates.
//!
//! The energy of a state-based solid is a sum over points, each with a function of its dilatation and of all its bonds. A point that loses bonds loses the difference of its energy with them and without them;
//! the work of their forces in the second half of the step is taken off as for single bonds, with the power of the point's energy in place of that of a bond.

use super::bonds::{SolidBonds, difference};
use super::kinematics::Kinematics;
use crate::domain::Field;
use crate::lanes::{F64x8, LANES, dot};
use crate::material::{PairForce, SolidClasses};
use crate::operator::damage::{BreakEvent, Tally};
use crate::operator::records::Records;
use crate::step_end::StepEnd;

/// The factors of every point's force state.
pub(super) struct States {
    /// D/m: the dilatation is this times Σ ω r e.
    pub dilatation: Vec<f64>,
    /// A/m of each site: p over θ.
    pub pressure: Vec<f64>,
    /// s = B/m of each site.
    pub stiffness: Vec<f64>,
    /// A/D, Pa: the energy density is this times θ²/2, and s/2 Σ g ω e².
    pub bulk: Vec<f64>,
}

/// Breaking as the loops see it.
#[derive(Clone, Copy)]
pub(super) struct BreakRule<'a> {
    /// Bonds with a measure above threshold |ξ|² exceed the critical stretch of the weakest pair of materials.
    pub threshold: f64,
    /// The bond energy of the weakest pair of materials.
    pub energy: f64,
    pub classes: &'a SolidClasses,
    /// Bits of the bonds that may break; all of them if none.
    pub breakable: Option<&'a [u8]>,
    pub states: &'a States,
    pub volumes: &'a [f64],
    /// The step that ended.
    pub step: &'a StepEnd<'a>,
    /// Mean velocities over the step, where breaking asks for them.
    pub velocity: Option<Field<'a>>,
    /// Note what breaks, so that the other end can be cleared.
    pub note_events: bool,
}

impl BreakRule<'_> {
    /// Bits of the bonds of a group that are left and may break.
    #[inline(always)]
    pub fn candidates(&self, group: usize, intact: u8) -> u8 {
        match self.breakable {
            Some(bits) => intact & bits[group],
            None => intact,
        }
    }
}

/// Breaks the bonds of a point that are stretched beyond their critical stretch and books their energy; returns whether there were any.
///
/// Decided with [`PairForce::stretch_measure`], whose rounding is the same at both ends and for all instruction sets.
#[cold]
#[inline(never)]
pub(super) fn break_row<L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    rule: &BreakRule<'_>,
    u: &Records,
    i: usize,
    intact: &mut [u8],
    tally: &mut Tally,
) -> bool {
    let (first, here) = (bonds.list.start()[i], bonds.list.site(i));
    let mut broken = vec![0; intact.len()];
    for (k, broken) in broken.iter_mut().enumerate() {
        let candidates = rule.candidates(first + k, intact[k]);
        let neighbours = bonds.list.group(first + k);
        for lane in (0..LANES).filter(|lane| candidates >> lane & 1 == 1) {
            let j = neighbours[lane];
            let (xi, eta) = (bonds.vector::<D>(here, j), difference::<D>(u, here, j));
            let (measure, square) = L::Measure::stretch_measure(xi, eta);
            let limit = rule.classes.limits(here, j).stretch;
            if measure > L::Measure::threshold(limit) * square {
                *broken |= 1 << lane;
            }
        }
    }
    take_bonds::<L, D>(bonds, rule, u, i, intact, &broken, tally)
}

/// Clears the bits of bonds that are broken, books the energy that their point loses, and returns whether there are any.
pub(super) fn take_bonds<L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    rule: &BreakRule<'_>,
    u: &Records,
    i: usize,
    intact: &mut [u8],
    broken: &[u8],
    tally: &mut Tally,
) -> bool {
    let count: u32 = broken.iter().map(|bits| bits.count_ones()).sum();
    if count == 0 {
        return false;
    }
    tally.broken.add(u64::from(count));
    tally
        .dissipated
        .add(dissipated::<L, D>(bonds, rule, u, i, intact, broken));
    let first = bonds.list.start()[i];
    for (k, (intact, broken)) in intact.iter_mut().zip(broken).enumerate() {
        *intact &= !broken;
        if rule.note_events {
            let lanes = (0..LANES).filter(|lane| broken >> lane & 1 == 1);
            tally.events.extend(lanes.map(|lane| BreakEvent {
                point: i as u32,
                entry: (first + k) * LANES + lane,
                dissipated: 0.0,
            }));
        }
    }
    true
}

/// Sums over bonds of a point.
#[derive(Default)]
struct Sums {
    /// Σ ω r e and its rate.
    extension: [f64; 2],
    /// Σ g ω e² and half its rate.
    square: [f64; 2],
}

/// Energy dissipated by a point that loses the bonds `broken` of those that are left at the end of a step, J.
fn dissipated<L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    rule: &BreakRule<'_>,
    u: &Records,
    i: usize,
    intact: &[u8],
    broken: &[u8],
) -> f64 {
    let (first, here) = (bonds.list.start()[i], bonds.list.site(i));
    let sites = bonds.list.sites();
    let (mut whole, mut lost) = (Sums::default(), Sums::default());
    for (k, intact) in intact.iter().enumerate() {
        let neighbours = bonds.list.group(first + k);
        for lane in (0..LANES).filter(|lane| intact >> lane & 1 == 1) {
            let j = neighbours[lane];
            let entry = (first + k) * LANES + lane;
            let (xi, eta) = (bonds.vector::<D>(here, j), difference::<D>(u, here, j));
            let square = dot(xi, xi);
            let t = strain::<L, D>(xi, eta);
            let stretch = L::exact_stretch(F64x8([t; LANES])).0[0];
            // dψ/dt with the mean velocity.
            let rate = rule.velocity.map_or(0.0, |velocity| {
                let relative = velocity.difference::<D>([i, sites.point(j)]);
                let along = dot(direction::<L, D>(xi, eta), relative);
                along * L::contraction(F64x8([t; LANES])).0[0] / square
            });
            let weight = bonds.weight_of(entry, [here, j], xi) * square;
            let factor = bonds.factor_of(entry);
            whole.add(weight, factor, stretch, rate);
            if broken[k] >> lane & 1 == 1 {
                lost.add(weight, factor, stretch, rate);
            }
        }
    }
    let states = rule.states;
    let [theta, theta_rate] = whole.extension.map(|sum| states.dilatation[i] * sum);
    let [loss, loss_rate] = lost.extension.map(|sum| states.dilatation[i] * sum);
    // θ² and its rate before less those after.
    let left = theta - loss;
    let energy = 0.5 * states.bulk[i] * loss * (theta + left)
        + 0.5 * states.stiffness[here] * lost.square[0];
    let power = states.bulk[i] * (loss_rate * left + theta_rate * loss)
        + states.stiffness[here] * lost.square[1];
    let volume = rule.volumes[i];
    rule.step.dissipated_energy(volume * energy, volume * power)
}

impl Sums {
    /// Adds a bond of the weight ω r² and the factor g with the stretch ψ and its rate.
    fn add(&mut self, weight: f64, factor: f64, stretch: f64, rate: f64) {
        self.extension[0] += weight * stretch;
        self.extension[1] += weight * rate;
        self.square[0] += factor * weight * stretch * stretch;
        self.square[1] += factor * weight * stretch * rate;
    }
}

/// t of one bond.
fn strain<L: Kinematics, const D: usize>(xi: [f64; D], eta: [f64; D]) -> f64 {
    let (measure, square) = L::Measure::stretch_measure(xi, eta);
    measure / square
}

fn direction<L: Kinematics, const D: usize>(xi: [f64; D], eta: [f64; D]) -> [f64; D] {
    let lanes = |vector: [f64; D]| vector.map(|x| F64x8([x; LANES]));
    L::direction(lanes(xi), lanes(eta)).map(|x| x.0[0])
}
