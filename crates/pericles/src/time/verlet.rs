//! Velocity Verlet.

use rayon::prelude::*;

use super::{Integrator, State};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::operator::Accepted;
use crate::parallel::BLOCK;
use crate::step_kind::StepKind;
use crate::system::System;

/// v ← v + dt/2 a, u ← u + dt v, a ← a(u), v ← v + dt/2 a (Swope et al. 1982; the Störmer–Verlet method).
///
/// Second order, symplectic, one force evaluation a step; stable for ω dt ≤ 2. Without breaking it conserves momentum to round-off and the energy
/// with the kinetic part ½ v(t−dt/2)·M v(t+dt/2) exactly for linear forces.
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

    /// Over a step the kinetic energy ½ v·Mv − dt²/8 a·Ma = ½ v(t−dt/2)·M v(t+dt/2) grows by exactly the trapezoidal work ½ (F + F′)·Δu, which is
    /// the loss of elastic energy for linear forces and what the ledger books for loads.
    fn energy_correction(&self, system: &System, state: &State, dt: f64) -> f64 {
        -0.25 * dt * dt * system.kinetic_energy(&state.a)
    }

    fn start(&mut self, system: &mut System, state: &mut State) {
        system.constrain(state.t, &mut state.u, &mut state.v);
        system.constrain_velocity(state.t, &mut state.v);
        system.start(state.t, &state.u, &state.v, &mut state.a);
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        _interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let State { t, step, u, v, a } = state;
        let dt = t_next - *t;
        kick(v, a, 0.5 * dt);
        system.constrain_mean_velocity(*t, dt, v);
        u.par_chunks_mut(BLOCK)
            .zip(v.par_chunks(BLOCK))
            .for_each(|(u, v)| {
                for (u, v) in u.iter_mut().zip(v) {
                    *u += dt * v;
                }
            });
        system.constrain(t_next, u, v);
        let accepted = Accepted {
            t: t_next,
            u,
            mean_velocity: v,
            dt,
        };
        system.accept_and_accelerate(accepted, v, a);
        kick(v, a, 0.5 * dt);
        system.constrain_velocity(t_next, v);
        system.settle_breaking(t_next, v);
        *t = t_next;
        *step += 1;
        Ok(())
    }
}

fn kick(v: &mut [f64], a: &[f64], dt: f64) {
    v.par_chunks_mut(BLOCK)
        .zip(a.par_chunks(BLOCK))
        .for_each(|(v, a)| {
            for (v, a) in v.iter_mut().zip(a) {
                *v += dt * a;
            }
        });
}

crate::saved! {
    impl Saved for VelocityVerlet {}
}
