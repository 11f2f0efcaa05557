//! Blue noise by parallel dart throwing.
//!
//! The box is divided into cells of side r/√D, which contain at most one point. In each round a dart is
//! thrown into every part of a cell that may have space; a dart inside the body and at least r away from all
//! points becomes a point. Between rounds the parts are halved along each axis, and parts covered by a point
//! or outside the body are discarded, so that darts are thrown only where space is left (Ebeida et al. 2012).
//! Cells are processed in 3^D groups: two cells of a group are so far apart that their darts cannot conflict,
//! so that they are processed in parallel (Wei 2008). The order of the groups is random in each round.

use rayon::prelude::*;

use super::Inside;
use super::hash::{bits, uniform};
use crate::fill::FillError;

/// Rounds, each with the number of times that cells have been halved.
const LEVELS: [u32; 8] = [0, 0, 1, 2, 3, 4, 5, 6];

/// Maximum number of cells.
const MOST_CELLS: f64 = 4e9;

/// The mean spacing of a saturated set of points with minimum distance r is r divided by these numbers in 1,
/// 2 and 3 dimensions: ρ^(1/D) with the densities ρ r^D of random sequential addition at saturation, 0.7476
/// (Rényi 1958), 0.5471 · 4/π and 0.3841 · 6/π (Zhang and Torquato 2013).
const SATURATED: [f64; 3] = [0.7476, 0.8346, 0.9018];

/// A part of a cell: the cell, and the index of the part along each axis at the current level.
#[derive(Debug, Clone, Copy)]
struct Part {
    cell: u32,
    place: [u8; 3],
}

struct Discs<'a> {
    dimension: usize,
    radius: f64,
    side: f64,
    low: [f64; 3],
    counts: [usize; 3],
    seed: u64,
    inside: &'a Inside<'a>,
    /// Point in each cell.
    points: Vec<Option<u32>>,
    positions: Vec<[f64; 3]>,
}

/// Creates random points in a body with a mean spacing of about `spacing`; their minimum distance is 0.748,
/// 0.835 or 0.902 times `spacing` in 1, 2 or 3 dimensions. Coordinates beyond `dimension` are taken from the
/// lower corner of `bounds`, a box that contains the body. Regions thinner than half a spacing may be missed.
/// Points are ordered by their cells; x varies fastest.
///
/// # Errors
/// Returns an error for a spacing that is not positive and for a box with too many cells.
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
        if cells > MOST_CELLS || cells.is_nan() {
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
        points: vec![None; counts.iter().product()],
        positions: Vec::new(),
    };
    discs.throw_all();
    let found = discs.points.iter().flatten();
    Ok(found
        .map(|&point| discs.positions[point as usize])
        .collect())
}

