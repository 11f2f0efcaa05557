//! Bond failure, evaluated for chunks with large strains in the force sweep.

use super::arrays::Grid;
use super::numbers::GridNumber;
use super::thresholds::PlaceThresholds;
use crate::domain::Field;
use crate::lanes::LANES;
use crate::lanes::Lanes;
use crate::neighbourhood::Chunk;
use crate::neighbourhood::turns_around;
use crate::neighbourhood::{BreakEvent, Tally};
use crate::operator::fast_law::VectorLaw;
use crate::step_end::{BreakingBond, StepEnd, relative_velocity};

/// Failure criterion read by the loops.
pub(super) struct GridBreaking<'a> {
    /// A bond is over-stretched if measure > threshold |ξ|².
    pub threshold: f64,
    /// Critical stretch, if it is the same for all bonds.
    pub critical_stretch: f64,
    /// Thresholds that depend on the ends of a bond; `threshold` is then the smallest of them.
    pub pairs: Option<&'a PlaceThresholds>,
    /// Volume of a point, m³.
    pub volume: f64,
    /// Bits of the bonds of a chunk and offset that may break.
    pub breakable: &'a (dyn Fn(&Chunk, usize) -> u8 + Sync),
    /// Point at a place of the padded rows.
    pub point_at: &'a (dyn Fn(usize) -> usize + Sync),
    /// The step that ends.
    pub step: &'a StepEnd<'a>,
    /// Mean velocities over the step, if it has any.
    pub velocity: Option<Field<'a>>,
    /// Whether breaking bonds are recorded for the update of their other end.
    pub note_events: bool,
}

impl GridBreaking<'_> {
    /// Returns the smallest threshold of the bonds of `count` chunks from `first` on.
    #[inline(always)]
    pub(super) fn smallest_threshold(&self, first: usize, count: usize) -> f64 {
        match self.pairs {
            None => self.threshold,
            Some(pairs) => pairs.smallest(first, count),
        }
    }
}

/// A chunk whose bonds are checked individually.
pub(super) struct ChunkBonds<'a> {
    pub chunk: &'a Chunk,
    /// Requested lanes.
    pub lanes: u8,
    /// Intact bonds, one byte per offset.
    pub intact: &'a mut [u8],
    /// Index of the first byte among all bytes.
    pub entry: usize,
}

/// Breaks the over-stretched bonds of the requested lanes of a chunk and records their energy. Returns
/// whether a bond broke.
///
/// The criterion uses [`crate::material::PairForce::stretch_measure`] in double precision, which is bitwise
/// identical at both ends and for all instruction sets. (The measure and its threshold scale in the same way with the
/// unit of length.)
#[inline(always)]
pub(super) fn break_chunk<T: Lanes, L: VectorLaw, N: GridNumber, const D: usize>(
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
        if let Some(heat) = grid.heat {
            let both = N::load::<T>(heat, place) + N::load::<T>(heat, there);
            let thermal = T::splat(0.5) * both;
            for c in 0..D {
                eta[c] = eta[c] - thermal * xi[c];
                xi[c] = (T::splat(1.0) + thermal) * xi[c];
            }
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

/// Records half of the energy of the bonds of an offset that have just broken; the other end records the
/// other half.
#[cold]
#[inline(never)]
fn book<L: VectorLaw, N: GridNumber, const D: usize>(
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
        let thermal = grid.thermal([here, there]);
        let eta: [f64; D] =
            std::array::from_fn(|c| difference(grid.u[c]) * grid.unit - thermal * xi[c]);
        let xi = xi.map(|component| (1.0 + thermal) * component);
        let stiffness = grid.stiffness(bonds.entry / grid.offsets.len(), number, k);
        let stiffness = (1.0 + thermal) * stiffness;
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
        let dissipated = tally.book(rule.step, &bond, |moved: [f64; D]| {
            let before = std::array::from_fn(|c| eta[c] - moved[c]);
            turns_around(&xi, &before, &eta).then(|| (L::force(xi, before), L::energy(xi, before)))
        });
        if rule.note_events {
            tally.events.push(BreakEvent {
                point: chunk.point,
                entry: entry + k,
                dissipated,
            });
        }
    }
}
