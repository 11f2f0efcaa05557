//! The time step of a run.

use pericles::PericlesError;
use pericles::System;
use pericles::time::{HighestFrequency, Integrator, State};

use super::damping;
use crate::caution::Caution;
use crate::deck::Deck;
use crate::error::DeckError;
use crate::fault::Fault;
use crate::finding::Warning;
use crate::scheme::Scheme;
use crate::time::TimeStep;

/// A number of steps that differs from a whole one by so small a part is that number.
const WHOLE: f64 = 1e-9;

/// The steps of a run.
pub(super) struct Steps {
    pub(super) dt: f64,
    pub(super) count: u64,
    pub(super) frequency: Option<HighestFrequency>,
}

impl Deck {
    /// Finds the step, or judges the one that is given; `exterior` is the highest frequency of what lies beyond the body, `damped` the strongest damping of its layers, 1/s.
    pub(super) fn steps(
        &self,
        system: &System,
        state: &State,
        integrator: &dyn Integrator,
        exterior: f64,
        damped: f64,
        warnings: &mut Vec<Warning>,
    ) -> Result<Steps, DeckError> {
        let end = self.time.end;
        if let TimeStep::Equal(count) = self.time.step {
            return Ok(Steps {
                dt: end / count as f64,
                count,
                frequency: None,
            });
        }
        let frequency = integrator
            .limiting_frequency(system, &state.u)
            .map(|frequency| frequency.at_least(exterior));
        let limit = integrator.stability_limit();
        match self.time.step {
            TimeStep::Equal(_) | TimeStep::Auto { .. } => {
                let safety = match self.time.step {
                    TimeStep::Auto { safety } => safety,
                    _ => 1.0,
                };
                let refuse = |error| self.at("time.dt", error);
                let frequency = frequency.map_err(refuse)?;
                // A scheme without a limit has no step of its own: accuracy alone must set it.
                let limit = limit
                    .ok_or(PericlesError::SchemeNotUsable {
                        scheme: integrator.name(),
                        reason: "it has no stable step of its own; give dt",
                    })
                    .map_err(refuse)?;
                let stable =
                    safety * damping::stable_step(frequency.stable_step(limit, 1.0), damped);
                let count = self.count(end, stable)?;
                Ok(Steps {
                    dt: end / count as f64,
                    count,
                    frequency: Some(frequency),
                })
            }
            TimeStep::Fixed(given) => {
                let count = self.count(end, given)?;
                let dt = self.dividing(given, end, count, warnings);
                if let (Some(limit), Ok(frequency)) = (limit, &frequency) {
                    let stable = frequency.stable_step(limit, 1.0);
                    // What is refused is what the deck says.
                    let judged = if dt <= stable { dt } else { given };
                    self.judge(judged, limit, frequency, integrator.name(), warnings)?;
                    self.check_damped(dt, stable, damped)?;
                }
                if let (Scheme::Trigonometric(_), Ok(frequency)) = (&self.time.scheme, &frequency) {
                    self.check_angle(dt, frequency)?;
                }
                Ok(Steps {
                    dt,
                    count,
                    frequency: frequency.ok(),
                })
            }
        }
    }

    /// The given step if a whole number of them ends at `end`, else the next shorter one of which a whole number does.
    fn dividing(&self, given: f64, end: f64, count: u64, warnings: &mut Vec<Warning>) -> f64 {
        let ratio = end / given;
        if (ratio - count as f64).abs() <= WHOLE * ratio {
            return given;
        }
        let used = end / count as f64;
        let caution = Caution::ShortenedStep { given, used, count };
        warnings.push(self.finding(&"time.dt".into(), caution));
        used
    }

    /// Refuses a step that turns the fastest wave so often that its angle keeps few digits; a series would have as many terms.
    fn check_angle(&self, dt: f64, frequency: &HighestFrequency) -> Result<(), DeckError> {
        const MOST: f64 = 1e6;
        let longest = MOST / frequency.bound;
        if dt <= longest {
            return Ok(());
        }
        let fault = Fault::OutOfRange {
            value: format!("{dt:e} s"),
            allowed: format!(
                "allowed: at most {longest:.4e} s, in which the fastest wave turns by {MOST:e}"
            ),
        };
        Err(self.at_path(&"time.dt".into(), fault))
    }

    /// Refuses a given step that is known to be unstable; one that may be is only warned of.
    fn judge(
        &self,
        dt: f64,
        limit: f64,
        frequency: &HighestFrequency,
        scheme: &'static str,
        warnings: &mut Vec<Warning>,
    ) -> Result<(), DeckError> {
        let stable = frequency.stable_step(limit, 1.0);
        if dt <= stable {
            return Ok(());
        }
        let caution = match (frequency.converged, self.time.allow_unstable) {
            (true, false) => {
                let error = PericlesError::UnstableStep {
                    dt,
                    omega: frequency.estimate,
                    limit: stable,
                    scheme,
                };
                return Err(self.at("time.dt", error));
            }
            (true, true) => Caution::UnstableStep { dt, limit: stable },
            (false, _) => Caution::UncertainStep { dt, limit: stable },
        };
        warnings.push(self.finding(&"time.dt".into(), caution));
        Ok(())
    }

    /// The number of steps of length `dt` to `end`.
    fn count(&self, end: f64, dt: f64) -> Result<u64, DeckError> {
        /// Numbers of steps beyond it are no longer exact in a double.
        const MOST: f64 = 9e15;
        let ratio = end / dt;
        if ratio > MOST {
            let fault = Fault::OutOfRange {
                value: format!("{dt:e} s"),
                allowed: format!("allowed: at most {MOST:e} steps; this step needs {ratio:e}"),
            };
            return Err(self.at_path(&"time.dt".into(), fault));
        }
        // A whole number up to round-off is that number.
        Ok((ratio * (1.0 - WHOLE)).ceil().max(1.0) as u64)
    }
}
