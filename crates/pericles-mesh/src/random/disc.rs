//! Blue noise by parallel dart throwing.
//!
//! The box is divided into cells of side r/√D, which hold one point at most. In each round every cell that is open throws one dart; a dart that is inside of the
//! body and no nearer than r to any point becomes a point. Cells are taken in 3^D groups: two cells of one group are too far apart for their darts to meet,
//! so that their darts may fall at once (Wei 2008). The order of the groups is random in each round. A cell that a point covers entirely is closed.

use rayon::prelude::*;

use super::Inside;
use super::hash::{bits, uniform};
use crate::fill::FillError;

/// Darts of a cell.
const ROUNDS: u8 = 48;

/// The largest number of cells.
const MOST_CELLS: f64 = 4e9;

/// The mean spacing of points that are nowhere nearer than r and leave no room for another is r over these numbers, in 1, 2 and 3 dimensions:
/// ρ^(1/D) with the densities ρ r^D of random sequential addition at saturation, 0.7476 (Rényi 1958), 0.5471 · 4/π and 0.3841 · 6/π
/// (Zhang and Torquato 2013).
const SATURATED: [f64; 3] = [0.7476, 0.8346, 0.9018];

/// What a cell holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Open,
    /// The dart of this round.
    Taken(u8),
    Closed,
}

struct Discs<'a> {
    dimension: usize,
    radius: f64,
    side: f64,
    low: [f64; 3],
    counts: [usize; 3],
    seed: u64,
    inside: &'a Inside<'a>,
    states: Vec<State>,
}

/// Random points in a body, nowhere nearer to each other than a radius that makes their mean spacing about `spacing`: 0.748, 0.835 or 0.902 of it in 1, 2 or
/// 3 dimensions. Coordinates beyond `dimension` are those of the lower corner of `bounds`, a box that holds the body. Points are ordered by their cells, x running fastest.
///
/// # Errors
/// A spacing that is not positive, a box of too many cells.
pub fn blue_noise(
    bounds: [[f64; 3]; 2],
    dimension: usize,
    spacing: f64,
    seed: u64,
    inside: &Inside<'_>,
) -> Result<Vec<[f64; 3]>, FillError> {
    if !(spacing > 0.0 && spacing.is_finite()) {
        return Err(FillError::Spacing { value: spacing });
    }
    let dimension = dimension.clamp(1, 3);
    let radius = SATURATED[dimension - 1] * spacing;
    let side = radius / (dimension as f64).sqrt();
    let mut counts = [1; 3];
    let mut cells = 1.0;
    for c in 0..dimension {
        let count = ((bounds[1][c] - bounds[0][c]) / side).ceil().max(1.0);
        cells *= count;
        if !(cells <= MOST_CELLS) {
            return Err(FillError::TooMany {
                nodes: cells,
                most: MOST_CELLS,
            });
        }
        counts[c] = count as usize;
    }
    let mut discs = Discs {
        dimension,
        radius,
        side,
        low: bounds[0],
        counts,
        seed,
        inside,
        states: vec![State::Open; counts.iter().product()],
    };
    discs.throw_all();
    Ok(discs.positions())
}

impl Discs<'_> {
    fn place(&self, cell: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts;
        [cell % nx, cell / nx % ny, cell / (nx * ny)]
    }

    /// The dart of a cell in a round.
    fn dart(&self, cell: usize, round: u8) -> [f64; 3] {
        let place = self.place(cell);
        std::array::from_fn(|c| match c < self.dimension {
            true => {
                let part = uniform(self.seed, cell as u64, u64::from(round), c as u64);
                self.low[c] + (place[c] as f64 + part) * self.side
            }
            false => self.low[c],
        })
    }

    /// The points in the cells within two of a cell.
    fn points_near(&self, cell: usize) -> impl Iterator<Item = [f64; 3]> {
        let place = self.place(cell);
        let range = move |c: usize| {
            let end = (place[c] + 3).min(self.counts[c]);
            place[c].saturating_sub(2)..end
        };
        let cells = range(2).flat_map(move |k| {
            range(1).flat_map(move |j| {
                range(0).map(move |i| (k * self.counts[1] + j) * self.counts[0] + i)
            })
        });
        cells.filter_map(|other| match self.states[other] {
            State::Taken(round) => Some(self.dart(other, round)),
            _ => None,
        })
    }

    /// What an open cell becomes in a round.
    fn thrown(&self, cell: usize, round: u8) -> State {
        let dart = self.dart(cell, round);
        let place = self.place(cell);
        let square = self.radius * self.radius;
        let mut meets = false;
        for point in self.points_near(cell) {
            let (mut distance, mut farthest) = (0.0, 0.0);
            for c in 0..self.dimension {
                distance += (dart[c] - point[c]).powi(2);
                let low = self.low[c] + place[c] as f64 * self.side - point[c];
                farthest += low.abs().max((low + self.side).abs()).powi(2);
            }
            if farthest < square {
                return State::Closed;
            }
            meets |= distance < square;
        }
        match !meets && (self.inside)(dart) {
            true => State::Taken(round),
            false => State::Open,
        }
    }

    fn throw_all(&mut self) {
        let groups = 3usize.pow(self.dimension as u32);
        let mut open: Vec<Vec<u32>> = vec![Vec::new(); groups];
        for cell in 0..self.states.len() {
            let [i, j, k] = self.place(cell).map(|n| n % 3);
            open[(k * 3 + j) * 3 + i].push(cell as u32);
        }
        for round in 0..ROUNDS {
            let mut order: Vec<usize> = (0..groups).collect();
            order.sort_by_key(|&group| bits(self.seed, u64::from(round), group as u64, u64::MAX));
            for group in order {
                let cells = std::mem::take(&mut open[group]);
                let states: Vec<State> = cells
                    .par_iter()
                    .map(|&cell| self.thrown(cell as usize, round))
                    .collect();
                for (&cell, state) in cells.iter().zip(states) {
                    match state {
                        State::Open => open[group].push(cell),
                        _ => self.states[cell as usize] = state,
                    }
                }
            }
        }
    }

    fn positions(&self) -> Vec<[f64; 3]> {
        let cells = self.states.iter().enumerate();
        let taken = cells.filter_map(|(cell, state)| match state {
            State::Taken(round) => Some(self.dart(cell, *round)),
            _ => None,
        });
        taken.collect()
    }
}
