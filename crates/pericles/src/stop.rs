//! Stop conditions: conditions on the state that end a run early.

use std::fmt;
use std::sync::Arc;

use crate::archive::{Archive, Checkpointed, Values};
use crate::error::{PericlesError, Result};
use crate::observe::{ObserveError, Snapshot};
use crate::space::{PointSet, check_points};
use crate::system::System;
use crate::units::BodyUnits;

/// A condition of a program on an accepted state. It has no state of its own, so that a resumed run stops at the same step.
pub trait StopTest: fmt::Debug + Send + Sync {
    /// Returns the values that meet the condition as a text for the report; `None` if it is not met. All processes call
    /// it together and must return the same.
    ///
    /// # Errors
    /// The condition cannot be evaluated.
    fn test(&self, snapshot: &Snapshot<'_>) -> std::result::Result<Option<String>, ObserveError>;
}

/// A condition on a set of points, or of a program.
#[derive(Debug, Clone)]
pub enum StopCondition {
    /// The reaction force of the set, |Σ R| over its constraints, falls below this fraction of its largest value so
    /// far.
    ReactionBelow {
        /// Fraction, between 0 and 1.
        share: f64,
        /// Indices of the constraints in [`System::motions`].
        motions: Vec<usize>,
    },
    /// The damage of a point of the set exceeds this value.
    DamageAbove {
        /// Damage, at least 0 and below 1.
        damage: f64,
        /// Points of the set.
        points: PointSet,
    },
    /// A condition of a program.
    Test(Arc<dyn StopTest>),
}

/// A stop condition; it is evaluated after every step and ends the run as if its last step were reached.
#[derive(Debug, Clone)]
pub struct StopWhen {
    /// Name in reports: of the set, or the text of the condition of a program.
    pub name: String,
    /// The condition.
    pub condition: StopCondition,
    /// Largest reaction so far, N.
    peak: f64,
    /// Number of broken bonds at the last evaluation of the damage, which changes only with this number.
    broken: u64,
}

/// The reason why a run ended early.
#[derive(Debug, Clone, PartialEq)]
pub struct StopReason {
    /// Name of the condition: of its set, or its text.
    pub name: String,
    /// Step after which the condition was met.
    pub step: u64,
    /// Time of that step, s.
    pub t: f64,
    /// Values that met the condition.
    pub found: Found,
}

/// The values that met a stop condition.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// The reaction force of the set fell.
    Reaction {
        /// Reaction at the end, N.
        now: f64,
        /// Largest reaction of the run, N.
        peak: f64,
        /// Units of the body's forces.
        units: BodyUnits,
    },
    /// The damage of a point of the set exceeded its limit.
    Damage {
        /// Largest damage of the set.
        damage: f64,
        /// Point with this damage, in the user's numbering.
        point: usize,
    },
    /// The condition of a program is met.
    Test {
        /// The values that meet it.
        values: String,
    },
}

impl fmt::Display for StopReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.name;
        match &self.found {
            Found::Reaction { now, peak, units } => write!(
                f,
                "the reaction of `{name}` has fallen to {:.2} % of its peak, from {} to {}",
                100.0 * now / peak,
                units.quantity(*peak, "N"),
                units.quantity(*now, "N")
            ),
            Found::Damage { damage, point } => write!(
                f,
                "the damage of point {point} of `{name}` has reached {damage:.3}"
            ),
            Found::Test { values } => write!(f, "the condition `{name}` holds: {values}"),
        }
    }
}

impl StopWhen {
    /// Makes a condition with its name in reports: the name of its set, or its text.
    pub fn new(name: String, condition: StopCondition) -> Self {
        Self {
            name,
            condition,
            peak: 0.0,
            broken: 0,
        }
    }

    /// Returns whether this is a condition of a program.
    pub(crate) fn is_test(&self) -> bool {
        matches!(self.condition, StopCondition::Test(_))
    }

    /// Checks that the system has the constraints or points of a condition.
    pub(crate) fn check(&self, system: &System) -> Result<()> {
        match &self.condition {
            StopCondition::ReactionBelow { motions, .. } => {
                let count = system.motions().len();
                match motions.iter().find(|&&motion| motion >= count) {
                    Some(&motion) => Err(PericlesError::OutOfRange {
                        quantity: "the index of a constraint in a stop condition",
                        value: motion as f64,
                        allowed: "indices of the constraints of the system, from 0",
                    }),
                    None => Ok(()),
                }
            }
            StopCondition::DamageAbove { points, .. } => {
                check_points("the points of a stop condition", points, system.points())
            }
            StopCondition::Test(_) => Ok(()),
        }
    }

    /// Evaluates the condition on an accepted state; returns the values if it is met.
    /// The snapshot is taken if the condition needs it.
    ///
    /// # Errors
    /// The condition of a program cannot be evaluated.
    pub(crate) fn look<'s>(
        &mut self,
        system: &System,
        snapshot: impl FnOnce() -> &'s Snapshot<'s>,
    ) -> std::result::Result<Option<Found>, ObserveError> {
        Ok(match &self.condition {
            StopCondition::Test(test) => {
                let values = test.test(snapshot())?;
                values.map(|values| Found::Test { values })
            }
            StopCondition::ReactionBelow { share, motions } => {
                let mut sum = [0.0; 3];
                for &motion in motions {
                    let reaction = system.motions()[motion].reaction(system.cloud());
                    (0..3).for_each(|c| sum[c] += reaction[c]);
                }
                let now = sum.iter().map(|r| r * r).sum::<f64>().sqrt();
                self.peak = self.peak.max(now);
                let peak = self.peak;
                (now < share * peak).then(|| Found::Reaction {
                    now,
                    peak,
                    units: system.cloud().body_units(),
                })
            }
            StopCondition::DamageAbove { damage, points } => {
                let operator = system.operator();
                let broken = operator.broken_bonds();
                if broken == self.broken {
                    return Ok(None);
                }
                self.broken = broken;
                let mut all = vec![0.0; system.points()];
                operator.damage_into(&mut all);
                let worst = points
                    .iter()
                    .map(|&i| i as usize)
                    .reduce(|best, i| if all[i] > all[best] { i } else { best });
                // Of several processes some may have no point of the set.
                let most = worst.map_or(f64::NEG_INFINITY, |worst| all[worst]);
                let number = worst.map_or(0, |worst| system.cloud().user_number(worst));
                let [most, number] = system.domain().of_largest(most, [most, number as f64]);
                (most > *damage).then_some(Found::Damage {
                    damage: most,
                    point: number as usize,
                })
            }
        })
    }
}

/// All conditions of a run; their peaks are part of its state.
impl Checkpointed for Vec<StopWhen> {
    fn save(&self, archive: &mut Archive) {
        let peak = |stop: &StopWhen| {
            let StopWhen {
                peak,
                broken: _,
                name: _,
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
            // Forces a new evaluation of the damage.
            stop.broken = 0;
        }
        Ok(())
    }
}
