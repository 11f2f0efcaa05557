//! Bonds that break in a step too large for them: the energy that they dissipate, and records for its correction.

use crate::domain::{Domain, Letter};
use crate::step_end::{BreakingBond, StepEnd};

/// A bond that broke in a step too large for it: the energy recorded for it differs strongly from its energy
/// at the critical stretch.
///
/// The energy dissipated by a breaking bond follows from the work of its force over the step
/// ([`StepEnd::dissipated`]). For a bond that is compressed at the start of the step and over-stretched at
/// its end this energy is negative, as if breaking released energy; a bond stretched far beyond its critical
/// stretch dissipates many times its energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoarseBreak {
    /// Both ends, the smaller index first.
    pub points: [u32; 2],
    /// Direction of the force on the first of these ends, with any nonzero length; missing components are zero.
    pub along: [f64; 3],
    /// Energy at the critical stretch minus the recorded energy, J.
    pub missing: f64,
    /// Whether the step was small enough, but the energy of the point grows when it loses the bond, as state-based and
    /// correspondence materials allow: this energy is taken from the motion.
    pub gains: bool,
}

/// Range of the recorded energy of a broken bond, relative to its energy at the critical stretch, that is
/// accepted without correction. Errors of both signs within this range cancel: they are of first order in the
/// step for one bond, of second order in the mean.
const RESOLVED: std::ops::RangeInclusive<f64> = 0.0..=4.0;

/// Energy that breaking bonds release, J.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Released {
    /// Dissipated energy by the half-step rule at the end of the step.
    pub at_end: f64,
    /// Energy where the bonds reach their limits.
    pub at_limit: f64,
}

/// Dissipated energy of breaking bonds, J.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dissipated {
    /// The energy that is recorded as dissipated.
    pub dissipated: f64,
    /// Energy at the limits minus the recorded energy if that is outside the accepted range, else zero.
    pub missing: f64,
    /// Whether the energy at the limits is negative: losing the bonds increases the energy in the smallest step too.
    pub gains: bool,
}

impl Released {
    /// Returns the dissipated energy. If it is outside the accepted range, the rule at the start of the step, which
    /// `at_start` evaluates, is used. Breaking bonds do not release a negative energy.
    pub fn dissipated(self, at_start: impl FnOnce() -> Option<f64>) -> Dissipated {
        let limit = self.at_limit.max(0.0);
        let resolved = limit * RESOLVED.start()..=limit * RESOLVED.end();
        let with = |dissipated: f64| Dissipated {
            dissipated,
            gains: self.at_limit < 0.0,
            missing: match resolved.contains(&dissipated) {
                true => 0.0,
                false => limit - dissipated,
            },
        };
        if resolved.contains(&self.at_end) {
            return with(self.at_end);
        }
        with(at_start().unwrap_or(self.at_end))
    }
}

/// Returns whether a bond with the reference vector ξ turned around within a step, from ξ + η₀ to ξ + η₁: one of its ends
/// passed through the other. The half-step rule does not hold for it, because the direction of its force changed.
pub fn turns_around<const D: usize>(xi: &[f64; D], before: &[f64; D], after: &[f64; D]) -> bool {
    let along = (0..D).map(|c| (xi[c] + before[c]) * (xi[c] + after[c]));
    along.sum::<f64>() < 0.0
}

/// Where within a step the breaking bonds of a point reached their limits, for points whose energy is not a sum over bonds.
#[derive(Debug, Clone, Copy, Default)]
pub struct Crossing {
    /// Σ of the weights of bonds, of their fractions of the step, and of (critical stretch/stretch)².
    sums: [f64; 3],
    /// Whether a bond turned around within the step.
    turned: bool,
}

