//! Volumes of irregular points.

use std::sync::atomic::{AtomicU32, Ordering};

use rayon::prelude::*;

use super::Inside;
use crate::fill::{FillError, Lattice};

/// Samples of a body per spacing.
const SAMPLES: f64 = 4.0;

/// Points sorted into the cells of a grid.
struct Buckets<'a> {
    grid: Lattice,
    positions: &'a [[f64; 3]],
    ends: Vec<usize>,
    points: Vec<u32>,
}

impl<'a> Buckets<'a> {
    fn new(grid: Lattice, positions: &'a [[f64; 3]]) -> Self {
        let mut buckets = Self {
            grid,
            positions,
            ends: vec![0; grid.len() + 1],
            points: vec![0; positions.len()],
        };
        let cells: Vec<usize> = positions
            .iter()
            .map(|&x| buckets.number(buckets.cell(x)))
            .collect();
        for &cell in &cells {
            buckets.ends[cell + 1] += 1;
        }
        for cell in 1..buckets.ends.len() {
            buckets.ends[cell] += buckets.ends[cell - 1];
        }
        let mut next = buckets.ends.clone();
        for (point, &cell) in cells.iter().enumerate() {
            buckets.points[next[cell]] = point as u32;
            next[cell] += 1;
        }
        buckets
    }

    fn cell(&self, x: [f64; 3]) -> [usize; 3] {
        std::array::from_fn(|c| {
            let place = (x[c] - self.grid.coordinate(c, 0)) / self.grid.spacing[c] + 0.5;
            (place.max(0.0) as usize).min(self.grid.counts[c] - 1)
        })
    }

    fn number(&self, [i, j, k]: [usize; 3]) -> usize {
        let [nx, ny, _] = self.grid.counts;
        (k * ny + j) * nx + i
    }

    /// Returns the nearest point, the first one if several are equally near; `None` without points.
    fn nearest(&self, x: [f64; 3]) -> Option<u32> {
        let cell = self.cell(x);
        let least_spacing = self.grid.spacing.iter().copied().fold(f64::MAX, f64::min);
        let most = self.grid.counts.iter().copied().max().unwrap_or(1);
        let mut best: Option<(f64, u32)> = None;
        for ring in 0..=most {
            // Points beyond a ring are farther away than ring − 1 spacings.
            let bound = (ring as f64 - 1.0).max(0.0) * least_spacing;
            if best.is_some_and(|(square, _)| square < bound * bound) {
                break;
            }
            self.visit_ring(cell, ring, |point| {
                let p = self.positions[point as usize];
                let square = (0..3).map(|c| (p[c] - x[c]).powi(2)).sum::<f64>();
                let is_better = best.is_none_or(|(least, first)| {
                    square < least || (square == least && point < first)
                });
                if is_better {
                    best = Some((square, point));
                }
            });
        }
        best.map(|(_, point)| point)
    }

    /// Visits the points in the cells at a maximum distance of `ring` cells along an axis.
    fn visit_ring(&self, cell: [usize; 3], ring: usize, mut visit: impl FnMut(u32)) {
        let range = |c: usize| {
            let end = (cell[c] + ring + 1).min(self.grid.counts[c]);
            cell[c].saturating_sub(ring)..end
        };
        for k in range(2) {
            for j in range(1) {
                for i in range(0) {
                    let far = [i, j, k].iter().zip(cell).map(|(a, b)| a.abs_diff(b)).max();
                    if far != Some(ring) {
                        continue;
                    }
                    let number = self.number([i, j, k]);
                    for &point in &self.points[self.ends[number]..self.ends[number + 1]] {
                        visit(point);
                    }
                }
            }
        }
    }
}

/// Returns volumes of points from their Voronoi cells within the body, with 4 samples per `spacing` along
/// each axis. Their sum is the volume of the samples inside; every point has at least one sample. Axes beyond
/// `dimension` have unit length.
///
/// # Errors
/// Returns an error for a spacing that is not positive and for a box with too many samples.
pub fn nearest_volumes(
    positions: &[[f64; 3]],
    bounds: [[f64; 3]; 2],
    dimension: usize,
    spacing: f64,
    inside: &Inside<'_>,
) -> Result<Vec<f64>, FillError> {
    let mut bounds = bounds;
    for c in dimension.clamp(1, 3)..3 {
        bounds[1][c] = bounds[0][c];
    }
    let lattice_of = |spacing: f64| {
        let along: [f64; 3] = std::array::from_fn(|c| if c < dimension { spacing } else { 1.0 });
        Lattice::around(bounds, along)
    };
    let buckets = Buckets::new(lattice_of(spacing)?, positions);
    let samples = lattice_of(spacing / SAMPLES)?;
    let counts: Vec<AtomicU32> = positions.iter().map(|_| AtomicU32::new(0)).collect();
    let [nx, ny, nz] = samples.counts;
    // Integers: the order of additions does not matter.
    let found: u64 = (0..ny * nz)
        .into_par_iter()
        .map(|row| {
            let mut found = 0;
            for i in 0..nx {
                let x = samples.position([i, row % ny, row / ny]);
                if !inside(x) {
                    continue;
                }
                found += 1;
                if let Some(point) = buckets.nearest(x) {
                    counts[point as usize].fetch_add(1, Ordering::Relaxed);
                }
            }
            found
        })
        .sum();
    let counts: Vec<u64> = counts
        .into_iter()
        .map(|count| u64::from(count.into_inner()).max(1))
        .collect();
    let total: u64 = counts.iter().sum();
    let volume = found as f64 * samples.cell_volume();
    let share = |&count: &u64| volume * (count as f64 / total as f64);
    Ok(counts.iter().map(share).collect())
}
