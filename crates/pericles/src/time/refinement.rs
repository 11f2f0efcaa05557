//! The fine region of multirate schemes and its evolution.

use super::State;
use super::fine_region::{Fine, Follow, check, mark_regions};
use super::frequency::{HighestFrequency, highest_frequency_on};
use super::refinement_report::RefinementReport;
use super::zones::{Count, Zones, grow};
use crate::archive::{Archive, Checkpointed, Counter, Layout, Values};
use crate::compatibility::{Need, Requirement, require};
use crate::error::{PericlesError, Result};
use crate::operator::LocalForce;
use crate::system::System;

/// Name of a scheme and its evaluations.
#[derive(Debug, Clone, Copy)]
pub(super) struct SchemeCost {
    pub(super) requirements: &'static [Requirement],
    pub(super) name: &'static str,
    /// Evaluations per point and step.
    pub(super) stages: u32,
    /// Whether coarse points next to fine ones are also evaluated in fine steps.
    pub(super) shares_border: bool,
}

/// The fine points of a run and the resulting zones.
pub(super) struct Refinement {
    pub(super) ratio: u32,
    cost: SchemeCost,
    pub(super) zones: Zones,
    follow: Option<Looking>,
    /// Whether the zones are outdated, because the marks come from a checkpoint.
    stale: bool,
    steps: Counter,
    starting_steps: Counter,
    /// Sum of the number of fine points over the steps. Like all counts it refers to the whole body, not to the points
    /// of a process.
    fine_total: Counter,
    fine_most: u64,
    /// Sum of the number of coarse points next to fine ones over the steps.
    border_total: Counter,
}

/// State of an adaptive fine region.
struct Looking {
    follow: Follow,
    /// Number of further checks for which each point remains a seed.
    left: Vec<u8>,
    damage: Vec<f64>,
    /// Work arrays.
    now: Vec<f64>,
    marks: Vec<bool>,
}

/// The requirement of all multirate schemes.
pub(super) const PARTS_OF_THE_BODY: Requirement = Requirement {
    need: Need::FiniteReach,
    reason: "it evaluates the force on parts of the body, which transforms and forces in single precision (rounded relative to one point of the whole body) do not support; use bonds in double precision, or a scheme with a single time step",
};

/// Returns the force as one that can be evaluated on a subset of the points, if the system meets the requirement of
/// the scheme.
fn local<'a>(system: &'a System, scheme: &SchemeCost) -> Result<&'a dyn LocalForce> {
    require(scheme.name, scheme.requirements, system)?;
    let force = system.operator().as_local();
    force.ok_or(PericlesError::SchemeNotUsable {
        scheme: scheme.name,
        reason: PARTS_OF_THE_BODY.reason,
    })
}

