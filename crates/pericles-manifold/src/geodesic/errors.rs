//! How far the distances of a method are from the true ones.

use super::{GeodesicMethod, GeodesicPairs, geodesic_pairs};
use crate::surface::Surface;
use pericles::Result;

/// Relative errors d/d_true − 1 of a method, over all pairs that are truly nearer than the horizon, and what they do to the families.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeodesicErrors {
    /// Mean error.
    pub mean: f64,
    /// Root mean square error.
    pub rms: f64,
    /// Largest error, as absolute value.
    pub max: f64,
    /// Part of the true pairs that the method places beyond the horizon.
    pub lost: f64,
    /// Pairs that the method alone places within the horizon, as part of the true ones.
    pub extra: f64,
}

/// By how much the search is widened to find the pairs that a method places beyond the horizon.
const WIDER: f64 = 1.3;

impl GeodesicErrors {
    /// Compares a method with the true distances, `truth` holding all pairs nearer than `delta` (m).
    ///
    /// # Errors
    /// As [`geodesic_pairs`].
    pub fn of_method(
        surface: &Surface,
        delta: f64,
        method: GeodesicMethod,
        truth: &GeodesicPairs,
    ) -> Result<Self> {
        // Every method joins all vertices of a part, so that the search finds all of them in the end.
        let mut reach = WIDER * delta;
        loop {
            let found = geodesic_pairs(surface, reach, method)?;
            if let Some(errors) = Self::new(&found, truth, delta) {
                return Ok(errors);
            }
            reach *= WIDER;
        }
    }

    /// Compares pairs found by a method with the true ones nearer than `delta` (m); `None` if a true pair is not among them.
    pub fn new(found: &GeodesicPairs, truth: &GeodesicPairs, delta: f64) -> Option<Self> {
        let (mut sum, mut squares, mut max) = (0.0, 0.0, 0.0f64);
        let mut lost = 0;
        for i in 0..truth.vertices() {
            let (neighbours, distances) = truth.row(i);
            let (candidates, lengths) = found.row(i);
            let mut at = 0;
            for (neighbour, true_distance) in neighbours.iter().zip(distances) {
                at += candidates[at..]
                    .iter()
                    .position(|other| other == neighbour)?;
                let error = lengths[at] / true_distance - 1.0;
                sum += error;
                squares += error * error;
                max = max.max(error.abs());
                lost += usize::from(lengths[at] >= delta);
            }
        }
        let within = found
            .distance
            .iter()
            .filter(|&&length| length < delta)
            .count();
        let count = truth.len() as f64;
        Some(Self {
            mean: sum / count,
            rms: (squares / count).sqrt(),
            max,
            lost: lost as f64 / count,
            extra: (within + lost - truth.len()) as f64 / count,
        })
    }
}
