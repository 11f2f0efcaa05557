//! Velocity Verlet.

use super::{Integrator, State};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::parallel::for_each_chunk;
use crate::step_end::{Path, StepEnd};
use crate::step_kind::StepKind;
use crate::system::System;

/// Velocity Verlet: v ← v + dt/2 a, u ← u + dt v, a ← a(u), v ← v + dt/2 a (Swope et al. 1982; the Störmer–Verlet
/// method).
///
/// Second order, symplectic, one force evaluation per step; stable for ω dt ≤ 2. Without breaking it conserves
/// momentum to round-off. For linear forces it conserves the energy with the kinetic part ½ v(t−dt/2)·M v(t+dt/2)
/// exactly.
#[derive(Debug, Clone, Copy, Default)]
pub struct VelocityVerlet;

impl Integrator for VelocityVerlet {
    fn name(&self) -> &'static str {
        "velocity-verlet"
    }

    fn step_kind(&self) -> StepKind {
        StepKind::EndOfStep
    }

    fn order(&self) -> u32 {
        2
    }

    fn stability_limit(&self) -> Option<f64> {
        Some(2.0)
    }

    /// Over a step the kinetic energy ½ v·Mv − dt²/8 a·Ma = ½ v(t−dt/2)·M v(t+dt/2) grows by exactly the
    /// trapezoidal work ½ (F + F′)·Δu, which is the loss of elastic energy for linear forces and the work of loads
    /// in the energy balance.
    fn energy_correction(&self, system: &System, state: &State, dt: f64) -> f64 {
        system.interaction_correction(dt) - 0.25 * dt * dt * system.kinetic_energy(&state.a)
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        _interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let State { t, u, v, a, .. } = state;
        let dt = t_next - *t;
        add_scaled(v, 0.5 * dt, a);
        system.constrain_mean_velocity(*t, dt, v);
        add_scaled(u, dt, v);
        system.constrain(t_next, u, v);
        let end = StepEnd {
            t: t_next,
            dt,
            u,
            path: Path::MeanVelocity(v),
        };
        system.end_step(&end, v, a);
        add_scaled(v, 0.5 * dt, a);
        system.constrain_velocity(t_next, v);
        state.close(system, t_next);
        state.step += 1;
        Ok(())
    }
}

/// y += factor x
fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    for_each_chunk(y, &|first, y| {
        for (y, x) in y.iter_mut().zip(&x[first..]) {
            *y += factor * x;
        }
    });
}

crate::saved! {
    impl Checkpointed for VelocityVerlet {}
}
