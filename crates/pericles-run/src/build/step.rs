//! The time step of a run.

use pericles::PericlesError;
use pericles::System;
use pericles::time::{HighestFrequency, Integrator, State, highest_frequency};
use pericles::units::{precise, quantity, significant};
use pericles_deck::{BuildError, Caution, Fault, Scheme, TimeStep};

use super::assembler::Assembler;
use super::rejection::{at, at_path};

/// Relative tolerance for an integer number of steps.
const WHOLE: f64 = 1e-9;

/// The steps of a run.
pub(super) struct Steps {
    pub(super) dt: f64,
    pub(super) count: u64,
    /// The frequency that limits the step.
    pub(super) frequency: Option<HighestFrequency>,
    /// The highest frequency of the body, for any scheme.
    pub(super) body_frequency: Option<HighestFrequency>,
}

impl Assembler<'_> {
    /// Determines the time step, or checks the given one; `exterior` is the highest frequency of the exterior lattices,
    /// `damped` the largest damping rate of its layers, 1/s.
    pub(super) fn steps(
        &self,
        system: &System,
        state: &State,
        integrator: &dyn Integrator,
        (exterior, damped): (f64, f64),
    ) -> Result<Steps, BuildError> {
        let end = self.model.time.end;
        if let TimeStep::Equal(count) = self.model.time.step {
            return Ok(Steps {
                dt: end / count as f64,
                count,
                frequency: None,
                body_frequency: None,
            });
        }
        let body = highest_frequency(system, &state.u).map(|body| body.at_least(exterior));
        let body_frequency = body.as_ref().ok().copied();
        let frequency = body
            .and_then(|body| integrator.limiting_frequency(system, &state.u, body))
            .map(|frequency| frequency.at_least(exterior));
        let limit = integrator.stability_limit();
        match self.model.time.step {
            TimeStep::Equal(_) | TimeStep::Auto { .. } => {
                let safety = match self.model.time.step {
                    TimeStep::Auto { safety } => safety,
                    _ => 1.0,
                };
                let reject = |error| at("time.dt", error);
                let frequency = frequency.map_err(reject)?;
                // An unconditionally stable scheme has no automatic step: accuracy determines it.
                let limit = limit
                    .ok_or(PericlesError::SchemeNotUsable {
                        scheme: integrator.name(),
                        reason: "it is unconditionally stable and has no automatic step; give dt",
                    })
                    .map_err(reject)?;
                let breaking = system.operator().capabilities().breaking;
                let stiffening = breaking.map_or(1.0, |breaking| breaking.stiffening());
                let stable = frequency.stable_step(limit, 1.0) / stiffening;
                let undamped = system.stable_contact_step(stable, limit);
                let damped = damped + self.rayleigh_rates().at(limit / undamped);
                let stable = safety * damped_step(undamped, damped);
                let stable = stable.min(system.longest_contact_step());
                let count = self.count(end, stable)?;
                Ok(Steps {
                    dt: end / count as f64,
                    count,
                    frequency: Some(frequency),
                    body_frequency,
                })
            }
            TimeStep::Fixed(given) => {
                let count = self.count(end, given)?;
                let dt = self.dividing(given, end, count);
                if let (Some(limit), Ok(frequency)) = (limit, &frequency) {
                    let stable = frequency.stable_step(limit, 1.0);
                    // The error refers to the value in the deck.
                    let checked = if dt <= stable { dt } else { given };
                    self.check(checked, limit, frequency, integrator.name())?;
                    let damped = damped + self.rayleigh_rates().at(limit / stable);
                    self.check_damped(dt, stable, damped)?;
                }
                if let (Scheme::Trigonometric(options), Ok(frequency)) =
                    (&self.model.time.scheme, &frequency)
                {
                    self.check_angle(dt, frequency.bound.hypot(options.regularisation.sqrt()))?;
                }
                Ok(Steps {
                    dt,
                    count,
                    frequency: frequency.ok(),
                    body_frequency,
                })
            }
        }
    }

    /// Returns the given step if it divides `end`, otherwise the next smaller one that does.
    fn dividing(&self, given: f64, end: f64, count: u64) -> f64 {
        let ratio = end / given;
        if (ratio - count as f64).abs() <= WHOLE * ratio {
            return given;
        }
        let used = end / count as f64;
        let caution = Caution::ShortenedStep { given, used, count };
        self.warn("time.dt", caution);
        used
    }

    /// Rejects a step in which the phase of the fastest wave is so large that it loses accuracy; a series would have
    /// as many terms.
    fn check_angle(&self, dt: f64, fastest: f64) -> Result<(), BuildError> {
        const MOST: f64 = 1e6;
        let longest = MOST / fastest;
        if dt <= longest {
            return Ok(());
        }
        let fault = Fault::OutOfRange {
            value: quantity(dt, "s"),
            allowed: format!(
                "allowed: at most {}, in which the phase of the fastest wave advances by a million radians",
                quantity(longest, "s")
            ),
        };
        Err(at_path("time.dt", fault))
    }

    /// Rejects a given step that is certainly unstable; warns of one that may be.
    fn check(
        &self,
        dt: f64,
        limit: f64,
        frequency: &HighestFrequency,
        scheme: &'static str,
    ) -> Result<(), BuildError> {
        let stable = frequency.stable_step(limit, 1.0);
        if dt <= stable {
            return Ok(());
        }
        let unstable = dt > frequency.unstable_step(limit);
        if unstable && !self.model.time.allow_unstable {
            let error = PericlesError::UnstableStep {
                dt,
                omega: frequency.estimate,
                limit: stable,
                scheme,
            };
            return Err(at("time.dt", error));
        }
        let caution = if unstable {
            Caution::UnstableStep { dt, limit: stable }
        } else {
            Caution::UncertainStep { dt, limit: stable }
        };
        self.warn("time.dt", caution);
        Ok(())
    }

    /// Rejects a given step that is stable only without damping layers.
    fn check_damped(&self, dt: f64, undamped: f64, damping: f64) -> Result<(), BuildError> {
        let stable = damped_step(undamped, damping);
        if dt <= stable || dt > undamped {
            return Ok(());
        }
        let reason = format!(
            "with a damping rate of up to {} 1/s the step {} is unstable; steps below {} are stable. Use a smaller dt or \"auto\", thicker layers, or a larger reflection \
             coefficient",
            significant(damping, 4),
            precise(dt, "s"),
            precise(stable, "s"),
        );
        Err(at("boundary", PericlesError::BadDampingLayer { reason }))
    }

    /// Returns the number of steps `dt` to `end`.
    fn count(&self, end: f64, dt: f64) -> Result<u64, BuildError> {
        /// Larger numbers of steps are not exact in double precision.
        const MOST: f64 = 9e15;
        let ratio = end / dt;
        if ratio > MOST {
            let fault = Fault::OutOfRange {
                value: precise(dt, "s"),
                allowed: format!(
                    "allowed: at most {MOST:e} steps; this step requires {}",
                    significant(ratio, 3)
                ),
            };
            return Err(at_path("time.dt", fault));
        }
        Ok(whole_steps(ratio) as u64)
    }
}

/// Returns the number of steps in a time of `ratio` steps: rounded up, except for an integer up to rounding, and at least one.
pub(crate) fn whole_steps(ratio: f64) -> f64 {
    (ratio * (1.0 - WHOLE)).ceil().max(1.0)
}

/// Returns the largest stable step of velocity Verlet with a damping rate σ (1/s) applied to the velocity of the
/// previous step, from the undamped one, 2/ω: (ω dt)² = 4 − 2 σ dt.
pub(super) fn damped_step(undamped: f64, damping: f64) -> f64 {
    let damped = 0.25 * damping * undamped;
    undamped / (damped + damped.hypot(1.0))
}