impl Refinement {
    /// Determines the initial fine points.
    ///
    /// # Errors
    /// A ratio below one; regions that are empty, overlap or are thinner than a horizon; parameters of an adaptive
    /// region out of range; forces without bonds.
    pub(super) fn new(system: &System, cost: SchemeCost, ratio: u32, fine: Fine) -> Result<Self> {
        if ratio < 1 {
            return Err(PericlesError::StepRatio { ratio });
        }
        let force = local(system, &cost)?;
        let (n, domain) = (system.points(), system.domain());
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
            cost,
            zones: Zones::new(force, domain, is_fine),
            follow,
            stale: false,
            steps: Counter::default(),
            starting_steps: Counter::default(),
            fine_total: Counter::default(),
            fine_most: 0,
            border_total: Counter::default(),
        })
    }

    /// Stores the initial damage, which does not count as new.
    pub(super) fn start(&mut self, system: &System) {
        if let Some(looking) = &mut self.follow {
            system.operator().damage_into(&mut looking.damage);
        }
    }

    /// Checks before a coarse step, when due, where bonds are about to break. Returns whether the zones changed in any
    /// process.
    pub(super) fn update(&mut self, system: &System, state: &State) -> bool {
        let Some(force) = system.operator().as_local() else {
            return false;
        };
        let domain = system.domain();
        if std::mem::take(&mut self.stale) {
            let marks = std::mem::take(&mut self.zones.is_fine);
            self.zones = Zones::new(force, domain, marks);
        }
        let Some(looking) = &mut self.follow else {
            return false;
        };
        if !state.step.is_multiple_of(u64::from(looking.follow.every)) {
            return false;
        }
        looking.look(system, force, &state.u);
        let changed = !domain.all(looking.marks == self.zones.is_fine);
        if changed {
            self.zones = Zones::new(force, domain, looking.marks.clone());
        }
        changed
    }

    /// Counts a step.
    pub(super) fn count(&mut self, starting: bool) {
        if starting {
            self.starting_steps.add(1);
            return;
        }
        let Count { fine, border, .. } = self.zones.count;
        self.steps.add(1);
        self.fine_total.add(fine);
        self.fine_most = self.fine_most.max(fine);
        self.border_total.add(border);
    }

    pub(super) fn report(&self) -> RefinementReport {
        let points = self.zones.count.points();
        let fraction = |fine: u64| fine as f64 / points as f64;
        let Count {
            fine: now, border, ..
        } = self.zones.count;
        let steps = self.steps.get();
        let mean = |total: Counter, now: u64| match steps {
            0 => fraction(now),
            steps => fraction(total.get()) / steps as f64,
        };
        RefinementReport {
            ratio: self.ratio,
            stages: self.cost.stages,
            points,
            fine_points: now,
            border_points: border,
            steps,
            starting_steps: self.starting_steps.get(),
            mean_fraction: mean(self.fine_total, now),
            largest_fraction: fraction(if steps == 0 { now } else { self.fine_most }),
            mean_shared: if self.cost.shares_border {
                mean(self.border_total, border)
            } else {
                0.0
            },
        }
    }

    /// Returns the frequency that the coarse step must resolve: the larger of the frequency of the coarse points alone and
    /// the frequency of the body over M.
    pub(super) fn limiting_frequency(
        &self,
        system: &System,
        u: &[f64],
        body: HighestFrequency,
    ) -> Result<HighestFrequency> {
        let count = self.zones.count;
        // Adaptive regions change during the run.
        if self.follow.is_some() || count.coarse == 0 || count.fine == 0 {
            let ratio = if count.coarse == 0 {
                f64::from(self.ratio)
            } else {
                1.0
            };
            return Ok(body.over(ratio));
        }
        let fine = body.over(f64::from(self.ratio));
        match highest_frequency_on(system, u, self.zones.coarse.points()) {
            Ok(coarse) => Ok(fine.or_higher(coarse)),
            // Coarse points without stiffness set no limit.
            Err(PericlesError::NoStiffness) => Ok(fine),
            Err(error) => Err(error),
        }
    }
}

impl Checkpointed for Refinement {
    fn save(&self, archive: &mut Archive) {
        let Self {
            zones,
            follow,
            steps,
            starting_steps,
            fine_total,
            fine_most,
            border_total,
            ratio: _,
            cost: _,
            stale: _,
        } = self;
        let counts = [
            steps.get(),
            starting_steps.get(),
            fine_total.get(),
            *fine_most,
            border_total.get(),
        ];
        archive.put("scheme/refinement", Values::U64(counts.to_vec()));
        if let Some(looking) = follow {
            let marks = zones.is_fine.iter().map(|&fine| u8::from(fine));
            archive.put_as("scheme/fine", Values::U8(marks.collect()), Layout::Points);
            looking.save(archive);
        }
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut counts = [0; 5];
        archive.u64_into("scheme/refinement", &mut counts)?;
        let [steps, starting_steps, fine_total, fine_most, border_total] = counts;
        self.steps = steps.into();
        self.starting_steps = starting_steps.into();
        self.fine_total = fine_total.into();
        self.fine_most = fine_most;
        self.border_total = border_total.into();
        if let Some(looking) = &mut self.follow {
            let mut marks = vec![0; self.zones.is_fine.len()];
            archive.u8_into("scheme/fine", &mut marks)?;
            looking.restore(archive)?;
            for (fine, mark) in self.zones.is_fine.iter_mut().zip(marks) {
                *fine = mark != 0;
            }
            self.stale = true;
        }
        Ok(())
    }
}

crate::saved! {
    impl Checkpointed for Looking {
        left: points("scheme/hold"),
        damage: points("scheme/damage"),
        follow: fixed,
        now, marks: scratch,
    }
}

impl Looking {
    /// Updates `marks`, the points that are to be fine.
    fn look(&mut self, system: &System, force: &dyn LocalForce, u: &[f64]) {
        self.marks.fill(false);
        if let Some(breaking) = system.operator().capabilities().breaking {
            breaking.mark_endangered(u, self.follow.threshold, &mut self.marks);
        }
        system.operator().damage_into(&mut self.now);
        for i in 0..self.marks.len() {
            if self.marks[i] || self.now[i] > self.damage[i] {
                self.left[i] = self.follow.keep_checks as u8 + 1;
            }
            self.marks[i] = self.left[i] > 0;
            self.left[i] = self.left[i].saturating_sub(1);
        }
        std::mem::swap(&mut self.damage, &mut self.now);
        grow(force, system.domain(), &mut self.marks, self.follow.layers);
    }
}