impl Crossing {
    /// Adds a breaking bond with its stretches at the start and the end of the step, and whether it turned around. The critical stretch is infinite for
    /// other criteria, whose limit is taken to be reached in the middle of the step.
    pub fn add(&mut self, weight: f64, [start, end]: [f64; 2], critical: f64, turned: bool) {
        self.turned |= turned;
        let by_stretch = critical.is_finite() && end > critical;
        let (part, ratio) = match by_stretch {
            true => {
                let part = (critical - start) / (end - start);
                (
                    if part.is_nan() {
                        1.0
                    } else {
                        part.clamp(0.0, 1.0)
                    },
                    critical / end,
                )
            }
            false => (0.5, 1.0),
        };
        for (sum, term) in self.sums.iter_mut().zip([1.0, part, ratio * ratio]) {
            *sum += weight * term;
        }
    }

    /// Returns the energy that a point dissipates whose energy decreases by `end[0]` (J) when its bonds break at the end of the
    /// step, with the rate `end[1]` (W) for the mean velocity; `start` returns both at the start of the step.
    pub fn dissipated(
        &self,
        step: &StepEnd<'_>,
        end: [f64; 2],
        start: impl FnOnce() -> [f64; 2],
    ) -> Dissipated {
        let at_end = step.dissipated_energy(end[0], end[1]);
        let [weight, part, square] = self.sums;
        if !step.has_halves() {
            let scale = if weight > 0.0 { square / weight } else { 1.0 };
            let at_limit = scale * end[0];
            return Released { at_end, at_limit }.dissipated(|| None);
        }
        let start = start();
        // The parabola through both energies with the rate at the end.
        let back = if weight > 0.0 {
            part / weight - 1.0
        } else {
            -0.5
        };
        let slope = step.dt * end[1];
        let at_limit = end[0] + back * (slope + back * (start[0] - end[0] + slope));
        let at_start = || {
            let energy = step.dissipated_from_start(start[0], start[1]);
            self.turned.then_some(energy)
        };
        Released { at_end, at_limit }.dissipated(at_start)
    }
}

/// A bond that a point loses.
#[derive(Debug, Clone, Copy)]
pub struct LostBond<const D: usize> {
    /// The other end; ghosts are counted after the own points.
    pub neighbour: usize,
    /// Direction of the force on the point.
    pub along: [f64; D],
    /// Weight of the bond in the energy of the point.
    pub share: f64,
}

impl Dissipated {
    /// Returns the records of the bonds that point i loses: its missing energy, divided by their shares.
    pub fn records<const D: usize>(
        self,
        i: usize,
        lost: &[LostBond<D>],
    ) -> impl Iterator<Item = CoarseBreak> {
        let all: f64 = lost.iter().map(|bond| bond.share).sum();
        let even = 1.0 / lost.len().max(1) as f64;
        let missing = self.missing;
        let lost = lost.iter().filter(move |_| missing != 0.0);
        lost.map(move |bond| {
            let share = if all > 0.0 { bond.share / all } else { even };
            CoarseBreak {
                gains: self.gains,
                ..CoarseBreak::between([i, bond.neighbour], &bond.along, missing * share)
            }
        })
    }
}

/// Adds up the parts of both ends of bonds that broke in steps too large for them: `parts` belong to own points. Returns
/// each bond once, in the order of their ends. All processes must call it together.
pub fn both_ends(domain: &Domain, parts: Vec<CoarseBreak>) -> Vec<CoarseBreak> {
    let (gains, coarse) = parts.into_iter().partition(|part| part.gains);
    let mut bonds = of_kind(domain, coarse, false);
    bonds.extend(of_kind(domain, gains, true));
    bonds
}

