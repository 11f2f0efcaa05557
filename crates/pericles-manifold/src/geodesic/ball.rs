//! Which pairs of vertices are bonds: those near along the surface, or those near in space.

use std::f64::consts::FRAC_PI_2;

use super::{GeodesicMethod, GeodesicPairs, geodesic_pairs_cached};
use crate::surface::{Surface, SurfaceError};
use pericles::cache::Cache;
use pericles::family::pairs_where;
use pericles::{PericlesError, Result};

/// The neighbourhood of a vertex. Distances of bonds are along the surface for both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ball {
    /// Vertices nearer than the horizon along the surface.
    #[default]
    Geodesic,
    /// Vertices nearer than the horizon on the straight line. On a thin or folded body these are on opposite walls too: then it is refused.
    Euclid,
}

/// A path along the surface may be so many times as long as the straight line, half a circle to its diameter; what is farther lies on another wall.
const LONGEST: f64 = FRAC_PI_2;

impl Ball {
    /// The pairs of vertices in each other's ball of radius `delta` (m), with their distances along the surface, by way of a cache.
    ///
    /// # Errors
    /// As [`geodesic_pairs`](super::geodesic_pairs); a Euclidean ball that holds vertices more than π/2 times as far along the surface.
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

/// The pairs on straight lines shorter than `delta`, with their distances among those within the longest path.
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
    fn the_euclidean_ball_holds_chords_and_measures_paths() {
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
    fn opposite_walls_are_not_joined() {
        let flat = Surface::ellipsoid(3, [1.0, 1.0, 0.1]).unwrap();
        let pairs = Ball::Euclid.pairs(&flat, 0.3, GeodesicMethod::Edge, &NoCache);
        let error = pairs.unwrap_err();
        assert!(
            matches!(error.extension(), Some(SurfaceError::Folded { .. })),
            "{error}"
        );
    }
}
