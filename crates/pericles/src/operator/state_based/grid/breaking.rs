//! Bond failure, evaluated for chunks with large strains in the pass over points.

use super::arrays::Arrays;
use crate::domain::Field;
use crate::lanes::LANES;
use crate::material::{Materials, PairForce, StateConstants};
use crate::neighbourhood::{BreakEvent, Chunk, Lattice, LostBond, Tally};
use crate::operator::state_based::breaking::{LosingBond, Loss, States, heated_limit};
use crate::operator::state_based::kinematics::Kinematics;
use crate::step_end::StepEnd;

/// Failure criterion read by the loops.
#[derive(Clone, Copy)]
pub(super) struct StencilRule<'a> {
    /// A bond exceeds the critical stretch of the weakest pair of materials if measure > threshold |ξ|².
    pub threshold: f64,
    /// Limits of bonds as a function of both sites.
    pub classes: &'a Materials<StateConstants>,
    pub bonds: &'a Lattice,
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

impl StencilRule<'_> {
    /// Returns the critical stretch of a bond between two places, including thermal stretch.
    fn limit(&self, ends: [usize; 2]) -> f64 {
        let layout = self.bonds.layout();
        let [a, b] = ends.map(|place| layout.site_at(place));
        let limit = self.classes.limits(a, b).stretch;
        self.stretches.map_or(limit, |stretches| {
            let [i, j] = ends.map(|place| layout.point_at(place));
            heated_limit(limit, 0.5 * (stretches[i] + stretches[j]))
        })
    }
}

/// A chunk whose bonds are checked individually.
#[derive(Clone, Copy)]
pub(super) struct ChunkBonds<'a> {
    pub chunk: &'a Chunk,
    /// Lanes to be checked.
    pub lanes: u8,
    /// Index of the chunk.
    pub number: usize,
}

/// Breaks the over-stretched bonds of the lanes of a chunk, with one byte of `intact` per offset, and records
/// the dissipated energy. Returns whether a bond broke.
///
/// The criterion uses [`PairForce::stretch_measure`], which is bitwise identical at both ends and for all
/// instruction sets.
#[cold]
#[inline(never)]
pub(super) fn break_chunk<L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    rule: &StencilRule<'_>,
    bonds: ChunkBonds<'_>,
    intact: &mut [u8],
    tally: &mut Tally,
) -> bool {
    let place = arrays.place(bonds.chunk);
    let mut broken = vec![0; intact.len()];
    let mut any = false;
    for (k, offset) in arrays.offsets.iter().enumerate() {
        let mut over = 0;
        for lane in lanes_of(intact[k] & bonds.lanes) {
            let here = place + lane;
            let eta = arrays.difference(here, offset.shift);
            let (measure, square) = L::Measure::stretch_measure(offset.xi, eta);
            if measure > rule.threshold * square {
                let ends = [here, here.wrapping_add_signed(offset.shift)];
                let limit = rule.limit(ends.map(|place| place - arrays.margin));
                over |= u8::from(measure > L::Measure::threshold(limit) * square) << lane;
            }
        }
        if over != 0 {
            broken[k] = over & rule.bonds.breakable(bonds.chunk, k);
            any |= broken[k] != 0;
        }
    }
    if any {
        take_bonds::<L, D>(arrays, rule, bonds, intact, &broken, tally);
    }
    any
}

/// Clears the bits of broken bonds and records the energy that their points dissipate.
pub(super) fn take_bonds<L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    rule: &StencilRule<'_>,
    bonds: ChunkBonds<'_>,
    intact: &mut [u8],
    broken: &[u8],
    tally: &mut Tally,
) {
    for (lane, i) in bonds.chunk.points() {
        let is_of_lane = |bits: &&u8| *bits >> lane & 1 == 1;
        let count = broken.iter().filter(is_of_lane).count();
        if count == 0 {
            continue;
        }
        tally.broken.add(count as u64);
        let place = [arrays.place(bonds.chunk), lane];
        let (loss, lost) = loss_of::<L, D>(arrays, rule, place, i, |k| [intact[k], broken[k]]);
        let energy = loss.dissipated(rule.states, [i, i], rule.volumes[i], rule.step);
        tally.lose(i, energy, &lost);
    }
    for (k, (intact, broken)) in intact.iter_mut().zip(broken).enumerate() {
        *intact &= !broken;
        if rule.note_events {
            let group = bonds.number * arrays.offsets.len() + k;
            tally
                .events
                .extend(lanes_of(*broken).map(|lane| BreakEvent {
                    point: bonds.chunk.point,
                    entry: group * LANES + lane,
                    dissipated: 0.0,
                }));
        }
    }
}

/// Returns the loss of point i in a lane of the chunk at a place, and the breaking bonds; `bits` are the intact and the
/// breaking bonds of an offset.
fn loss_of<L: Kinematics, const D: usize>(
    arrays: &Arrays<'_, D>,
    rule: &StencilRule<'_>,
    [place, lane]: [usize; 2],
    i: usize,
    bits: impl Fn(usize) -> [u8; 2],
) -> (Loss, Vec<LostBond<D>>) {
    let here = place + lane;
    let (mut loss, mut lost) = (Loss::new(rule.step), Vec::new());
    for (k, offset) in arrays.offsets.iter().enumerate() {
        let [left, broken] = bits(k).map(|bits| bits >> lane & 1 == 1);
        if !left {
            continue;
        }
        let ends = [here, here.wrapping_add_signed(offset.shift)];
        let j = rule.bonds.layout().point_at(ends[1] - arrays.margin);
        let velocity = |field: Field<'_>| field.difference([i, j]);
        let bond = LosingBond {
            neighbour: j,
            xi: offset.xi,
            eta: arrays.difference(here, offset.shift),
            velocity: rule.velocity.map_or([0.0; D], velocity),
            weight: offset.weight,
            factor: 1.0,
            thermal: rule.stretches.map_or(0.0, |stretches| stretches[i]),
            critical: rule.limit(ends.map(|place| place - arrays.margin)),
        };
        lost.extend(loss.add::<L, D>(&bond, broken));
    }
    (loss, lost)
}

/// Returns the lanes whose bits are set.
fn lanes_of(bits: u8) -> impl Iterator<Item = usize> {
    (0..LANES).filter(move |lane| bits >> lane & 1 == 1)
}