impl Discs<'_> {
    fn place(&self, cell: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts;
        [cell % nx, cell / nx % ny, cell / (nx * ny)]
    }

    /// Returns the lower corner of a part, and its side length.
    fn corner(&self, part: Part, level: u32) -> ([f64; 3], f64) {
        let side = self.side / f64::from(1u32 << level);
        let place = self.place(part.cell as usize);
        let corner = std::array::from_fn(|c| match c < self.dimension {
            true => self.low[c] + place[c] as f64 * self.side + f64::from(part.place[c]) * side,
            false => self.low[c],
        });
        (corner, side)
    }

    /// Returns the points in the cells within two cells of a cell.
    fn points_near(&self, cell: usize) -> Vec<[f64; 3]> {
        let place = self.place(cell);
        let range = |c: usize| place[c].saturating_sub(2)..(place[c] + 3).min(self.counts[c]);
        let mut near = Vec::new();
        for k in range(2) {
            for j in range(1) {
                let row = (k * self.counts[1] + j) * self.counts[0];
                let cells = &self.points[row + range(0).start..row + range(0).end];
                let points = cells.iter().flatten();
                near.extend(points.map(|&point| self.positions[point as usize]));
            }
        }
        near
    }

    /// Throws a dart into each part of a cell and returns the first one that becomes a point. The first part
    /// is chosen at random.
    fn thrown(&self, parts: &[Part], round: usize, level: u32) -> Option<[f64; 3]> {
        let cell = parts[0].cell;
        let near = self.points_near(cell as usize);
        let square = self.radius * self.radius;
        let key = (round as u64) << 32 | u64::from(cell);
        let first = bits(self.seed, key, 0, u64::MAX) as usize % parts.len();
        (0..parts.len()).find_map(|k| {
            let number = (first + k) % parts.len();
            let (corner, side) = self.corner(parts[number], level);
            let dart: [f64; 3] = std::array::from_fn(|c| match c < self.dimension {
                true => corner[c] + side * uniform(self.seed, key, number as u64, c as u64),
                false => corner[c],
            });
            let distance = |p: &[f64; 3]| (0..3).map(|c| (p[c] - dart[c]).powi(2)).sum::<f64>();
            let is_free = near.iter().all(|point| distance(point) >= square);
            (is_free && (self.inside)(dart)).then_some(dart)
        })
    }

    /// Returns whether a part may have space: no point covers it, and a corner or the centre is inside the body.
    fn may_have_room(&self, part: Part, level: u32, near: &[[f64; 3]]) -> bool {
        let (corner, side) = self.corner(part, level);
        let farthest = |point: &[f64; 3]| {
            let along = |c: usize| {
                let low = corner[c] - point[c];
                low.abs().max((low + side).abs()).powi(2)
            };
            (0..self.dimension).map(along).sum::<f64>()
        };
        if near
            .iter()
            .any(|point| farthest(point) < self.radius * self.radius)
        {
            return false;
        }
        let at = |offset: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|c| match c < self.dimension {
                true => corner[c] + side * offset[c],
                false => corner[c],
            })
        };
        (self.inside)(at([0.5; 3]))
            || (0..1 << self.dimension)
                .any(|bits: u32| (self.inside)(at([0, 1, 2].map(|c| f64::from(bits >> c & 1)))))
    }

    /// Returns the halved parts of a cell that may have space.
    fn halved(&self, parts: &[Part], level: u32) -> Vec<Part> {
        let cell = parts[0].cell as usize;
        if self.points[cell].is_some() {
            return Vec::new();
        }
        let near = self.points_near(cell);
        let children = parts.iter().flat_map(|part| {
            (0..1u8 << self.dimension).map(move |bits| Part {
                cell: part.cell,
                place: std::array::from_fn(|c| 2 * part.place[c] + (bits >> c & 1)),
            })
        });
        children
            .filter(|&part| self.may_have_room(part, level, &near))
            .collect()
    }

    fn throw_all(&mut self) {
        let groups = 3usize.pow(self.dimension as u32);
        let mut open: Vec<Vec<Part>> = vec![Vec::new(); groups];
        for cell in 0..self.points.len() {
            let part = Part {
                cell: cell as u32,
                place: [0; 3],
            };
            if self.may_have_room(part, 0, &[]) {
                let [i, j, k] = self.place(cell).map(|n| n % 3);
                open[(k * 3 + j) * 3 + i].push(part);
            }
        }
        let mut before = 0;
        for (round, level) in LEVELS.into_iter().enumerate() {
            for group in &mut open {
                let cells: Vec<&[Part]> = group.chunk_by(|a, b| a.cell == b.cell).collect();
                let own = &*self;
                let parts: Vec<Vec<Part>> = cells
                    .par_iter()
                    .map(
                        |parts| match (level > before, own.points[parts[0].cell as usize]) {
                            (true, _) => own.halved(parts, level),
                            (false, None) => parts.to_vec(),
                            (false, Some(_)) => Vec::new(),
                        },
                    )
                    .collect();
                *group = parts.concat();
            }
            before = level;
            let mut order: Vec<usize> = (0..groups).collect();
            order.sort_by_key(|&group| bits(self.seed, round as u64, group as u64, 1));
            for group in order {
                let cells: Vec<&[Part]> = open[group].chunk_by(|a, b| a.cell == b.cell).collect();
                let darts: Vec<Option<[f64; 3]>> = cells
                    .par_iter()
                    .map(|parts| self.thrown(parts, round, level))
                    .collect();
                for (parts, dart) in cells.iter().zip(darts) {
                    if let Some(dart) = dart {
                        self.points[parts[0].cell as usize] = Some(self.positions.len() as u32);
                        self.positions.push(dart);
                    }
                }
            }
        }
    }
}
