//! Rayleigh damping, proportional to mass and stiffness.

use super::{Boundary, Exchange, Stage};
use crate::domain::Domain;
use crate::error::{PericlesError, Result};
use crate::parallel::for_each_entry;
use crate::step_end::{Path, StepEnd};
use crate::step_kind::StepKind;

/// Rayleigh damping (Rayleigh 1877): ρ u_tt = f − α ρ u_t − β K u_t with the stiffness K of the forces at the
/// current displacements. A vibration of angular frequency ω has the damping ratio ½ (α/ω + β ω).
///
/// The damped velocity is defined as in [`DampingLayer`](super::DampingLayer): at the middle of the previous step for
/// velocity Verlet, at the stage for schemes with stages. K contains the unbroken bonds only. Prescribed motions
/// are not damped. Stiffness-proportional damping requires velocity Verlet; mass-proportional damping alone also
/// supports schemes with stages.
pub struct RayleighDamping {
    rates: RayleighRates,
    kind: StepKind,
    /// Masses by entry, kg.
    masses: Vec<f64>,
    domain: Domain,
    /// Accelerations due to the damping, and the accelerations of the previous step.
    pull: Vec<f64>,
    pull_before: Vec<f64>,
}

/// Coefficients of Rayleigh damping.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RayleighRates {
    /// α, 1/s.
    pub mass: f64,
    /// β, s.
    pub stiffness: f64,
}

impl RayleighRates {
    /// The kinds of steps that support this damping.
    pub fn step_kinds(&self) -> &'static [StepKind] {
        match self.stiffness > 0.0 {
            true => &[StepKind::EndOfStep],
            false => &[StepKind::EndOfStep, StepKind::Stages],
        }
    }

    /// Rate at which the velocity of a vibration of angular frequency ω is damped, α + β ω², 1/s; the amplitude decays
    /// at half this rate.
    pub fn at(&self, omega: f64) -> f64 {
        self.mass + self.stiffness * omega * omega
    }
}

impl RayleighDamping {
    /// Damping for a scheme with the given steps and a body with the given masses by entry
    /// ([`System::masses`](crate::System::masses)) and points.
    ///
    /// # Errors
    /// Coefficients that are negative or not finite.
    pub fn new(
        rates: RayleighRates,
        kind: StepKind,
        masses: Vec<f64>,
        domain: &Domain,
    ) -> Result<Self> {
        for (quantity, value) in [
            ("the mass-proportional damping", rates.mass),
            ("the stiffness-proportional damping", rates.stiffness),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(PericlesError::OutOfRange {
                    quantity,
                    value,
                    allowed: "a finite number that is not negative",
                });
            }
        }
        Ok(Self {
            rates,
            kind,
            domain: domain.clone(),
            pull: vec![0.0; masses.len()],
            pull_before: vec![0.0; masses.len()],
            masses,
        })
    }

    /// Computes the acceleration due to the damping at a displacement and velocity; `stiffness(u, v, out)` computes
    /// K v/ρ, zero where motion is prescribed.
    fn set_pull(&mut self, u: &[f64], v: &[f64], stiffness: Stiffness<'_>) {
        let RayleighRates { mass, stiffness: b } = self.rates;
        stiffness.free_into(v, &mut self.pull);
        for pull in &mut self.pull {
            *pull *= -mass;
        }
        if b > 0.0 {
            let mut change = vec![0.0; v.len()];
            stiffness.product_into(u, v, &mut change);
            for (pull, change) in self.pull.iter_mut().zip(&change) {
                *pull -= b * change;
            }
        }
    }

    /// Adds impulse and work of the accelerations p over a time dt at velocity v: Σ m p dt and Σ m p·v dt.
    fn exchange(&self, pull: &[f64], v: &[f64], dt: f64, exchange: &mut Exchange) {
        let impulses = self.masses.iter().zip(pull);
        let impulses: Vec<f64> = impulses.map(|(mass, pull)| mass * pull * dt).collect();
        let works: Vec<f64> = impulses.iter().zip(v).map(|(p, v)| p * v).collect();
        let points = self.domain.owned_points();
        exchange.add(Exchange::total(&self.domain, points, &impulses, &works));
    }
}

