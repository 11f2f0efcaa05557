//! Bond failure and the dissipated energy of a point.
//!
//! The energy of a state-based solid is a sum over points of a function of the dilatation and of all bonds of
//! the point. A point that loses bonds dissipates the difference of its energies with and without them, minus
//! the work of their forces in the second half of the step. This is the rule for single bonds with the power
//! of the energy of the point instead of that of a bond.

use super::bonds::{SolidBonds, difference};
use super::kinematics::Kinematics;
use crate::domain::Field;
use crate::lanes::{F64x8, LANES, dot};
use crate::material::{Materials, PairForce, StateConstants};
use crate::neighbourhood::{BreakEvent, Tally};
use crate::neighbourhood::{Crossing, Dissipated, LostBond, turns_around};
use crate::operator::records::Records;
use crate::space::Sites;
use crate::step_end::StepEnd;

/// Factors of the force states of points.
pub(super) struct States {
    /// D/m: the dilatation is (D/m) Σ ω r e.
    pub dilatation: Vec<f64>,
    /// A/m = p/θ of each site; on a stencil of each point and ghost.
    pub pressure: Vec<f64>,
    /// s = B/m, as for A/m.
    pub stiffness: Vec<f64>,
    /// A/D, Pa: the energy density is (A/D) θ²/2 + (s/2) Σ g ω e².
    pub bulk: Vec<f64>,
}

impl States {
    /// Creates the factors for these weighted volumes; zero for points without bonds. `spread` copies values
    /// of own points to all sites.
    pub fn new<const D: usize>(
        volumes: &[f64],
        classes: &Materials<StateConstants>,
        spread: &dyn Fn(&[f64]) -> Vec<f64>,
    ) -> Self {
        let over = |value: f64, volume: f64| if volume > 0.0 { value / volume } else { 0.0 };
        let of = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let volumes = volumes.iter().enumerate();
            volumes.map(|(i, volume)| over(value(i), *volume)).collect()
        };
        Self {
            dilatation: of(&|_| D as f64),
            pressure: spread(&of(&|i| classes.constants(i)[0])),
            stiffness: spread(&of(&|i| classes.constants(i)[1])),
            bulk: (0..volumes.len())
                .map(|i| classes.constants(i)[0] / D as f64)
                .collect(),
        }
    }

    /// Returns the energy density of a point at a site for a dilatation and Σ g ω e², J/m³.
    pub fn energy_density(&self, [i, site]: [usize; 2], theta: f64, squares: f64) -> f64 {
        0.5 * (self.bulk[i] * theta * theta + self.stiffness[site] * squares)
    }

    /// Returns k = (max(A D, 0) + g B)/m of a site: W ≤ ½ Σ k ω e² by Cauchy's inequality θ² ≤ (D²/m) Σ ω e².
    pub fn spring<const D: usize>(&self, site: usize, factor: f64) -> f64 {
        (D as f64 * self.pressure[site]).max(0.0) + factor * self.stiffness[site]
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        let arrays = [
            &self.dilatation,
            &self.pressure,
            &self.stiffness,
            &self.bulk,
        ];
        arrays.iter().map(|array| size_of_val(&array[..])).sum()
    }
}

/// Failure criterion read by the loops.
#[derive(Clone, Copy)]
pub(super) struct BreakRule<'a> {
    /// A bond exceeds the critical stretch of the weakest pair of materials if measure > threshold |ξ|².
    pub threshold: f64,
    /// Critical bond energy of the weakest pair of materials.
    pub energy: f64,
    pub classes: &'a Materials<StateConstants>,
    /// Bits of the bonds that may break; `None`: all.
    pub breakable: Option<&'a [u8]>,
    pub states: &'a States,
    pub volumes: &'a [f64],
    /// The step that ends.
    pub step: &'a StepEnd<'a>,
    /// Mean velocities over the step, if the failure criterion needs them.
    pub velocity: Option<Field<'a>>,
    /// Whether breaking bonds are recorded for the update of their other end.
    pub note_events: bool,
    /// Thermal stretches of own points and ghosts, if the material expands.
    pub stretches: Option<&'a [f64]>,
}

/// Returns the stretch at which a bond with the thermal stretch τ breaks: the ratio of its length to the
/// stress-free length is then 1 + `limit`.
pub(super) fn heated_limit(limit: f64, stretch: f64) -> f64 {
    limit + stretch * (1.0 + limit)
}

