//! Selection of the points with the fine step, and its errors.

use crate::error::{PericlesError, Result};
use crate::operator::LocalForce;
use crate::space::{PointCloud, PointSet, check_points};

/// The points with the fine step.
#[derive(Debug, Clone, PartialEq)]
pub enum Fine {
    /// These sets during the whole run; they must not overlap.
    Fixed(Vec<PointSet>),
    /// Points near bonds that break or are about to break.
    Adaptive(Follow),
}

/// Criterion by which the fine region follows damage and stretch.
///
/// At regular checks a point becomes a seed if its damage has grown since the last check, or if one of its bonds is
/// stretched beyond `threshold` times the critical stretch. It remains a seed for `keep_checks` further checks, so
/// that the region does not switch on and off. All points within `layers` families of a seed are fine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Follow {
    /// Number of coarse steps between checks.
    pub every: u32,
    /// Fraction of the critical stretch above which a bond is about to break.
    pub threshold: f64,
    /// Number of families around seeds.
    pub layers: u32,
    /// Number of further checks for which a point remains a seed.
    pub keep_checks: u32,
}

/// Checks every four steps, 0.85 of the critical stretch, two families, one further check.
impl Default for Follow {
    fn default() -> Self {
        Self {
            every: 4,
            threshold: 0.85,
            layers: 2,
            keep_checks: 1,
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
            "a fraction of the critical stretch, above 0 and below 1 (usual: 0.85)",
        );
    }
    if follow.every < 1 {
        return refuse(
            "the number of steps between checks of the fine region",
            f64::from(follow.every),
            "at least 1",
        );
    }
    if follow.layers < 1 {
        return refuse(
            "the number of families around seed points",
            f64::from(follow.layers),
            "at least 1 (usual: 2)",
        );
    }
    if follow.keep_checks > 200 {
        return refuse(
            "the number of further checks for which a point remains a seed",
            f64::from(follow.keep_checks),
            "at most 200",
        );
    }
    Ok(())
}

/// Marks the points of fixed fine regions.
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

/// Checks that a region is at least as thick as its longest bond along every axis, unless the body ends there.
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
