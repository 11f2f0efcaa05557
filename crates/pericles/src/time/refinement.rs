//! Which points take the fine step, from step to step.

use super::State;
use super::fine_region::{Fine, Follow, check, mark_regions};
use super::frequency::{HighestFrequency, highest_frequency_on};
use super::refinement_report::RefinementReport;
use super::zones::{Zones, grow};
use crate::archive::{Archive, Counter, Saved, Values};
use crate::compatibility::{Need, Requirement, require};
use crate::error::{PericlesError, Result};
use crate::operator::LocalForce;
use crate::system::System;

/// What a scheme is called and what it evaluates.
#[derive(Debug, Clone, Copy)]
pub(super) struct SchemeCost {
    pub(super) requirements: &'static [Requirement],
    pub(super) name: &'static str,
    /// Evaluations of a point in each of its steps.
    pub(super) stages: u32,
    /// Whether coarse points next to fine ones are evaluated in fine steps, too.
    pub(super) shares_border: bool,
}

/// The fine points of a run, with their zones.
pub(super) struct Refinement {
    pub(super) ratio: u32,
    cost: SchemeCost,
    pub(super) zones: Zones,
    follow: Option<Looking>,
    /// Zones belong to other marks than the present ones, which come from a checkpoint.
    stale: bool,
    steps: Counter,
    starting_steps: Counter,
    /// Σ fine points over the steps.
    fine_total: Counter,
    fine_most: u64,
    /// Σ coarse points next to fine ones over the steps.
    border_total: Counter,
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

/// What all schemes with two time steps need of a system.
pub(super) const PARTS_OF_THE_BODY: Requirement = Requirement {
    need: Need::FiniteReach,
    reason: "it evaluates the force on parts of the body, which transforms and forces in single precision (rounded relative to one point of the whole body) do not allow; use bonds in double precision, or one time step",
};

/// The force as one that can be evaluated on a part of the body, if the system meets the requirements of a scheme.
fn local<'a>(system: &'a System, scheme: &SchemeCost) -> Result<&'a dyn LocalForce> {
    require(scheme.name, scheme.requirements, system)?;
    let force = system.operator().as_local();
    force.ok_or(PericlesError::SchemeNotUsable {
        scheme: scheme.name,
        reason: PARTS_OF_THE_BODY.reason,
    })
}

impl Refinement {
    /// The fine points at the start.
    ///
    /// # Errors
    /// A ratio below one; regions that are empty, overlap or are thinner than a horizon; parameters of following out of range; bodies whose force knows no bonds.
    pub(super) fn new(system: &System, cost: SchemeCost, ratio: u32, fine: Fine) -> Result<Self> {
        if ratio < 1 {
            return Err(PericlesError::StepRatio { ratio });
        }
        let force = local(system, &cost)?;
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
            cost,
            zones: Zones::new(force, is_fine),
            follow,
            stale: false,
            steps: Counter::default(),
            starting_steps: Counter::default(),
            fine_total: Counter::default(),
            fine_most: 0,
            border_total: Counter::default(),
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
        let Some(force) = system.operator().as_local() else {
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
            self.starting_steps.add(1);
            return;
        }
        let fine = self.zones.fine.len() as u64;
        self.steps.add(1);
        self.fine_total.add(fine);
        self.fine_most = self.fine_most.max(fine);
        self.border_total.add(self.zones.coarse_border.len() as u64);
    }

    pub(super) fn report(&self) -> RefinementReport {
        let points = self.zones.is_fine.len();
        let fraction = |fine: u64| fine as f64 / points as f64;
        let now = self.zones.fine.len() as u64;
        let border = self.zones.coarse_border.len() as u64;
        let steps = self.steps.get();
        let mean = |total: Counter, now: u64| match steps {
            0 => fraction(now),
            steps => fraction(total.get()) / steps as f64,
        };
        RefinementReport {
            ratio: self.ratio,
            stages: self.cost.stages,
            points: points as u64,
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

    /// The larger of the coarse points' own frequency and the body's over M: what the coarse step must resolve.
    pub(super) fn limiting_frequency(
        &self,
        system: &System,
        u: &[f64],
        body: HighestFrequency,
    ) -> Result<HighestFrequency> {
        // Adaptive regions come and go.
        if self.follow.is_some() || self.zones.coarse.is_empty() || self.zones.fine.is_empty() {
            let ratio = if self.zones.coarse.is_empty() {
                f64::from(self.ratio)
            } else {
                1.0
            };
            return Ok(body.over(ratio));
        }
        let fine = body.over(f64::from(self.ratio));
        match highest_frequency_on(system, u, self.zones.coarse.points()) {
            Ok(coarse) => Ok(fine.or_higher(coarse)),
            // Coarse points without stiffness of their own set no limit.
            Err(PericlesError::NoStiffness) => Ok(fine),
            Err(error) => Err(error),
        }
    }
}

impl Saved for Refinement {
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
            archive.put("scheme/fine", Values::U8(marks.collect()));
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
    impl Saved for Looking {
        left: array("scheme/hold"),
        damage: array("scheme/damage"),
        follow: fixed,
        now, marks: scratch,
    }
}

impl Looking {
    /// Leaves in `marks` the points that shall be fine.
    fn look(&mut self, system: &System, force: &dyn LocalForce, u: &[f64]) {
        self.marks.fill(false);
        if let Some(breaking) = system.operator().capabilities().breaking {
            breaking.mark_endangered(u, self.follow.threshold, &mut self.marks);
        }
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
