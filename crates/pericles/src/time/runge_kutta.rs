//! Runge–Kutta with a single time step.

use super::zone::{Sum, Zone};
use super::{Integrator, State, Tableau};
use crate::compatibility::Requirement;
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::operator::PointSubset;
use crate::system::System;

/// Coefficients of a step in displacement form.
#[derive(Debug, Clone)]
pub(super) struct StepForm {
    pub(super) nodes: Vec<f64>,
    /// A, for stage velocities.
    stages: Vec<Vec<f64>>,
    /// Ā.
    displacement_stages: Vec<Vec<f64>>,
    /// b.
    velocity: Vec<f64>,
    /// b̄.
    displacement: Vec<f64>,
}

impl StepForm {
    pub(super) fn new(tableau: &Tableau) -> Self {
        Self {
            nodes: tableau.nodes.clone(),
            stages: tableau.stages.clone(),
            displacement_stages: tableau.displacement_stages(),
            velocity: tableau.weights.clone(),
            displacement: tableau.times_stages(&tableau.weights),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Returns U_i − u for a step h from (u, v), from the accelerations of the previous stages.
    pub(super) fn stage<'a>(&self, i: usize, h: f64, v: &'a [f64], a: Stages<'a>) -> Sum<'a> {
        Sum::new()
            .plus(self.nodes[i] * h, v)
            .plus_all(h * h, &self.displacement_stages[i], |j| a.at(j))
    }

    /// Returns V_i − v.
    pub(super) fn stage_velocity<'a>(&self, i: usize, h: f64, a: Stages<'a>) -> Sum<'a> {
        Sum::new().plus_all(h, &self.stages[i], |j| a.at(j))
    }

    /// Returns u₁ − u.
    pub(super) fn displacement<'a>(&self, h: f64, v: &'a [f64], a: Stages<'a>) -> Sum<'a> {
        Sum::new()
            .plus(h, v)
            .plus_all(h * h, &self.displacement, |j| a.at(j))
    }

    /// Returns v₁ − v.
    pub(super) fn velocity<'a>(&self, h: f64, a: Stages<'a>) -> Sum<'a> {
        Sum::new().plus_all(h, &self.velocity, |j| a.at(j))
    }
}

/// Accelerations of the stages; the first one belongs to the state.
#[derive(Clone, Copy)]
pub(super) struct Stages<'a> {
    pub(super) first: &'a [f64],
    pub(super) later: &'a [Vec<f64>],
}

impl<'a> Stages<'a> {
    pub(super) fn at(&self, j: usize) -> &'a [f64] {
        if j == 0 {
            self.first
        } else {
            &self.later[j - 1]
        }
    }
}

/// An explicit Runge–Kutta method for (u, v) with the same step for all points.
///
/// The acceleration of the state is the first stage of the next step, so that a step of s stages takes s force
/// evaluations. Bonds break at the end of steps only, because stage values have low order. Prescribed displacements
/// and velocities are exact at the end of steps; stages use prescribed accelerations. Momentum is conserved to
/// round-off; the energy of an oscillation ω decays by (ω dt)⁴/12 (order 3) or (ω dt)⁶/72 (order 4) per step, so
/// that short waves are damped out.
pub struct RungeKutta {
    name: &'static str,
    order: u32,
    limit: f64,
    form: StepForm,
    zone: Zone,
    stage: [Vec<f64>; 2],
    a: Vec<Vec<f64>>,
    next: [Vec<f64>; 2],
}

impl RungeKutta {
    /// Requirements on the system.
    pub const REQUIREMENTS: &'static [Requirement] = &[
        Requirement::CONSERVATIVE_CONTACT,
        Requirement::NO_FREE_BODIES,
    ];

    /// Makes the method of a tableau for a body; embedded weights are ignored.
    pub fn new(tableau: &Tableau, system: &System) -> Self {
        let entries = system.dimension() * system.points();
        let array = || vec![0.0; entries];
        Self {
            name: tableau.name,
            order: tableau.order,
            limit: tableau.stability_limit(),
            form: StepForm::new(tableau),
            zone: Zone::all(system.points()),
            stage: [array(), Vec::new()],
            a: (1..tableau.len()).map(|_| array()).collect(),
            next: [array(), array()],
        }
    }
}

impl Integrator for RungeKutta {
    fn name(&self) -> &'static str {
        self.name
    }

    fn requirements(&self) -> &'static [Requirement] {
        Self::REQUIREMENTS
    }

    fn vector_length(&self) -> Option<usize> {
        Some(self.next[0].len())
    }

    fn order(&self) -> u32 {
        self.order
    }

    fn stability_limit(&self) -> Option<f64> {
        Some(self.limit)
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        _interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let State { t, u, v, a, .. } = state;
        let (dt, n) = (t_next - *t, system.points());
        // Only boundaries use the stage velocity; they may be added after the scheme was made.
        if system.has_boundaries() {
            self.stage[1].resize(u.len(), 0.0);
        }
        for i in 1..self.form.len() {
            let (before, later) = self.a.split_at_mut(i - 1);
            let known = Stages {
                first: a,
                later: before,
            };
            let [stage, velocity] = &mut self.stage;
            self.form
                .stage(i, dt, v, known)
                .onto(u, &self.zone, n, stage);
            if system.has_boundaries() {
                velocity.resize(v.len(), 0.0);
                self.form
                    .stage_velocity(i, dt, known)
                    .onto(v, &self.zone, n, velocity);
            }
            let t_stage = *t + self.form.nodes[i] * dt;
            system.acceleration(t_stage, stage, velocity, PointSubset::All, &mut later[0]);
        }
        let known = Stages {
            first: a,
            later: &self.a,
        };
        let [u_next, v_next] = &mut self.next;
        self.form
            .displacement(dt, v, known)
            .onto(u, &self.zone, n, u_next);
        self.form.velocity(dt, known).onto(v, &self.zone, n, v_next);
        system.constrain(t_next, u_next, v_next);
        system.constrain_velocity(t_next, v_next);
        state.complete(system, &mut self.next, t_next, dt);
        state.step += 1;
        Ok(())
    }
}

// The method has no state from step to step.
crate::saved! {
    impl Checkpointed for RungeKutta {
        name, order, limit, form, zone: fixed,
        stage, a, next: scratch,
    }
}
