//! Time integrators: u(t) ↦ u(t + dt).

mod device;
mod embedded;
mod ends;
mod fine_region;
mod frequency;
mod implicit;
mod interface;
mod multi_time_step;
mod newmark;
mod refinement;
mod refinement_report;
mod relaxation;
mod respa;
mod runge_kutta;
mod tableau;
mod verlet;
mod zone;
mod zones;

pub use device::{Device, DevicePlan};
pub use embedded::AdaptiveRungeKutta;
pub use fine_region::{Fine, Follow};
pub use frequency::{
    FAILURE, HighestFrequency, SMALL, frequency_from_below, highest_frequency, highest_frequency_on,
};
pub use implicit::{Implicit, ImplicitRule, LinearSolver};
pub use interface::{Interpolant, Predictor};
pub use multi_time_step::{MultiTimeStep, MultiTimeStepOptions};
pub use newmark::{
    DiscreteGradient, InnerIterations, InnerSolver, Newmark, NewmarkOptions, VelocityNorm,
};
pub use refinement_report::RefinementReport;
pub use relaxation::{Damping, Relaxation, RelaxationOptions};
pub use respa::Respa;
pub use runge_kutta::RungeKutta;
pub use tableau::Tableau;
pub use verlet::VelocityVerlet;

use crate::archive::Checkpointed;
use crate::compatibility::Requirement;
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::step_end::{Path, StepEnd};
use crate::step_kind::StepKind;
use crate::system::System;

/// The state of a body; vectors are component-major.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Time, s.
    pub t: f64,
    /// Number of steps.
    pub step: u64,
    /// Displacement, m.
    pub u: Vec<f64>,
    /// Velocity, m/s.
    pub v: Vec<f64>,
    /// Acceleration at (t, u), m/s².
    pub a: Vec<f64>,
}

impl State {
    /// The undeformed body of a system at rest at t = 0.
    pub fn of(system: &System) -> Self {
        Self::at_rest(system.dimension() * system.points())
    }

    /// The undeformed body at rest, for vectors with `entries` = dimension times points entries.
    pub fn at_rest(entries: usize) -> Self {
        Self {
            t: 0.0,
            step: 0,
            u: vec![0.0; entries],
            v: vec![0.0; entries],
            a: vec![0.0; entries],
        }
    }
}

impl State {
    /// Starts a run: applies prescribed values and computes the initial acceleration.
    pub fn start(&mut self, system: &mut System) {
        system.constrain(self.t, &mut self.u, &mut self.v);
        system.constrain_velocity(self.t, &mut self.v);
        system.start(self.t, &self.u, &self.v, &mut self.a);
    }

    /// Ends a step of length dt at time t with the displacement and velocity in `next`, which contain the previous
    /// ones afterwards: breaks bonds, updates the energy balance and evaluates the acceleration.
    pub fn complete(&mut self, system: &mut System, [u, v]: &mut [Vec<f64>; 2], t: f64, dt: f64) {
        let end = StepEnd {
            t,
            dt,
            u,
            path: Path::Cubic {
                u: &self.u,
                v: [&self.v, v],
            },
        };
        system.end_step(&end, v, &mut self.a);
        std::mem::swap(&mut self.u, u);
        std::mem::swap(&mut self.v, v);
        self.close(system, t);
    }

    /// Completes a step of motion when displacement, velocity and acceleration belong to its end, time t:
    /// corrects the velocities for bonds that broke in a step too coarse for them.
    pub fn close(&mut self, system: &mut System, t: f64) {
        system.settle_breaking(t, &mut self.v);
        self.t = t;
    }
}

crate::saved! {
    impl Checkpointed for State {
        t: array("state/t"),
        step: array("state/step"),
        u: points("state/u"),
        v: points("state/v"),
        a: points("state/a"),
    }
}

/// A time integrator. Integrators do not print, write files or catch signals.
pub trait Integrator: Checkpointed + Send {
    /// Name in decks.
    fn name(&self) -> &'static str;

