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
    let reject = |parameter, value, allowed| {
        Err(PericlesError::SchemeParameter {
            parameter,
            value,
            allowed,
        })
    };
    if !(follow.threshold > 0.0 && follow.threshold < 1.0) {
        return reject(
            "the stretch threshold of the fine region",
            follow.threshold,
            "a fraction of the critical stretch, above 0 and below 1 (usual: 0.85)",
        );
    }
    if follow.every < 1 {
        return reject(
            "the number of steps between checks of the fine region",
            f64::from(follow.every),
            "at least 1",
        );
    }
    if follow.layers < 1 {
        return reject(
            "the number of families around seed points",
            f64::from(follow.layers),
            "at least 1 (usual: 2)",
        );
    }
    if follow.keep_checks > 200 {
        return reject(
            "the number of further checks for which a point remains a seed",
            f64::from(follow.keep_checks),
            "at most 200",
        );
    }
    Ok(())
}

/// Marks the own points of fixed fine regions. All processes must call it together; they return the same error.
pub(super) fn mark_regions(
    cloud: &PointCloud,
    force: &dyn LocalForce,
    regions: &[PointSet],
    is_fine: &mut [bool],
) -> Result<()> {
    let domain = cloud.domain();
    for (region, points) in regions.iter().enumerate() {
        if domain.count(points.len() as u64) == 0 {
            return Err(PericlesError::FineRegionEmpty { region });
        }
        let checked = check_points("the points of a fine region", points, cloud.len());
        domain.agreed(checked)?;
        let taken = points.iter().find(|&&i| is_fine[i as usize]);
        points.iter().for_each(|&i| is_fine[i as usize] = true);
        if let Some(error) = overlap(cloud, regions, region, taken) {
            return Err(error);
        }
        thick_enough(cloud, force, region, points)?;
    }
    Ok(())
}

/// Returns the error of a region if one of its points belongs to an earlier region, with the first of these points over
/// all processes; `taken` is the first own one.
fn overlap(
    cloud: &PointCloud,
    regions: &[PointSet],
    region: usize,
    taken: Option<&u32>,
) -> Option<PericlesError> {
    let domain = cloud.domain();
    let own = taken.map(|&i| {
        let has_it = |other: &PointSet| other.binary_search(&i).is_ok();
        let first = regions.iter().position(has_it).unwrap_or(region);
        let point = cloud.user_number(i as usize);
        (
            -(domain.number(i as usize) as f64),
            [first as f64, point as f64],
        )
    });
    let (measure, numbers) = own.unwrap_or((f64::NEG_INFINITY, [0.0; 2]));
    if domain.all(own.is_none()) {
        return None;
    }
    let [first, point] = domain.of_largest(measure, numbers).map(|k| k as usize);
    Some(PericlesError::FineRegionsOverlap {
        first,
        second: region,
        point,
    })
}

/// Checks that a region is at least as thick as the force on its points reaches along every axis, unless the body ends
/// there: the largest length of their bonds, twice that if the force depends on the bonds of neighbours.
fn thick_enough(
    cloud: &PointCloud,
    force: &dyn LocalForce,
    region: usize,
    points: &[u32],
) -> Result<()> {
    let (domain, dimension) = (cloud.domain(), cloud.dimension());
    let axes: Vec<_> = (0..dimension)
        .map(|c| domain.with_ghosts(cloud.axis(c)))
        .collect();
    let mut longest: f64 = 0.0;
    for &i in points {
        force.bonded(i as usize, &mut |j| {
            let square: f64 = axes
                .iter()
                .map(|axis| (axis[j] - axis[i as usize]).powi(2))
                .sum();
            longest = longest.max(square);
        });
    }
    let reach = f64::from(force.range_in_bonds()) * domain.max(longest).sqrt();
    for (c, axis) in axes.iter().enumerate() {
        // Largest coordinates along the axis and against it, over all processes.
        let span = |points: &mut dyn Iterator<Item = usize>| {
            let mut ends = [f64::NEG_INFINITY; 2];
            for i in points {
                ends = [ends[0].max(-axis[i]), ends[1].max(axis[i])];
            }
            domain.max_each(&mut ends);
            [-ends[0], ends[1]]
        };
        let half = 0.5 * cloud.cell_side(c);
        let own = span(&mut points.iter().map(|&i| i as usize));
        let body = span(&mut (0..cloud.len()));
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
