//! Bonds of a surface with their weights.

use std::ops::Range;

use crate::geodesic::GeodesicPairs;
use pericles::lanes::LANES;
use pericles::operator::prefetch::prefetch;
use pericles::parallel::{Cost, PointSubset};

/// Bonds in compressed rows, padded to groups of eight, each with the force factor w_ij A_j: 12 bytes per
/// directed bond, plus padding.
///
/// Point i owns the groups `start[i]..start[i + 1]`. Padding refers to the point itself with weight zero. All
/// neighbour numbers are below the number of points.
#[derive(Debug, Clone)]
pub struct SurfaceBonds {
    start: Vec<usize>,
    neighbours: Vec<u32>,
    weights: Vec<f64>,
    /// Number of bonds in each group, without padding.
    present: Vec<u8>,
}

/// Additional entry: point, neighbour, factor.
pub(super) type Extra = (u32, u32, f64);

impl SurfaceBonds {
    /// Builds the bonds of all pairs with `factor(i, j, distance)` = w_ij A_j. The factors in `extra` (any
    /// order) are added to the existing bond of a pair or create a new bond.
    ///
    /// # Panics
    /// If a neighbour is not a point.
    pub(super) fn new(
        pairs: &GeodesicPairs,
        factor: impl Fn(usize, usize, f64) -> f64,
        mut extra: Vec<Extra>,
    ) -> Self {
        let n = pairs.vertices();
        extra.sort_unstable_by_key(|&(i, j, _)| (i, j));
        let mut bonds = Self {
            start: vec![0],
            neighbours: Vec::with_capacity(pairs.len() + n * LANES / 2),
            weights: Vec::with_capacity(pairs.len() + n * LANES / 2),
            present: Vec::new(),
        };
        let mut rest = &extra[..];
        let mut row: Vec<(u32, f64)> = Vec::new();
        for i in 0..n {
            let own = rest.partition_point(|&(point, ..)| point as usize <= i);
            let (additions, after) = rest.split_at(own);
            rest = after;
            let (neighbours, distances) = pairs.row(i);
            row.clear();
            row.extend(
                neighbours
                    .iter()
                    .zip(distances)
                    .map(|(&j, &distance)| (j, factor(i, j as usize, distance))),
            );
            for &(_, j, weight) in additions {
                match row.binary_search_by_key(&j, |&(j, _)| j) {
                    Ok(place) => row[place].1 += weight,
                    Err(place) => row.insert(place, (j, weight)),
                }
            }
            assert!(row.iter().all(|&(j, _)| (j as usize) < n));
            bonds.push_row(i, &row);
        }
        bonds
    }

    fn push_row(&mut self, i: usize, row: &[(u32, f64)]) {
        for group in row.chunks(LANES) {
            self.neighbours.extend(group.iter().map(|&(j, _)| j));
            self.weights.extend(group.iter().map(|&(_, weight)| weight));
            let padding = LANES - group.len();
            self.neighbours
                .extend(std::iter::repeat_n(i as u32, padding));
            self.weights.extend(std::iter::repeat_n(0.0, padding));
            self.present.push(0xFF >> padding);
        }
        self.start.push(self.present.len());
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.start.len() - 1
    }

    /// Returns true if there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of directed bonds.
    pub fn directed(&self) -> u64 {
        self.present.iter().map(|g| u64::from(g.count_ones())).sum()
    }

    /// Returns the cost of a loop over the bonds of a subset of the points.
    pub fn cost(&self, on: &PointSubset<'_>) -> Cost {
        Cost::bonds((LANES * self.present.len()) as u64).on(on, self.len())
    }

    /// Groups of a point.
    #[inline(always)]
    pub(super) fn groups(&self, i: usize) -> Range<usize> {
        self.start[i]..self.start[i + 1]
    }

    /// Neighbours of a group.
    #[inline(always)]
    pub(super) fn group(&self, group: usize) -> &[u32; LANES] {
        self.neighbours[group * LANES..]
            .first_chunk()
            .expect("groups are whole")
    }

    /// Prefetches a group that will be read soon.
    #[inline(always)]
    pub(super) fn prefetch(&self, group: usize) {
        prefetch(&self.weights, group * LANES);
        prefetch(&self.neighbours, group * LANES);
    }

    /// Factors w_ij A_j of all entries.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    pub(super) fn weights_mut(&mut self) -> &mut [f64] {
        &mut self.weights
    }

    /// Iterates over the bonds of a point: entry and neighbour.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.groups(i).flat_map(move |g| {
            (0..LANES)
                .filter(move |k| self.present[g] >> k & 1 == 1)
                .map(move |k| (g * LANES + k, self.neighbours[g * LANES + k] as usize))
        })
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.start[..])
            + size_of_val(&self.neighbours[..])
            + size_of_val(&self.weights[..])
            + self.present.len()
    }
}