/// Returns records of own points, which all have the same `gains`, followed by those from other processes: a sweep over a part
/// of the body records a bond at one end only, which sends it to the owner of the other end. All processes must call it
/// together.
pub fn with_received(
    domain: &Domain,
    mut bonds: Vec<CoarseBreak>,
    gains: bool,
) -> Vec<CoarseBreak> {
    let mut letters = Vec::new();
    for bond in &bonds {
        // Ghosts are counted after the own points.
        let [own, other] = bond.points.map(|point| point as usize);
        if other >= domain.owned_points() {
            let [x, y, z] = bond.along;
            letters.push(Letter {
                from: own,
                to: other,
                numbers: [x, y, z, bond.missing],
            });
        }
    }
    bonds.extend(domain.deliver(letters).into_iter().map(|letter| {
        let [x, y, z, missing] = letter.numbers;
        CoarseBreak {
            gains,
            ..CoarseBreak::between([letter.to, letter.from], &[-x, -y, -z], missing)
        }
    }));
    bonds
}

fn of_kind(domain: &Domain, mut parts: Vec<CoarseBreak>, gains: bool) -> Vec<CoarseBreak> {
    if domain.all(parts.is_empty()) {
        return parts;
    }
    parts = with_received(domain, parts, gains);
    let numbers = |bond: &CoarseBreak| {
        let mut numbers = bond.points.map(|point| domain.number(point as usize));
        numbers.sort_unstable();
        numbers
    };
    // The sum of the parts does not depend on which of them is own.
    parts.sort_by(|a, b| {
        let by_missing = || a.missing.total_cmp(&b.missing);
        numbers(a).cmp(&numbers(b)).then_with(by_missing)
    });
    let mut bonds: Vec<CoarseBreak> = Vec::with_capacity(parts.len());
    for part in parts {
        match bonds.last_mut() {
            Some(last) if numbers(last) == numbers(&part) => last.missing += part.missing,
            _ => bonds.push(part),
        }
    }
    bonds
}

impl CoarseBreak {
    /// Returns the energy that a broken bond dissipates, J, and a record of the bond if this energy is outside the accepted
    /// range. There is no record if the energy at the critical stretch is unknown. `before` returns force and energy of the
    /// bond, in units of [`BreakingBond::weight`], for a displacement that is smaller by its argument, if the bond has turned
    /// around since ([`turns_around`]).
    pub fn dissipated<const D: usize>(
        step: &StepEnd<'_>,
        bond: &BreakingBond<D>,
        before: impl FnOnce([f64; D]) -> Option<([f64; D], f64)>,
    ) -> (f64, Option<Self>) {
        let dissipated = step.dissipated(bond);
        let Some(critical) = bond.critical.map(|critical| bond.weight * critical) else {
            return (dissipated, None);
        };
        let energy = Released {
            at_end: dissipated,
            at_limit: critical,
        }
        .dissipated(|| {
            let (force, energy) = before(bond.velocity.map(|v| step.dt * v))?;
            let rate: f64 = (0..D).map(|c| force[c] * bond.velocity[c]).sum();
            Some(bond.weight * step.dissipated_from_start(energy, rate))
        });
        let record =
            (energy.missing != 0.0).then(|| Self::between(bond.ends, &bond.force, energy.missing));
        (energy.dissipated, record)
    }

    /// Returns the record of a bond with the direction of the force on the first of the ends.
    pub fn between(ends: [usize; 2], force: &[f64], missing: f64) -> Self {
        let record = Self {
            points: ends.map(|end| end as u32),
            along: std::array::from_fn(|c| force.get(c).copied().unwrap_or(0.0)),
            missing,
            gains: false,
        };
        match ends[0] < ends[1] {
            true => record,
            false => record.reversed(),
        }
    }

    /// Returns the same record seen from the other end.
    pub(crate) fn reversed(self) -> Self {
        let [i, j] = self.points;
        Self {
            points: [j, i],
            along: self.along.map(|component| -component),
            ..self
        }
    }
}

/// Sorts bonds by their ends and removes duplicates.
pub fn each_once(mut coarse: Vec<CoarseBreak>) -> Vec<CoarseBreak> {
    coarse.sort_by_key(|bond| (bond.points, bond.gains));
    coarse.dedup_by_key(|bond| (bond.points, bond.gains));
    coarse
}
