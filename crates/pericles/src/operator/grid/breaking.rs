//! Breaking of a chunk's bonds, decided where the force sweep has seen a large strain.

use super::kernels::{Grid, xi};
use super::layout::Chunk;
use super::stencil::Offset;
use crate::family::LANES;
use crate::operator::damage::{BreakEvent, Tally};
use crate::operator::fast_law::FastLaw;
use crate::operator::lanes::Lanes;

/// Breaking as the loops see it.
pub(super) struct GridBreaking<'a, const D: usize> {
    /// Bonds with measure > threshold |ξ|² are over-stretched.
    pub threshold: f64,
    /// Volume of a point, m³.
    pub volume: f64,
    /// Which bonds of a chunk and offset may break.
    pub breakable: &'a (dyn Fn(&Chunk, usize) -> u8 + Sync),
    /// The point at a place of the padded rows.
    pub point_at: &'a (dyn Fn(usize) -> usize + Sync),
    /// Mean velocity of the points and length of the step that ended, where the force acted for only half of it.
    pub step: Option<([&'a [f64]; D], f64)>,
    /// Note what breaks, so that the other end can be told.
    pub note_events: bool,
}

/// Breaks the over-stretched bonds of a chunk's wanted lanes and books their energy; says whether there were any.
///
/// Decided with [`crate::material::PairForce::stretch_measure`], whose rounding is the same at both ends and for all instruction sets.
#[inline(always)]
pub(super) fn break_chunk<T: Lanes, L: FastLaw, const D: usize>(
    grid: &Grid<'_, D>,
    rule: &GridBreaking<'_, D>,
    chunk: &Chunk,
    lanes: u8,
    intact: &mut [u8],
    first_entry: usize,
    tally: &mut Tally,
) -> bool {
    let place = grid.place(chunk);
    let here = grid.here::<T>(place);
    let threshold = T::splat(rule.threshold);
    let mut any = false;
    for (k, offset) in grid.offsets.iter().enumerate() {
        let candidates = intact[k] & lanes;
        if candidates == 0 {
            continue;
        }
        let eta = grid.eta(place, offset.shift, &here);
        let (measure, square) = L::stretch_measure(xi::<T, D>(offset), eta);
        let mut over = measure.greater(threshold * square) & candidates;
        if over != 0 {
            over &= (rule.breakable)(chunk, k);
            intact[k] &= !over;
            any |= over != 0;
            book::<L, D>(
                grid,
                rule,
                chunk,
                offset,
                over,
                (first_entry + k) * LANES,
                tally,
            );
        }
    }
    any
}

/// Books the energy of bonds of one offset that have just broken. Each end books half.
#[cold]
#[inline(never)]
fn book<L: FastLaw, const D: usize>(
    grid: &Grid<'_, D>,
    rule: &GridBreaking<'_, D>,
    chunk: &Chunk,
    offset: &Offset<D>,
    over: u8,
    entry: usize,
    tally: &mut Tally,
) {
    for k in (0..LANES).filter(|k| over >> k & 1 == 1) {
        let here = grid.place(chunk) + k;
        let there = here.wrapping_add_signed(offset.shift);
        let difference = |field: &[&[f64]; D], here: usize, there: usize| -> [f64; D] {
            std::array::from_fn(|c| field[c][there] - field[c][here])
        };
        let eta = difference(&grid.u, here, there);
        let mut energy = L::energy(offset.xi, eta);
        if let Some((velocity, dt)) = &rule.step {
            let force = L::force(offset.xi, eta);
            let [i, j] = [here, there].map(|place| (rule.point_at)(place - grid.margin));
            let rate = difference(velocity, i, j);
            let power: f64 = (0..D).map(|c| force[c] * rate[c]).sum();
            energy -= 0.5 * dt * power;
        }
        let dissipated = 0.5 * rule.volume * offset.stiffness * energy;
        tally.dissipated += dissipated;
        tally.broken.add(1);
        if rule.note_events {
            tally.events.push(BreakEvent {
                point: chunk.point,
                entry: entry + k,
                dissipated,
            });
        }
    }
}
