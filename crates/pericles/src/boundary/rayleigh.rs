//! Damping of motion in proportion to mass and stiffness.

use super::{Boundary, Exchange, Stage};
use crate::error::{PericlesError, Result};
use crate::parallel::for_each_entry;
use crate::step_end::{Path, StepEnd};
use crate::step_kind::StepKind;

/// ρ u_tt = f − α ρ u_t − β K u_t with the stiffness K of the forces at the present displacements (Rayleigh 1877): a vibration of angular frequency ω has the damping ratio ½ (α/ω + β ω).
///
/// Velocities that are damped are those of [`DampingLayer`](super::DampingLayer): under velocity Verlet that of the middle of the step before, under schemes with stages that of the stage. K is that of the bonds that are left.
/// Prescribed motions are not damped. Damping in proportion to the stiffness is made for velocity Verlet, damping in proportion to the mass alone for schemes with stages too.
pub struct RayleighDamping {
    rates: RayleighRates,
    kind: StepKind,
    /// Masses of all entries, kg.
    masses: Vec<f64>,
    points: usize,
    /// Accelerations by the damping, and those of the step before.
    pull: Vec<f64>,
    pull_before: Vec<f64>,
}

/// The factors of Rayleigh damping.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RayleighRates {
    /// α, 1/s.
    pub mass: f64,
    /// β, s.
    pub stiffness: f64,
}

impl RayleighRates {
    /// The kinds of steps that such a damping is made for.
    pub fn step_kinds(&self) -> &'static [StepKind] {
        match self.stiffness > 0.0 {
            true => &[StepKind::EndOfStep],
            false => &[StepKind::EndOfStep, StepKind::Stages],
        }
    }

    /// The rate at which a vibration of angular frequency ω loses velocity, α + β ω², 1/s.
    pub fn at(&self, omega: f64) -> f64 {
        self.mass + self.stiffness * omega * omega
    }
}

impl RayleighDamping {
    /// The damping under a scheme with these steps of a body whose entries have these masses ([`System::masses`](crate::System::masses)), in a number of dimensions.
    ///
    /// # Errors
    /// Factors that are negative or not finite.
    pub fn new(
        rates: RayleighRates,
        kind: StepKind,
        masses: Vec<f64>,
        dimension: usize,
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
            points: masses.len() / dimension,
            pull: vec![0.0; masses.len()],
            pull_before: vec![0.0; masses.len()],
            masses,
        })
    }

    /// Sets the acceleration by the damping at a displacement and velocity; `stiffness(u, v, out)` sets K v/ρ, zero where motion is prescribed.
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

    /// Impulse and work of the pulls over a time with a velocity: Σ m p dt and Σ m p·v dt.
    fn exchange(&self, pull: &[f64], v: &[f64], dt: f64, exchange: &mut Exchange) {
        for (entry, pull) in pull.iter().enumerate() {
            let impulse = self.masses[entry] * pull * dt;
            exchange.impulse[entry / self.points] += impulse;
            exchange.work += impulse * v[entry];
        }
    }
}

/// Sets K d/ρ at displacements u, from u, d and the place of the product.
pub type StiffnessProduct<'a> = dyn Fn(&[f64], &[f64], &mut [f64]) + 'a;

/// What a boundary may ask of the forces of a body.
#[derive(Clone, Copy)]
pub struct Stiffness<'a> {
    /// Sets K d/ρ (1/s² times the unit of d) at u for a direction d, zero where motion is prescribed.
    pub product: &'a StiffnessProduct<'a>,
    /// Zeros entries whose motion is prescribed.
    pub hold: &'a dyn Fn(&mut [f64]),
}

impl Stiffness<'_> {
    fn product_into(&self, u: &[f64], direction: &[f64], out: &mut [f64]) {
        (self.product)(u, direction, out);
    }

    /// The vector without its prescribed entries.
    fn free_into(&self, vector: &[f64], out: &mut [f64]) {
        out.copy_from_slice(vector);
        (self.hold)(out);
    }
}

impl Boundary for RayleighDamping {
    /// Not without the forces of the body: [`Boundary::accept_with`].
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
        // Simpson's rule with the velocity of the cubic in the middle.
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
        let (n, pull) = (self.points, &self.pull);
        for (c, acceleration) in acceleration.chunks_mut(n).enumerate() {
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
    impl Saved for RayleighDamping {
        pull: array("rayleigh/pull"),
        rates, kind, masses, points: fixed,
        pull_before: scratch,
    }
}
