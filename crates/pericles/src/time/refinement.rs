//! Which points take the fine step.

use super::State;
use super::frequency::{HighestFrequency, highest_frequency, highest_frequency_on};
use super::zones::{Zones, grow};
use crate::archive::{Archive, Values};
use crate::error::{PericlesError, Result};
use crate::operator::ZonedForce;
use crate::space::{PointCloud, PointSet};
use crate::system::System;

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

/// What a scheme with two time steps did so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RefinementReport {
    /// Fine steps in a coarse one, M.
    pub ratio: u32,
    /// Points of the body.
    pub points: u64,
    /// Fine points now.
    pub fine_points: u64,
    /// Coarse points next to them now: r-RESPA evaluates these in every fine step, too.
    pub border_points: u64,
    /// Coarse steps taken, without those at the start that are fine everywhere.
    pub steps: u64,
    /// Steps at the start that were fine everywhere, because the predictor needs earlier levels.
    pub starting_steps: u64,
    /// Mean over the steps of the fraction of fine points; the present fraction before the first step.
    pub mean_fraction: f64,
    /// The largest fraction of a step.
    pub largest_fraction: f64,
}

impl RefinementReport {
    /// S = M/(1 + (M − 1) φ): evaluations of the same scheme with the fine step everywhere over those of this one.
    pub fn speed_up(&self) -> f64 {
        let m = f64::from(self.ratio);
        m / (1.0 + (m - 1.0) * self.mean_fraction)
    }
}

/// The fine points of a run, with their zones.
pub(super) struct Refinement {
    pub(super) ratio: u32,
    pub(super) zones: Zones,
    follow: Option<Looking>,
    /// Zones belong to other marks than the present ones, which come from a checkpoint.
    stale: bool,
    steps: u64,
    starting_steps: u64,
    /// Σ fine points over the steps.
    fine_total: u64,
    fine_most: u64,
}

/// The state of following.
struct Looking {
    follow: Follow,
    /// Looks for which a point is still a start point.
    left: Vec<u8>,
    damage: Vec<f64>,
    /// Work arrays.
    now: Vec<f64>,
    marks: Vec<bool>,
}

/// The force as a sum over bonds, or why the scheme cannot be used.
pub(super) fn zoned<'a>(system: &'a System, scheme: &'static str) -> Result<&'a dyn ZonedForce> {
    if system.has_boundaries() {
        return Err(PericlesError::SchemeNotUsable {
            scheme,
            reason: "a boundary keeps a state of its own, which knows one time step only; use velocity-verlet",
        });
    }
    system
        .operator()
        .as_zoned()
        .ok_or(PericlesError::SchemeNotUsable {
            scheme,
            reason: "its force is one product over the whole body and cannot be evaluated on a part of it; use bonds, or one time step",
        })
}

impl Refinement {
    /// The fine points at the start.
    ///
    /// # Errors
    /// A ratio below one; regions that are empty, overlap or are thinner than a horizon; parameters of following out of range; bodies whose force knows no bonds.
    pub(super) fn new(
        system: &System,
        scheme: &'static str,
        ratio: u32,
        fine: Fine,
    ) -> Result<Self> {
        if ratio < 1 {
            return Err(PericlesError::StepRatio { ratio });
        }
        let force = zoned(system, scheme)?;
        let n = system.points();
        let mut is_fine = vec![false; n];
        let follow = match fine {
            Fine::Fixed(regions) => {
                mark_regions(system.cloud(), force, &regions, &mut is_fine)?;
                None
            }
            Fine::Adaptive(follow) => {
                check(&follow)?;
                Some(Looking {
                    follow,
                    left: vec![0; n],
                    damage: vec![0.0; n],
                    now: vec![0.0; n],
                    marks: vec![false; n],
                })
            }
        };
        Ok(Self {
            ratio,
            zones: Zones::new(force, is_fine),
            follow,
            stale: false,
            steps: 0,
            starting_steps: 0,
            fine_total: 0,
            fine_most: 0,
        })
    }

    /// Notes damage at the start, which is not new.
    pub(super) fn start(&mut self, system: &System) {
        if let Some(looking) = &mut self.follow {
            system.operator().damage_into(&mut looking.damage);
        }
    }

    /// Before a coarse step: looks where the body is about to break, if it is time. Returns whether the zones changed.
    pub(super) fn update(&mut self, system: &System, state: &State) -> bool {
        let Some(force) = system.operator().as_zoned() else {
            return false;
        };
        if std::mem::take(&mut self.stale) {
            let marks = std::mem::take(&mut self.zones.is_fine);
            self.zones = Zones::new(force, marks);
        }
        let Some(looking) = &mut self.follow else {
            return false;
        };
        if !state.step.is_multiple_of(u64::from(looking.follow.every)) {
            return false;
        }
        looking.look(system, force, &state.u);
        let changed = looking.marks != self.zones.is_fine;
        if changed {
            self.zones = Zones::new(force, looking.marks.clone());
        }
        changed
    }

