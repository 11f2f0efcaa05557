//! Points sorted into the cells of a grid.

use rayon::prelude::*;

use crate::vector::V3;

/// A point and its position, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    pub(super) place: V3,
    pub(super) point: u32,
}

/// Points sorted into cells. The grid repeats in space after a number of cells, so that its memory does not depend on
/// how far fragments fly apart: points of cells far from each other may share a cell.
pub(super) struct Cells {
    side: f64,
    low: V3,
    /// Number of cells in each direction before the grid repeats: at least three in the directions of the body,
    /// otherwise one.
    counts: [usize; 3],
    dimension: usize,
    starts: Vec<u32>,
    points: Vec<Placed>,
}

impl Cells {
    /// Sorts points at `places` (m) into cells with edges of length `side` (m).
    pub(super) fn new(places: &[V3], dimension: usize, side: f64) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for place in places {
            for c in 0..3 {
                low[c] = low[c].min(place[c]);
                high[c] = high[c].max(place[c]);
            }
        }
        let mut cells = Self {
            side,
            low,
            counts: counts(low, high, dimension, side, places.len()),
            dimension,
            starts: Vec::new(),
            points: vec![
                Placed {
                    place: [0.0; 3],
                    point: 0
                };
                places.len()
            ],
        };
        let all: usize = cells.counts.iter().product();
        let own: Vec<u32> = places
            .par_iter()
            .map(|&place| cells.number(cells.cell(place)) as u32)
            .collect();
        // First counts, then ends, then starts of the cells.
        let mut starts = vec![0; all + 1];
        own.iter().for_each(|&cell| starts[cell as usize] += 1);
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        for (point, &cell) in own.iter().enumerate().rev() {
            let next = &mut starts[cell as usize];
            *next -= 1;
            cells.points[*next as usize] = Placed {
                place: places[point],
                point: point as u32,
            };
        }
        cells.starts = starts;
        cells
    }

    fn cell(&self, place: V3) -> [usize; 3] {
        let mut cell = [0; 3];
        for c in 0..self.dimension {
            let along = ((place[c] - self.low[c]) / self.side) as usize;
            let count = self.counts[c];
            cell[c] = if along < count { along } else { along % count };
        }
        cell
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    /// Calls `found` once for each point in the cell of a place and in the cells around it, and for others that share
    /// these cells.
    #[inline]
    pub(super) fn visit(&self, place: V3, mut found: impl FnMut(&Placed)) {
        let [x, y, z] = self.cell(place);
        let (ys, zs) = (self.around(1, y), self.around(2, z));
        let width = self.counts[0];
        for &z in zs.iter().flatten() {
            for &y in ys.iter().flatten() {
                let row = self.number([0, y, z]);
                // Cells next to each other are stored one after the other.
                if (1..width - 1).contains(&x) {
                    self.run(row + x - 1, row + x + 2, &mut found);
                } else {
                    for &x in self.around(0, x).iter().flatten() {
                        self.run(row + x, row + x + 1, &mut found);
                    }
                }
            }
        }
    }

    /// A coordinate of a cell and the coordinates of its neighbours.
    fn around(&self, c: usize, x: usize) -> [Option<usize>; 3] {
        let count = self.counts[c];
        if c >= self.dimension {
            return [None, Some(x), None];
        }
        let before = if x == 0 { count - 1 } else { x - 1 };
        let after = if x + 1 == count { 0 } else { x + 1 };
        [Some(before), Some(x), Some(after)]
    }

    #[inline]
    fn run(&self, first: usize, end: usize, found: &mut impl FnMut(&Placed)) {
        let run = self.starts[first] as usize..self.starts[end] as usize;
        self.points[run].iter().for_each(found);
    }
}

/// Number of cells in each direction: in the box of all points and one beyond, with a limit on their product.
fn counts(low: V3, high: V3, dimension: usize, side: f64, points: usize) -> [usize; 3] {
    const LEAST: usize = 3;
    let most = 2 * points + 64;
    let mut counts = [1; 3];
    for c in 0..dimension {
        let cells = ((high[c] - low[c]) / side).min(most as f64) as usize;
        counts[c] = (cells + 2).max(LEAST);
    }
    while counts.iter().map(|&count| count as f64).product::<f64>() > most as f64 {
        let largest = counts.iter_mut().max_by_key(|count| **count);
        match largest {
            Some(count) if *count > LEAST => *count = count.div_ceil(2).max(LEAST),
            _ => break,
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{dot, minus};

    /// Pairs closer than `side`, by cells.
    fn near(places: &[V3], dimension: usize, side: f64) -> Vec<[usize; 2]> {
        let cells = Cells::new(places, dimension, side);
        let mut found = Vec::new();
        for (i, &place) in places.iter().enumerate() {
            cells.visit(place, |other| {
                let apart = minus(other.place, place);
                if other.point as usize != i && dot(apart, apart) < side * side {
                    found.push([i, other.point as usize]);
                }
            });
        }
        found.sort_unstable();
        found
    }

    fn all(places: &[V3], side: f64) -> Vec<[usize; 2]> {
        let pairs = (0..places.len()).flat_map(|i| (0..places.len()).map(move |j| [i, j]));
        let close = |&[i, j]: &[usize; 2]| {
            let apart = minus(places[j], places[i]);
            i != j && dot(apart, apart) < side * side
        };
        pairs.filter(close).collect()
    }

    #[test]
    fn cells_find_the_pairs_of_a_search_of_all_pairs_at_any_extent() {
        for dimension in 1..=3 {
            // From one cell to extents at which the grid repeats many times.
            for extent in [0.5, 3.0, 8.0, 1e3] {
                for side in [0.7, 1.0, 2.5] {
                    let mut places = Vec::new();
                    for k in 0..300 {
                        let mut place = [0.0; 3];
                        for (c, x) in place.iter_mut().enumerate().take(dimension) {
                            *x = extent * (12.9898 * (k * 3 + c) as f64).sin();
                        }
                        places.push(place);
                    }
                    // A fragment far away, and two points at the same place.
                    places[7][0] = 1e9;
                    places[8] = places[9];
                    let found = near(&places, dimension, side);
                    assert_eq!(found, all(&places, side), "{dimension}D, {extent}, {side}");
                    assert!(!found.is_empty());
                }
            }
        }
    }

    #[test]
    fn positions_that_are_not_numbers_do_not_stop_the_search() {
        let places = vec![[f64::NAN; 3], [0.0; 3], [0.5, 0.0, 0.0], [f64::INFINITY; 3]];
        assert_eq!(near(&places, 3, 1.0), vec![[1, 2], [2, 1]]);
        assert!(near(&[], 3, 1.0).is_empty());
    }
}
