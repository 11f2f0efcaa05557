//! Conditions that end a run before its last step.

use std::fmt;

use crate::archive::{Archive, Saved, Values};
use crate::error::{PericlesError, Result};
use crate::space::{PointSet, check_points};
use crate::system::System;

/// What a set of points must have come to.
#[derive(Debug, Clone, PartialEq)]
pub enum StopCondition {
    /// The resultant of the supports of the set, |Σ R| over all its prescribed motions, is below this share of its largest value so far.
    ReactionBelow {
        /// Above 0 and below 1.
        share: f64,
        /// Places of the motions in [`System::motions`].
        motions: Vec<usize>,
    },
    /// The damage of a point of the set is above this value.
    DamageAbove {
        /// From 0 on, below 1.
        damage: f64,
        /// The points.
        points: PointSet,
    },
}

/// A condition that ends a run as if it had reached its last step; evaluated after every step.
#[derive(Debug, Clone, PartialEq)]
pub struct StopWhen {
    /// The name of the set, for reports.
    pub set: String,
    /// The condition.
    pub condition: StopCondition,
    /// The largest reaction so far, N.
    peak: f64,
    /// Bonds that had broken when damage was last looked at: it only grows with their number.
    broken: u64,
}

/// Why a run ended before its last step.
#[derive(Debug, Clone, PartialEq)]
pub struct StopReason {
    /// The name of the set.
    pub set: String,
    /// The step after which it was found.
    pub step: u64,
    /// Its time, s.
    pub t: f64,
    /// What was found.
    pub found: Found,
}

/// The numbers that met a condition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Found {
    /// The reaction of the set, N, and its largest value in the run, N.
    Reaction {
        /// Now.
        now: f64,
        /// The largest.
        peak: f64,
    },
    /// The damage of a point of the set.
    Damage {
        /// The largest damage of the set.
        damage: f64,
        /// That point, in the user's numbering.
        point: usize,
    },
}

impl fmt::Display for StopReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.found {
            Found::Reaction { now, peak } => write!(
                f,
                "the reaction of `{}` has fallen to {:.2} % of its peak, from {peak:.4e} N to {now:.4e} N",
                self.set,
                100.0 * now / peak
            ),
            Found::Damage { damage, point } => write!(
                f,
                "the damage of point {point} of `{}` has reached {damage:.3}",
                self.set
            ),
        }
    }
}

impl StopWhen {
    /// A condition on a set of this name.
    pub fn new(set: String, condition: StopCondition) -> Self {
        Self {
            set,
            condition,
            peak: 0.0,
            broken: 0,
        }
    }

    /// Refuses a condition on motions or points that a system does not have.
    pub(crate) fn check(&self, system: &System) -> Result<()> {
        match &self.condition {
            StopCondition::ReactionBelow { motions, .. } => {
                let count = system.motions().len();
                match motions.iter().find(|&&motion| motion >= count) {
                    Some(&motion) => Err(PericlesError::OutOfRange {
                        quantity: "the number of a motion in a stop condition",
                        value: motion as f64,
                        allowed: "places of motions in the list of the system, from 0",
                    }),
                    None => Ok(()),
                }
            }
            StopCondition::DamageAbove { points, .. } => {
                check_points("the points of a stop condition", points, system.points())
            }
        }
    }

    /// Looks at an accepted state; what it found if the condition is met.
    pub(crate) fn look(&mut self, system: &System) -> Option<Found> {
        match &self.condition {
            StopCondition::ReactionBelow { share, motions } => {
                let mut sum = [0.0; 3];
                for &motion in motions {
                    let reaction = system.motions()[motion].reaction(system.cloud());
                    (0..3).for_each(|c| sum[c] += reaction[c]);
                }
                let now = sum.iter().map(|r| r * r).sum::<f64>().sqrt();
                self.peak = self.peak.max(now);
                let peak = self.peak;
                (now < share * peak).then_some(Found::Reaction { now, peak })
            }
            StopCondition::DamageAbove { damage, points } => {
                let operator = system.operator();
                let broken = operator.broken_bonds();
                if broken == self.broken {
                    return None;
                }
                self.broken = broken;
                let mut all = vec![0.0; system.points()];
                operator.damage_into(&mut all);
                let worst = points
                    .iter()
                    .map(|&i| i as usize)
                    .reduce(|best, i| if all[i] > all[best] { i } else { best })?;
                (all[worst] > *damage).then(|| Found::Damage {
                    damage: all[worst],
                    point: system.cloud().user_number(worst),
                })
            }
        }
    }
}

/// All conditions of a run: the peaks are part of its state.
impl Saved for Vec<StopWhen> {
    fn save(&self, archive: &mut Archive) {
        let peak = |stop: &StopWhen| {
            let StopWhen {
                peak,
                broken: _,
                set: _,
                condition: _,
            } = stop;
            *peak
        };
        if !self.is_empty() {
            archive.put("stop/peaks", Values::F64(self.iter().map(peak).collect()));
        }
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        if self.is_empty() {
            return Ok(());
        }
        let mut peaks = vec![0.0; self.len()];
        archive.f64_into("stop/peaks", &mut peaks)?;
        for (stop, peak) in self.iter_mut().zip(peaks) {
            stop.peak = peak;
            // Damage is looked at anew.
            stop.broken = 0;
        }
        Ok(())
    }
}
