//! Selects the bonds of a surface: pairs of vertices within a geodesic or a Euclidean ball.

use std::f64::consts::FRAC_PI_2;

use super::{GeodesicMethod, GeodesicPairs, geodesic_pairs_cached};
use crate::surface::{Surface, SurfaceError};
use pericles::cache::Cache;
use pericles::family::pairs_where;
use pericles::{PericlesError, Result};

/// Neighbourhood of a vertex. In both cases the distance of a bond is measured along the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ball {
    /// Vertices within the horizon along the surface.
    #[default]
    Geodesic,
    /// Vertices within the horizon on the straight line. An error is returned if such a ball reaches an
    /// opposite wall of a thin or folded body.
    Euclid,
}

/// Largest ratio of geodesic to straight distance: half a circle over its diameter. Pairs beyond it lie on
/// opposite walls.
const LONGEST: f64 = FRAC_PI_2;

impl Ball {
    /// Returns the pairs of vertices within each other's ball of radius `delta` (m) with their geodesic
    /// distances, using a cache.
    ///
    /// # Errors
    /// As [`geodesic_pairs`](super::geodesic_pairs); a Euclidean ball contains vertices more than π/2 times as
    /// far along the surface.
    pub fn pairs(
        self,
        surface: &Surface,
        delta: f64,
        method: GeodesicMethod,
        cache: &dyn Cache,
    ) -> Result<GeodesicPairs> {
        match self {
            Self::Geodesic => geodesic_pairs_cached(surface, delta, method, cache),
            Self::Euclid => {
                let near = geodesic_pairs_cached(surface, LONGEST * delta, method, cache)?;
                euclidean(surface, delta, &near)
            }
        }
    }
}

/// Selects the pairs with a straight distance below `delta` from the pairs within the longest path.
fn euclidean(surface: &Surface, delta: f64, near: &GeodesicPairs) -> Result<GeodesicPairs> {
    let cloud = surface.points(vec![1.0; surface.len()])?;
    let (start, neighbour) = pairs_where(&cloud, delta, &|_, _, chord| chord < delta);
    let mut distance = Vec::with_capacity(neighbour.len());
    for (a, row) in start.windows(2).enumerate() {
        if row[0] == row[1] {
            return Err(PericlesError::HorizonTooSmall {
                horizon: delta,
                spacing: surface.median_edge(),
            });
        }
        for &b in &neighbour[row[0]..row[1]] {
            let b = b as usize;
            let along = near.between(a, b).ok_or_else(|| SurfaceError::Folded {
                vertices: [a, b].map(|vertex| surface.user_number(vertex)),
                chord: surface.chord(a, b),
                reach: LONGEST * delta,
            })?;
            distance.push(along);
        }
    }
    Ok(GeodesicPairs {
        start,
        neighbour,
        distance,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::cache::NoCache;

    #[test]
    fn euclidean_ball_selects_by_chord_and_stores_geodesic_distance() {
        let sphere = Surface::icosphere(3, 1.0).unwrap();
        let pairs = |ball: Ball, delta| {
            ball.pairs(&sphere, delta, GeodesicMethod::Edge, &NoCache)
                .unwrap()
        };
        let (geodesic, euclid) = (pairs(Ball::Geodesic, 0.5), pairs(Ball::Euclid, 0.5));
        assert_eq!((geodesic.len(), euclid.len()), (22740, 23940));
        let far = pairs(Ball::Geodesic, 0.7);
        for a in 0..sphere.len() {
            let (neighbours, distances) = euclid.row(a);
            for (&b, &distance) in neighbours.iter().zip(distances) {
                assert!(sphere.chord(a, b as usize) < 0.5);
                assert_eq!(far.between(a, b as usize), Some(distance));
            }
        }
    }

    #[test]
    fn euclidean_ball_that_reaches_an_opposite_wall_is_an_error() {
        let flat = Surface::ellipsoid(3, [1.0, 1.0, 0.1]).unwrap();
        let pairs = Ball::Euclid.pairs(&flat, 0.3, GeodesicMethod::Edge, &NoCache);
        let error = pairs.unwrap_err();
        assert!(
            matches!(error.extension(), Some(SurfaceError::Folded { .. })),
            "{error}"
        );
    }
}
