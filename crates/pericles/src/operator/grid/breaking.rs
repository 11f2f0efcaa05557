//! Breaking of a chunk's bonds, decided where the force sweep has seen a large strain.

use super::arrays::Grid;
use super::layout::Chunk;
use super::numbers::GridNumber;
use super::thresholds::PlaceThresholds;
use crate::domain::Field;
use crate::lanes::LANES;
use crate::lanes::Lanes;
use crate::operator::damage::{BreakEvent, Tally};
use crate::operator::fast_law::FastLaw;
use crate::step_end::{BreakingBond, StepEnd, relative_velocity};

/// Breaking as the loops see it.
pub(super) struct GridBreaking<'a> {
    /// Bonds with measure > threshold |ξ|² are over-stretched.
    pub threshold: f64,
    /// The critical stretch, where all bonds have the same.
    pub critical_stretch: f64,
    /// Thresholds that depend on the ends of a bond, in place of the one, which is then the smallest of them.
    pub pairs: Option<&'a PlaceThresholds>,
    /// Volume of a point, m³.
    pub volume: f64,
    /// Which bonds of a chunk and offset may break.
    pub breakable: &'a (dyn Fn(&Chunk, usize) -> u8 + Sync),
    /// The point at a place of the padded rows.
    pub point_at: &'a (dyn Fn(usize) -> usize + Sync),
    /// The step that ended.
    pub step: &'a StepEnd<'a>,
    /// Mean velocities over the step, where it has any.
    pub velocity: Option<Field<'a>>,
    /// Note what breaks, so that the other end can be told.
    pub note_events: bool,
}

impl GridBreaking<'_> {
    /// The smallest threshold of the bonds of so many chunks from `first` on.
    #[inline(always)]
    pub(super) fn smallest_threshold(&self, first: usize, count: usize) -> f64 {
        match self.pairs {
            None => self.threshold,
            Some(pairs) => pairs.smallest(first, count),
        }
    }
}

/// A chunk whose bonds are looked at one by one.
pub(super) struct ChunkBonds<'a> {
    pub chunk: &'a Chunk,
    /// Its wanted lanes.
    pub lanes: u8,
    /// Its bonds left, a byte per offset.
    pub intact: &'a mut [u8],
    /// Number of the first byte, of all there are.
    pub entry: usize,
}

/// Breaks the over-stretched bonds of a chunk's wanted lanes and books their energy; says whether there were any.
///
/// Decided with [`crate::material::PairForce::stretch_measure`] in doubles, whose rounding is the same at both ends and for all instruction sets. (The measure and
/// its threshold grow alike with the unit of length.)
#[inline(always)]
pub(super) fn break_chunk<T: Lanes, L: FastLaw, N: GridNumber, const D: usize>(
    grid: &Grid<'_, N, D>,
    rule: &GridBreaking<'_>,
    bonds: ChunkBonds<'_>,
    tally: &mut Tally,
) -> bool {
    let place = grid.place(bonds.chunk);
    let mut here = [T::splat(0.0); D];
    for c in 0..D {
        here[c] = N::load::<T>(grid.u[c], place);
    }
    let threshold = T::splat(rule.threshold);
    let first = place - grid.margin;
    let mut any = false;
    for k in 0..grid.offsets.len() {
        let offset = &grid.offsets[k];
        let candidates = bonds.intact[k] & bonds.lanes;
        if candidates == 0 {
            continue;
        }
        let there = place.wrapping_add_signed(offset.shift);
        let (mut xi, mut eta) = (here, here);
        for c in 0..D {
            xi[c] = T::splat(offset.xi[c].into());
            eta[c] = N::load::<T>(grid.u[c], there) - here[c];
        }
        let threshold = match rule.pairs {
            None => threshold,
            Some(pairs) => T::load(&pairs.of_lanes(first, offset.shift), 0),
        };
        let (measure, square) = L::stretch_measure(xi, eta);
        let mut over = measure.greater(threshold * square) & candidates;
        if over != 0 {
            over &= (rule.breakable)(bonds.chunk, k);
            bonds.intact[k] &= !over;
            any |= over != 0;
            book::<L, N, D>(grid, rule, &bonds, k, over, tally);
        }
    }
    any
}

/// Books the energy of bonds of one offset that have just broken. Each end books half.
#[cold]
#[inline(never)]
fn book<L: FastLaw, N: GridNumber, const D: usize>(
    grid: &Grid<'_, N, D>,
    rule: &GridBreaking<'_>,
    bonds: &ChunkBonds<'_>,
    number: usize,
    over: u8,
    tally: &mut Tally,
) {
    let (chunk, offset) = (bonds.chunk, &grid.offsets[number]);
    let entry = (bonds.entry + number) * LANES;
    let xi = offset.xi.map(|component| component.into() * grid.unit);
    for k in (0..LANES).filter(|k| over >> k & 1 == 1) {
        let here = grid.place(chunk) + k;
        let there = here.wrapping_add_signed(offset.shift);
        let difference = |field: &[N]| -> f64 { field[there].into() - field[here].into() };
        let eta: [f64; D] = std::array::from_fn(|c| difference(grid.u[c]) * grid.unit);
        let stiffness = grid.stiffness(bonds.entry / grid.offsets.len(), number, k);
        let places = [here, there].map(|place| place - grid.margin);
        let ends = places.map(rule.point_at);
        let stretch = match rule.pairs {
            None => rule.critical_stretch,
            Some(pairs) => pairs.critical_stretch(places),
        };
        let bond = BreakingBond {
            ends,
            velocity: relative_velocity(rule.velocity, ends),
            force: L::force(xi, eta),
            energy: L::energy(xi, eta),
            critical: Some(L::energy(xi, xi.map(|component| stretch * component))),
            weight: rule.volume * stiffness,
        };
        let dissipated = tally.book(rule.step, &bond);
        if rule.note_events {
            tally.events.push(BreakEvent {
                point: chunk.point,
                entry: entry + k,
                dissipated,
            });
        }
    }
}