impl BreakRule<'_> {
    /// Returns the critical stretch of a bond between two sites, including thermal stretch.
    pub fn limit(&self, sites: &Sites, [a, b]: [usize; 2]) -> f64 {
        let limit = self.classes.limits(a, b).stretch;
        match self.stretches {
            None => limit,
            Some(stretches) => {
                let both = stretches[sites.point(a)] + stretches[sites.point(b)];
                heated_limit(limit, 0.5 * both)
            }
        }
    }

    /// Returns the bits of the intact bonds of a group that may break.
    #[inline(always)]
    pub fn candidates(&self, group: usize, intact: u8) -> u8 {
        match self.breakable {
            Some(bits) => intact & bits[group],
            None => intact,
        }
    }
}

/// Breaks the bonds of a point that exceed their critical stretch and records the dissipated energy. Returns
/// whether a bond broke.
///
/// The criterion uses [`PairForce::stretch_measure`], which is bitwise identical at both ends and for all
/// instruction sets.
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
            let limit = rule.limit(bonds.list.sites(), [here, j]);
            if measure > L::Measure::threshold(limit) * square {
                *broken |= 1 << lane;
            }
        }
    }
    take_bonds::<L, D>(bonds, rule, u, i, intact, &broken, tally)
}

/// Clears the bits of broken bonds and records the energy that their point dissipates. Returns whether there
/// are any.
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
    let (loss, lost) = loss_of::<L, D>(bonds, rule, u, i, intact, broken);
    let site = bonds.list.site(i);
    tally.lose(
        i,
        loss.dissipated(rule.states, [i, site], rule.volumes[i], rule.step),
        &lost,
    );
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

/// Returns the loss of a point whose bonds `broken` break at the end of a step, and these bonds.
fn loss_of<L: Kinematics, const D: usize>(
    bonds: &SolidBonds<'_>,
    rule: &BreakRule<'_>,
    u: &Records,
    i: usize,
    intact: &[u8],
    broken: &[u8],
) -> (Loss, Vec<LostBond<D>>) {
    let (first, here) = (bonds.list.start()[i], bonds.list.site(i));
    let sites = bonds.list.sites();
    let (mut loss, mut lost) = (Loss::new(rule.step), Vec::new());
    for (k, intact) in intact.iter().enumerate() {
        let neighbours = bonds.list.group(first + k);
        for lane in (0..LANES).filter(|lane| intact >> lane & 1 == 1) {
            let j = neighbours[lane];
            let entry = (first + k) * LANES + lane;
            let xi = bonds.vector::<D>(here, j);
            let velocity = rule.velocity.map(|v| v.difference([i, sites.point(j)]));
            let bond = LosingBond {
                neighbour: sites.point(j),
                xi,
                eta: difference(u, here, j),
                velocity: velocity.unwrap_or([0.0; D]),
                weight: bonds.weight_of(entry, [here, j], xi),
                factor: bonds.factor_of(entry),
                thermal: rule.stretches.map_or(0.0, |stretches| stretches[i]),
                critical: rule.limit(sites, [here, j]),
            };
            lost.extend(loss.add::<L, D>(&bond, broken[k] >> lane & 1 == 1));
        }
    }
    (loss, lost)
}

/// A bond of a point with breaking bonds.
pub(super) struct LosingBond<const D: usize> {
    /// The other end.
    pub neighbour: usize,
    pub xi: [f64; D],
    pub eta: [f64; D],
    /// Relative velocity of its ends; zero if the failure criterion does not need it.
    pub velocity: [f64; D],
    /// ω
    pub weight: f64,
    /// Factor of its stiffness.
    pub factor: f64,
    /// Thermal stretch τ of the point.
    pub thermal: f64,
    /// Critical stretch with thermal stretch; infinite for other criteria.
    pub critical: f64,
}

/// Sums over all bonds of a point and over its breaking bonds, at the end and at the start of a step.
pub(super) struct Loss {
    dt: f64,
    whole: [Sums; 2],
    lost: [Sums; 2],
    crossing: Crossing,
}