    /// Counts a step.
    pub(super) fn count(&mut self, starting: bool) {
        if starting {
            self.starting_steps += 1;
            return;
        }
        let fine = self.zones.fine.len() as u64;
        self.steps += 1;
        self.fine_total += fine;
        self.fine_most = self.fine_most.max(fine);
    }

    pub(super) fn report(&self) -> RefinementReport {
        let points = self.zones.is_fine.len();
        let fraction = |fine: u64| fine as f64 / points as f64;
        let now = self.zones.fine.len() as u64;
        RefinementReport {
            ratio: self.ratio,
            points: points as u64,
            fine_points: now,
            border_points: self.zones.coarse_border.len() as u64,
            steps: self.steps,
            starting_steps: self.starting_steps,
            mean_fraction: if self.steps == 0 {
                fraction(now)
            } else {
                fraction(self.fine_total) / self.steps as f64
            },
            largest_fraction: fraction(if self.steps == 0 { now } else { self.fine_most }),
        }
    }

    /// The larger of the coarse points' own frequency and the body's over M: what the coarse step must resolve.
    pub(super) fn limiting_frequency(
        &self,
        system: &System,
        u: &[f64],
    ) -> Result<HighestFrequency> {
        let whole = highest_frequency(system, u)?;
        // Adaptive regions come and go.
        if self.follow.is_some() || self.zones.coarse.is_empty() || self.zones.fine.is_empty() {
            let ratio = if self.zones.coarse.is_empty() {
                f64::from(self.ratio)
            } else {
                1.0
            };
            return Ok(whole.over(ratio));
        }
        let fine = whole.over(f64::from(self.ratio));
        match highest_frequency_on(system, u, self.zones.coarse.points()) {
            Ok(coarse) if coarse.estimate > fine.estimate => Ok(coarse),
            // Coarse points without stiffness of their own set no limit.
            Ok(_) | Err(PericlesError::NoStiffness) => Ok(fine),
            Err(error) => Err(error),
        }
    }

    pub(super) fn save(&self, archive: &mut Archive) {
        let counts = [
            self.steps,
            self.starting_steps,
            self.fine_total,
            self.fine_most,
        ];
        archive.put("scheme/refinement", Values::U64(counts.to_vec()));
        if let Some(looking) = &self.follow {
            let marks = self.zones.is_fine.iter().map(|&fine| u8::from(fine));
            archive.put("scheme/fine", Values::U8(marks.collect()));
            archive.put("scheme/hold", Values::U8(looking.left.clone()));
            archive.put("scheme/damage", Values::F64(looking.damage.clone()));
        }
    }

    pub(super) fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut counts = [0; 4];
        archive.u64_into("scheme/refinement", &mut counts)?;
        [
            self.steps,
            self.starting_steps,
            self.fine_total,
            self.fine_most,
        ] = counts;
        if let Some(looking) = &mut self.follow {
            let mut marks = vec![0; self.zones.is_fine.len()];
            archive.u8_into("scheme/fine", &mut marks)?;
            archive.u8_into("scheme/hold", &mut looking.left)?;
            archive.f64_into("scheme/damage", &mut looking.damage)?;
            for (fine, mark) in self.zones.is_fine.iter_mut().zip(marks) {
                *fine = mark != 0;
            }
            self.stale = true;
        }
        Ok(())
    }
}

impl Looking {
    /// Leaves in `marks` the points that shall be fine.
    fn look(&mut self, system: &System, force: &dyn ZonedForce, u: &[f64]) {
        self.marks.fill(false);
        force.mark_endangered(u, self.follow.threshold, &mut self.marks);
        system.operator().damage_into(&mut self.now);
        for i in 0..self.marks.len() {
            if self.marks[i] || self.now[i] > self.damage[i] {
                self.left[i] = self.follow.hold as u8 + 1;
            }
            self.marks[i] = self.left[i] > 0;
            self.left[i] = self.left[i].saturating_sub(1);
        }
        std::mem::swap(&mut self.damage, &mut self.now);
        grow(force, &mut self.marks, self.follow.layers);
    }
}

fn check(follow: &Follow) -> Result<()> {
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

fn mark_regions(
    cloud: &PointCloud,
    force: &dyn ZonedForce,
    regions: &[PointSet],
    is_fine: &mut [bool],
) -> Result<()> {
    for (region, points) in regions.iter().enumerate() {
        if points.is_empty() {
            return Err(PericlesError::FineRegionEmpty { region });
        }
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
    force: &dyn ZonedForce,
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
    let half = 0.5 * cloud.spacing();
    for c in 0..cloud.dimension() {
        let axis = cloud.axis(c);
        let own = span(axis, &mut points.iter().map(|&i| i as usize));
        let body = span(axis, &mut (0..n));
        let ends = own[0] - body[0] < half || body[1] - own[1] < half;
        let extent = own[1] - own[0] + cloud.spacing();
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
