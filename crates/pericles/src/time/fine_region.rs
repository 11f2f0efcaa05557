//! The choice of the points that take the fine step, and what is wrong with a choice.

use crate::error::{PericlesError, Result};
use crate::operator::LocalForce;
use crate::space::{PointCloud, PointSet, check_points};

/// The points that take the fine step.
#[derive(Debug, Clone, PartialEq)]
pub enum Fine {
    /// These sets, from start to end; they may not overlap.
    Fixed(Vec<PointSet>),
    /// Those near to where bonds break or are about to.
    Adaptive(Follow),
}

/// How the fine region follows damage and stretch.
///
/// Every so many coarse steps a point is a start point if its damage grew since the last look, or if one of its bonds is
/// stretched beyond `threshold` of the critical stretch. It stays one for `hold` looks more, so that a region that comes and goes does not switch to and fro. Fine
/// is everything within `layers` families of a start point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Follow {
    /// Coarse steps between two looks.
    pub every: u32,
    /// Part of the critical stretch beyond which a bond is about to break.
    pub threshold: f64,
    /// Families around start points.
    pub layers: u32,
    /// Looks that a start point outlasts its cause.
    pub hold: u32,
}

/// Four steps, 0.85 of the critical stretch, two families; one look of hysteresis.
impl Default for Follow {
    fn default() -> Self {
        Self {
            every: 4,
            threshold: 0.85,
            layers: 2,
            hold: 1,
        }
    }
}

pub(super) fn check(follow: &Follow) -> Result<()> {
    let refuse = |parameter, value, allowed| {
        Err(PericlesError::SchemeParameter {
            parameter,
            value,
            allowed,
        })
    };
    if !(follow.threshold > 0.0 && follow.threshold < 1.0) {
        return refuse(
            "the stretch threshold of the fine region",
            follow.threshold,
            "a part of the critical stretch, above 0 and below 1 (usual: 0.85)",
        );
    }
    if follow.every < 1 {
        return refuse(
            "the number of steps between two looks",
            f64::from(follow.every),
            "at least 1",
        );
    }
    if follow.layers < 1 {
        return refuse(
            "the number of families around start points",
            f64::from(follow.layers),
            "at least 1 (usual: 2)",
        );
    }
    if follow.hold > 200 {
        return refuse(
            "the number of looks a start point outlasts its cause",
            f64::from(follow.hold),
            "at most 200",
        );
    }
    Ok(())
}

/// Marks the points of fixed regions.
pub(super) fn mark_regions(
    cloud: &PointCloud,
    force: &dyn LocalForce,
    regions: &[PointSet],
    is_fine: &mut [bool],
) -> Result<()> {
    for (region, points) in regions.iter().enumerate() {
        if points.is_empty() {
            return Err(PericlesError::FineRegionEmpty { region });
        }
        check_points("the points of a fine region", points, cloud.len())?;
        for &i in points {
            if std::mem::replace(&mut is_fine[i as usize], true) {
                let first = regions
                    .iter()
                    .position(|other| other.binary_search(&i).is_ok())
                    .unwrap_or(region);
                return Err(PericlesError::FineRegionsOverlap {
                    first,
                    second: region,
                    point: cloud.user_number(i as usize),
                });
            }
        }
        thick_enough(cloud, force, region, points)?;
    }
    Ok(())
}

/// Along every axis a region is as long as its longest bond, unless the body ends there.
fn thick_enough(
    cloud: &PointCloud,
    force: &dyn LocalForce,
    region: usize,
    points: &[u32],
) -> Result<()> {
    let n = cloud.len();
    let span = |axis: &[f64], points: &mut dyn Iterator<Item = usize>| {
        points.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], i| {
            [low.min(axis[i]), high.max(axis[i])]
        })
    };
    let mut reach: f64 = 0.0;
    for &i in points {
        let here = cloud.point(i as usize);
        force.neighbours(i as usize, &mut |j| {
            let there = cloud.point(j);
            let square: f64 = (0..3).map(|c| (there[c] - here[c]).powi(2)).sum();
            reach = reach.max(square);
        });
    }
    let reach = reach.sqrt();
    for c in 0..cloud.dimension() {
        let half = 0.5 * cloud.cell_side(c);
        let axis = cloud.axis(c);
        let own = span(axis, &mut points.iter().map(|&i| i as usize));
        let body = span(axis, &mut (0..n));
        let ends = own[0] - body[0] < half || body[1] - own[1] < half;
        let extent = own[1] - own[0] + cloud.cell_side(c);
        if !ends && extent < reach * (1.0 - 1e-9) {
            return Err(PericlesError::FineRegionThin {
                region,
                extent,
                axis: ['x', 'y', 'z'][c],
                reach,
            });
        }
    }
    Ok(())
}
