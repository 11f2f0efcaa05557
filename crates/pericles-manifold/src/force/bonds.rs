//! The bonds of a surface with their weights.

use std::ops::Range;

use crate::geodesic::GeodesicPairs;
use pericles::lanes::LANES;
use pericles::operator::prefetch::prefetch;

/// Bonds in compressed rows of eight, each with the factor w_ij A_j of its force: 12 bytes a directed bond, and the padding.
///
/// Point i owns the groups `start[i]..start[i + 1]`; padding names the point itself and has weight zero. Neighbours are below the number of points.
#[derive(Debug, Clone)]
pub struct SurfaceBonds {
    start: Vec<usize>,
    neighbours: Vec<u32>,
    weights: Vec<f64>,
    /// Bonds of each group.
    present: Vec<u8>,
}

/// Entries that stand beside those of the pairs: point, neighbour, factor.
pub(super) type Extra = (u32, u32, f64);

impl SurfaceBonds {
    /// The bonds of all pairs, with `factor(i, j, distance)` = w_ij A_j, and `extra` factors (in any order), which are added to a pair's own or make a new bond.
    ///
    /// # Panics
    /// If a neighbour is no point.
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

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Directed bonds.
    pub fn directed(&self) -> u64 {
        self.present.iter().map(|g| u64::from(g.count_ones())).sum()
    }

    /// The groups of a point.
    #[inline(always)]
    pub(super) fn groups(&self, i: usize) -> Range<usize> {
        self.start[i]..self.start[i + 1]
    }

    /// The neighbours of a group.
    #[inline(always)]
    pub(super) fn group(&self, group: usize) -> &[u32; LANES] {
        self.neighbours[group * LANES..]
            .first_chunk()
            .expect("groups are whole")
    }

    /// Asks for a group that will be read soon.
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

    /// The bonds of a point: entry and neighbour.
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
