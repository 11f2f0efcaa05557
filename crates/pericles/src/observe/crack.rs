//! Crack tips.

use crate::error::Result;
use crate::family::{Crack, pairs_within};
use crate::space::{Point, PointCloud, PointSet, check_points};

/// A pre-crack and the points that it took bonds from.
#[derive(Debug, Clone)]
pub struct TrackedCrack {
    /// Surface of the crack.
    pub crack: Crack,
    /// Points that lost bonds to the crack.
    pub points: PointSet,
}

/// The tip of a growing crack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrackTip {
    /// Reference position of the tip, m.
    pub place: Point,
    /// Distance from the pre-crack, m.
    pub advance: f64,
    /// Number of points of the crack: damaged beyond the threshold and connected to the pre-crack.
    pub points: usize,
}

/// Finds the crack that has grown from each pre-crack: the points damaged beyond a threshold and connected to the
/// pre-crack through such points. Neighbours on the grid, diagonals included, are connected.
#[derive(Debug, Clone)]
pub struct CrackTracker {
    cracks: Vec<TrackedCrack>,
    threshold: f64,
    start: Vec<usize>,
    neighbours: Vec<u32>,
}

impl CrackTracker {
    /// Makes a tracker for the pre-cracks of a body.
    ///
    /// # Errors
    /// A pre-crack with points that the body does not have.
    pub fn new(cloud: &PointCloud, cracks: Vec<TrackedCrack>, threshold: f64) -> Result<Self> {
        for crack in &cracks {
            check_points("the points of a pre-crack", &crack.points, cloud.len())?;
        }
        let diagonal = 1.01 * (cloud.dimension() as f64).sqrt() * cloud.spacing();
        let (start, neighbours) = pairs_within(cloud, diagonal);
        Ok(Self {
            cracks,
            threshold,
            start,
            neighbours,
        })
    }

    /// The pre-cracks.
    pub fn cracks(&self) -> &[TrackedCrack] {
        &self.cracks
    }

    /// Returns the points of the crack that has grown from a pre-crack, in ascending order.
    pub fn connected(&self, crack: usize, damage: &[f64]) -> PointSet {
        let mut reached = vec![false; damage.len()];
        let mut open: Vec<u32> = self.cracks[crack].points.clone();
        for &i in &open {
            reached[i as usize] = true;
        }
        while let Some(i) = open.pop() {
            let i = i as usize;
            for &j in &self.neighbours[self.start[i]..self.start[i + 1]] {
                let j = j as usize;
                if !reached[j] && damage[j] > self.threshold {
                    reached[j] = true;
                    open.push(j as u32);
                }
            }
        }
        (0..damage.len())
            .filter(|&i| reached[i] && damage[i] > self.threshold)
            .map(|i| i as u32)
            .collect()
    }

    /// Returns the tip of each crack: its point farthest from the pre-crack; `None` before any growth.
    pub fn tips(&self, cloud: &PointCloud, damage: &[f64]) -> Vec<Option<CrackTip>> {
        (0..self.cracks.len())
            .map(|k| {
                let points = self.connected(k, damage);
                let advance = |i: u32| self.cracks[k].crack.distance(cloud.point(i as usize));
                let tip = points
                    .iter()
                    .copied()
                    .reduce(|best, i| if advance(i) > advance(best) { i } else { best })?;
                Some(CrackTip {
                    place: cloud.point(tip as usize),
                    advance: advance(tip),
                    points: points.len(),
                })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{Grid, Shape};

    #[test]
    fn only_connected_points_belong_to_the_crack() {
        let cloud = Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: vec![10.0, 3.0],
            },
            spacing: 1.0,
            section: 1.0,
            holes: vec![],
        }
        .points()
        .unwrap();
        let crack = Crack::Segment {
            from: [0.0, 1.5],
            to: [2.0, 1.5],
        };
        let points = vec![10, 11];
        let tracker =
            CrackTracker::new(&cloud, vec![TrackedCrack { crack, points }], 0.35).unwrap();
        let mut damage = vec![0.0; 30];
        assert_eq!(tracker.tips(&cloud, &damage), [None]);
        for i in [11, 12, 23, 24, 26, 27] {
            damage[i] = 0.5;
        }
        // 26 and 27 are damaged, but separated from the others by a column.
        assert_eq!(tracker.connected(0, &damage), [11, 12, 23, 24]);
        let tip = tracker.tips(&cloud, &damage)[0].unwrap();
        assert_eq!((tip.place, tip.points), ([4.5, 2.5, 0.0], 4));
        assert!((tip.advance - 2.5f64.hypot(1.0)).abs() < 1e-12);
    }
}