/// Sums over bonds of a point.
#[derive(Default)]
struct Sums {
    /// Σ ω r e and its rate.
    extension: [f64; 2],
    /// Σ g ω e², and half its rate.
    square: [f64; 2],
}

impl Loss {
    /// Creates empty sums for the end of a step.
    pub fn new(step: &StepEnd<'_>) -> Self {
        Self {
            dt: step.dt,
            whole: Default::default(),
            lost: Default::default(),
            crossing: Crossing::default(),
        }
    }

    /// Adds a bond that is intact before the failure. Returns the bond if it breaks.
    pub fn add<L: Kinematics, const D: usize>(
        &mut self,
        bond: &LosingBond<D>,
        broken: bool,
    ) -> Option<LostBond<D>> {
        let square = dot(bond.xi, bond.xi);
        let weight = bond.weight * square;
        let before: [f64; D] = std::array::from_fn(|c| bond.eta[c] - self.dt * bond.velocity[c]);
        let mut stretches = [0.0; 2];
        for (k, eta) in [bond.eta, before].into_iter().enumerate() {
            let t = F64x8([strain::<L, D>(bond.xi, eta); LANES]);
            stretches[k] = L::exact_stretch(t).0[0];
            let stretch = stretches[k] - bond.thermal;
            // dψ/dt for the mean velocity.
            let along = dot(direction::<L, D>(bond.xi, eta), bond.velocity);
            let rate = along * L::contraction(t).0[0] / square;
            self.whole[k].add(weight, bond, [stretch, rate]);
            if broken {
                self.lost[k].add(weight, bond, [stretch, rate]);
            }
        }
        broken.then(|| {
            let [end, start] = stretches;
            let share = weight * end * end;
            let turned = turns_around(&bond.xi, &before, &bond.eta);
            self.crossing
                .add(share, [start, end], bond.critical, turned);
            LostBond {
                neighbour: bond.neighbour,
                along: direction::<L, D>(bond.xi, bond.eta),
                share,
            }
        })
    }

    /// Returns the energy that a point at a site loses, J, and its rate, W, at the end or the start of the step.
    fn at(&self, k: usize, states: &States, [i, site]: [usize; 2], volume: f64) -> [f64; 2] {
        let (whole, lost) = (&self.whole[k], &self.lost[k]);
        let [theta, theta_rate] = whole.extension.map(|sum| states.dilatation[i] * sum);
        let [loss, loss_rate] = lost.extension.map(|sum| states.dilatation[i] * sum);
        // Decrease of θ² and of its rate.
        let left = theta - loss;
        let energy = 0.5 * states.bulk[i] * loss * (theta + left)
            + 0.5 * states.stiffness[site] * lost.square[0];
        let power = states.bulk[i] * (loss_rate * left + theta_rate * loss)
            + states.stiffness[site] * lost.square[1];
        [volume * energy, volume * power]
    }

    /// Returns the energy dissipated at the end of a step by a point at a site.
    pub fn dissipated(
        &self,
        states: &States,
        ends: [usize; 2],
        volume: f64,
        step: &StepEnd<'_>,
    ) -> Dissipated {
        let end = self.at(0, states, ends, volume);
        let start = || self.at(1, states, ends, volume);
        self.crossing.dissipated(step, end, start)
    }
}

impl Sums {
    /// Adds a bond of the weight ω r² with the stretch ψ and its rate.
    fn add<const D: usize>(
        &mut self,
        weight: f64,
        bond: &LosingBond<D>,
        [stretch, rate]: [f64; 2],
    ) {
        self.extension[0] += weight * stretch;
        self.extension[1] += weight * rate;
        self.square[0] += bond.factor * weight * (stretch * stretch);
        self.square[1] += bond.factor * weight * stretch * rate;
    }
}

/// Returns the strain t of a bond.
fn strain<L: Kinematics, const D: usize>(xi: [f64; D], eta: [f64; D]) -> f64 {
    let (measure, square) = L::Measure::stretch_measure(xi, eta);
    measure / square
}

/// Returns the direction of the force of a bond, y or ξ.
pub(super) fn direction<L: Kinematics, const D: usize>(xi: [f64; D], eta: [f64; D]) -> [f64; D] {
    let lanes = |vector: [f64; D]| vector.map(|x| F64x8([x; LANES]));
    L::direction(lanes(xi), lanes(eta)).map(|x| x.0[0])
}
