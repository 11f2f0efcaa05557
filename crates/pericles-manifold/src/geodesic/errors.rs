//! Errors of geodesic distances compared with a reference.

use super::{GeodesicMethod, GeodesicPairs, geodesic_pairs};
use crate::surface::Surface;
use pericles::Result;

/// Relative errors d/d_ref − 1 of a method over all pairs whose reference distance is below the horizon, and
/// the resulting changes of the families.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeodesicErrors {
    /// Mean error.
    pub mean: f64,
    /// Root mean square error.
    pub rms: f64,
    /// Largest absolute error.
    pub max: f64,
    /// Fraction of the reference pairs that the method places beyond the horizon.
    pub lost: f64,
    /// Pairs that only the method places within the horizon, as a fraction of the reference pairs.
    pub extra: f64,
}

/// Factor by which the search radius grows until all reference pairs are found.
const WIDER: f64 = 1.3;

impl GeodesicErrors {
    /// Compares a method with reference distances; `truth` holds all pairs nearer than `delta` (m).
    ///
    /// # Errors
    /// As [`geodesic_pairs`].
    pub fn of_method(
        surface: &Surface,
        delta: f64,
        method: GeodesicMethod,
        truth: &GeodesicPairs,
    ) -> Result<Self> {
        // Every method connects all vertices of a component, so the search finds all pairs eventually.
        let mut reach = WIDER * delta;
        loop {
            let found = geodesic_pairs(surface, reach, method)?;
            if let Some(errors) = Self::new(&found, truth, delta) {
                return Ok(errors);
            }
            reach *= WIDER;
        }
    }

    /// Compares the pairs found by a method with the reference pairs nearer than `delta` (m); `None` if a
    /// reference pair is missing.
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