    /// Length of the vectors for which the scheme was made, dimension times points; `None` if it supports any body.
    /// A simulation of another body rejects it.
    fn vector_length(&self) -> Option<usize> {
        None
    }

    /// Time within a step at which forces are evaluated, which boundaries with memory depend on.
    fn step_kind(&self) -> StepKind {
        StepKind::Stages
    }

    /// Requirements on the system. The constructor checks them, and so does a run before its first step, when all
    /// boundaries and constraints are known.
    fn requirements(&self) -> &'static [Requirement] {
        &[]
    }

    /// Order of the error in dt.
    fn order(&self) -> u32;

    /// Largest stable ω dt for an undamped oscillation; `None` if the scheme is stable for any step.
    fn stability_limit(&self) -> Option<f64>;

    /// Returns the frequency that limits the step at displacement `u`, where `body` is the highest frequency of the
    /// body. They differ only for schemes with several steps.
    ///
    /// # Errors
    /// A body without stiffness.
    fn limiting_frequency(
        &self,
        system: &System,
        u: &[f64],
        body: HighestFrequency,
    ) -> Result<HighestFrequency> {
        let _ = (system, u);
        Ok(body)
    }

    /// Statistics of a multirate scheme; `None` for other schemes.
    fn refinement(&self) -> Option<RefinementReport> {
        None
    }

    /// Statistics of the inner iterations of an implicit scheme; `None` for other schemes.
    fn inner_iterations(&self) -> Option<InnerIterations> {
        None
    }

    /// Energy to be added to kinetic and elastic energy to give the energy that the scheme conserves, J. Zero for
    /// schemes that conserve the plain energy or none.
    fn energy_correction(&self, system: &System, state: &State, dt: f64) -> f64 {
        let _ = (system, state, dt);
        0.0
    }

    /// Returns whether the states are static: velocity, momentum and physical time have no meaning.
    fn is_static(&self) -> bool {
        false
    }

    /// Returns whether a step changes state or system before it is complete, so that an interrupted step must be
    /// undone from a copy.
    fn changes_within_step(&self) -> bool {
        false
    }

    /// Returns remarks for users on how the scheme found its states, if any.
    fn remark(&self) -> Option<String> {
        None
    }

    /// Reason why the energy drifts by design and how to avoid it; `None` for schemes whose drift is an error.
    fn intended_drift(&self) -> Option<&'static str> {
        None
    }

    /// Prepares the initial state: prescribed values and initial acceleration.
    fn start(&mut self, system: &mut System, state: &mut State) {
        state.start(system);
    }

    /// Largest number of steps that [`Integrator::advance`] takes at once: 1, except for processors that compute several
    /// steps before the host reads the state.
    fn steps_at_once(&self) -> u64 {
        1
    }

    /// Advances by up to `steps` steps, at most [`Integrator::steps_at_once`]; step k ends at time k `dt`. Returns with at
    /// least one more complete step. Errors are those of [`Integrator::step`].
    ///
    /// # Errors
    /// Those of [`Integrator::step`], for the step after the last complete one.
    fn advance(
        &mut self,
        system: &mut System,
        state: &mut State,
        (dt, steps): (f64, u64),
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let _ = steps;
        let t_next = (state.step + 1) as f64 * dt;
        self.step(system, state, t_next, interrupt)
    }

    /// Advances from `state.t` to `t_next`.
    ///
    /// Iterative schemes poll `interrupt` in every inner iteration. An interrupted step leaves state and system as
    /// they were before it, except for work arrays, unless [`changes_within_step`](Integrator::changes_within_step)
    /// requires the caller to restore them.
    ///
    /// # Errors
    /// No convergence of an iterative scheme; [`PericlesError::Interrupted`](crate::PericlesError::Interrupted) if
    /// a stop is requested.
    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()>;
}
