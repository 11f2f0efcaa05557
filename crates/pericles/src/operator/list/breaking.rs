//! Bond failure, evaluated for points with large strains in the force sweep.

use super::arrays::Bonds;
use crate::domain::Field;
use crate::lanes::LANES;
use crate::material::PairForce;
use crate::neighbourhood::turns_around;
use crate::neighbourhood::{BreakEvent, Tally};
use crate::operator::records::Records;
use crate::operator::thresholds::PairThresholds;
use crate::step_end::{BreakingBond, StepEnd, relative_velocity};

/// Failure criterion read by the loops.
pub(super) struct BreakRule<'a> {
    /// A bond is over-stretched if measure > threshold |ξ|².
    pub threshold: f64,
    /// Critical stretch, if it is the same for all bonds.
    pub critical_stretch: f64,
    /// Thresholds that depend on the ends of a bond; `threshold` is then the smallest of them.
    pub pairs: Option<&'a PairThresholds>,
    /// Bits of the bonds that may break; `None`: all.
    pub breakable: Option<&'a [u8]>,
    pub volumes: &'a [f64],
    /// The step that ends.
    pub step: &'a StepEnd<'a>,
    /// Mean velocities over the step, if it has any.
    pub velocity: Option<Field<'a>>,
    /// Whether breaking bonds are recorded for the update of their other end.
    pub note_events: bool,
}

impl BreakRule<'_> {
    fn threshold_of(&self, i: usize, j: usize) -> f64 {
        match self.pairs {
            None => self.threshold,
            Some(pairs) => pairs.threshold(i, j),
        }
    }

    fn critical_stretch_of(&self, i: usize, j: usize) -> f64 {
        match self.pairs {
            None => self.critical_stretch,
            Some(pairs) => pairs.critical_stretch(i, j),
        }
    }
}

/// Breaks the over-stretched bonds of a point and records half of their energy for this end. Returns whether
/// a bond broke.
///
/// The criterion uses [`PairForce::stretch_measure`], which is bitwise identical at both ends and for all
/// instruction sets.
#[cold]
#[inline(never)]
pub(super) fn break_row<L: PairForce, const D: usize>(
    bonds: &Bonds<'_>,
    rule: &BreakRule<'_>,
    u: &Records,
    i: usize,
    intact: &mut [u8],
    tally: &mut Tally,
) -> bool {
    let list = bonds.list();
    let (first, here) = (list.start()[i], list.site(i));
    let mut any = false;
    for (k, intact) in intact.iter_mut().enumerate() {
        let group = first + k;
        let breakable = rule.breakable.map_or(0xFF, |bits| bits[group]);
        let candidates = *intact & bonds.wanted(group) & breakable;
        let neighbours = list.group(group);
        for lane in (0..LANES).filter(|lane| candidates >> lane & 1 == 1) {
            let j = neighbours[lane];
            let xi: [f64; D] = bonds.vector(here, j);
            let eta: [f64; D] = std::array::from_fn(|c| u[j][c] - u[here][c]);
            let entry = group * LANES + lane;
            let (xi, eta, scale) = bonds.relative::<L, D>(entry, [here, j], xi, eta);
            let (measure, square) = L::stretch_measure(xi, eta);
            if measure > rule.threshold_of(here, j) * square {
                any = true;
                *intact &= !(1 << lane);
                let cells = [u[here][3], u[j][3]];
                let stiffness = scale * bonds.stiffness_of::<D>(entry, [here, j], cells);
                let stretch = rule.critical_stretch_of(here, j);
                let ends = [i, list.sites().point(j)];
                let bond = BreakingBond {
                    ends,
                    velocity: relative_velocity(rule.velocity, ends),
                    force: L::force(xi, eta),
                    energy: L::energy(xi, eta),
                    critical: Some(L::energy(xi, xi.map(|component| stretch * component))),
                    weight: rule.volumes[i] * stiffness,
                };
                let dissipated = tally.book(rule.step, &bond, |moved: [f64; D]| {
                    let before = std::array::from_fn(|c| eta[c] - moved[c]);
                    turns_around(&xi, &before, &eta)
                        .then(|| (L::force(xi, before), L::energy(xi, before)))
                });
                if rule.note_events {
                    tally.events.push(BreakEvent {
                        point: i as u32,
                        entry,
                        dissipated,
                    });
                }
            }
        }
    }
    any
}