/// Computes K d/ρ at displacements u; the arguments are u, d and the result.
pub type StiffnessProduct<'a> = dyn Fn(&[f64], &[f64], &mut [f64]) + 'a;

/// Access of a boundary to the stiffness of the body.
#[derive(Clone, Copy)]
pub struct Stiffness<'a> {
    /// Computes K d/ρ (1/s² times the unit of d) at u for a direction d, zero where motion is prescribed.
    pub product: &'a StiffnessProduct<'a>,
    /// Zeros entries whose motion is prescribed.
    pub hold: &'a dyn Fn(&mut [f64]),
}

impl Stiffness<'_> {
    fn product_into(&self, u: &[f64], direction: &[f64], out: &mut [f64]) {
        (self.product)(u, direction, out);
    }

    /// Copies a vector with its prescribed entries set to zero.
    fn free_into(&self, vector: &[f64], out: &mut [f64]) {
        out.copy_from_slice(vector);
        (self.hold)(out);
    }
}

impl Boundary for RayleighDamping {
    /// Not available without the forces of the body; see [`Boundary::accept_with`].
    fn accept(&mut self, _step: &StepEnd<'_>) -> Exchange {
        Exchange::default()
    }

    fn accept_with(&mut self, step: &StepEnd<'_>, stiffness: Stiffness<'_>) -> Exchange {
        let mut exchange = Exchange::default();
        if self.kind == StepKind::EndOfStep {
            let mean = |entry: usize| step.mean_velocity(entry);
            let mean: Vec<f64> = (0..step.u.len()).map(mean).collect();
            std::mem::swap(&mut self.pull, &mut self.pull_before);
            self.set_pull(step.u, &mean, stiffness);
            for pull in [&self.pull, &self.pull_before] {
                self.exchange(pull, &mean, 0.5 * step.dt, &mut exchange);
            }
            return exchange;
        }
        let Path::Cubic {
            u,
            v: [first, last],
        } = step.path
        else {
            return exchange;
        };
        // Simpson's rule with the midpoint velocity of the cubic.
        let middle = |entry: usize| {
            1.5 * (step.u[entry] - u[entry]) / step.dt - 0.25 * (first[entry] + last[entry])
        };
        let middle: Vec<f64> = match step.dt > 0.0 {
            true => (0..u.len()).map(middle).collect(),
            false => return exchange,
        };
        for (v, weight) in [(first, 1.0), (&middle, 4.0), (last, 1.0)] {
            self.set_pull(step.u, v, stiffness);
            self.exchange(&self.pull, v, weight * step.dt / 6.0, &mut exchange);
        }
        exchange
    }

    fn after_stage(&mut self, _stage: &Stage<'_>, _acceleration: &mut [f64]) {}

    fn after_stage_with(
        &mut self,
        stage: &Stage<'_>,
        stiffness: Stiffness<'_>,
        acceleration: &mut [f64],
    ) {
        if self.kind != StepKind::EndOfStep {
            self.set_pull(stage.u, stage.v, stiffness);
        }
        let (n, pull) = (self.domain.owned_points(), &self.pull);
        for (c, acceleration) in acceleration.chunks_mut(n.max(1)).enumerate() {
            let pull = &pull[c * n..(c + 1) * n];
            for_each_entry(&stage.on, n, acceleration, &|i, x| *x += pull[i]);
        }
    }

    fn has_memory(&self) -> bool {
        self.kind == StepKind::EndOfStep
    }

    fn step_kinds(&self) -> &'static [StepKind] {
        match self.kind {
            StepKind::Stages if self.rates.stiffness == 0.0 => &[StepKind::Stages],
            _ => &[StepKind::EndOfStep],
        }
    }
}

crate::saved! {
    impl Checkpointed for RayleighDamping {
        pull: points("rayleigh/pull"),
        rates, kind, masses, domain: fixed,
        pull_before: scratch,
    }
}
