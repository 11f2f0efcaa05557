//! Time integration: u(t) ↦ u(t + dt), any scheme.

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

use crate::archive::Saved;
use crate::compatibility::Requirement;
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::step_end::{Path, StepEnd};
use crate::step_kind::StepKind;
use crate::system::System;

/// The state of a body: structure of arrays, component-major.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Time, s.
    pub t: f64,
    /// Steps taken.
    pub step: u64,
    /// Displacement, m.
    pub u: Vec<f64>,
    /// Velocity, m/s.
    pub v: Vec<f64>,
    /// Acceleration at (t, u), m/s².
    pub a: Vec<f64>,
}

impl State {
    /// The body of a system, undeformed and at rest at t = 0.
    pub fn of(system: &System) -> Self {
        Self::at_rest(system.dimension() * system.points())
    }

    /// The same of a body with so many entries, dimension times points.
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
    /// Begins a run: prescribed values and the acceleration at the start.
    pub fn start(&mut self, system: &mut System) {
        system.constrain(self.t, &mut self.u, &mut self.v);
        system.constrain_velocity(self.t, &mut self.v);
        system.start(self.t, &self.u, &self.v, &mut self.a);
    }

    /// Ends a step of length dt at time t with the displacement and velocity in `next`, which then hold those before the step: decides breaking, books work and
    /// impulse, and evaluates the acceleration.
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

    /// The last act of every step of motion, once displacement, velocity and acceleration are those of its end, time t: settles the bonds that broke in a step too coarse for them.
    pub fn close(&mut self, system: &mut System, t: f64) {
        system.settle_breaking(t, &mut self.v);
        self.t = t;
    }
}

crate::saved! {
    impl Saved for State {
        t: array("state/t"),
        step: array("state/step"),
        u: array("state/u"),
        v: array("state/v"),
        a: array("state/a"),
    }
}

/// A scheme that takes a body from one time to the next. Integrators never print, save to files or catch signals.
pub trait Integrator: Saved + Send {
    /// Name as in decks.
    fn name(&self) -> &'static str;

    /// Entries of the vectors that it was made for, dimension times points; none if it steps any body. A run of another body refuses it.
    fn vector_length(&self) -> Option<usize> {
        None
    }

    /// Where within a step it takes the forces: what boundaries with a memory depend on.
    fn step_kind(&self) -> StepKind {
        StepKind::Stages
    }

    /// What it needs of the system. Its constructor refuses a system that does not meet it, and so does a run before its first step, when all boundaries and supports are known.
    fn requirements(&self) -> &'static [Requirement] {
        &[]
    }

    /// Order of the error in dt.
    fn order(&self) -> u32;

    /// The largest stable ω dt for an undamped oscillation; none if the scheme is stable for any step.
    fn stability_limit(&self) -> Option<f64>;

    /// The frequency that limits the step at displacement `u`, where `body` is the body's highest: the same, except for schemes whose step is not the same everywhere.
    ///
    /// # Errors
    /// A body without any stiffness.
    fn limiting_frequency(
        &self,
        system: &System,
        u: &[f64],
        body: HighestFrequency,
    ) -> Result<HighestFrequency> {
        let _ = (system, u);
        Ok(body)
    }

    /// What a scheme with two time steps did so far; none for other schemes.
    fn refinement(&self) -> Option<RefinementReport> {
        None
    }

    /// What the inner iterations of an implicit scheme did so far; none for other schemes.
    fn inner_iterations(&self) -> Option<InnerIterations> {
        None
    }

    /// What must be added to the kinetic and elastic energy of a state so that their sum is what the scheme itself conserves, J. Zero
    /// for schemes that conserve the plain energy, or none.
    fn energy_correction(&self, system: &System, state: &State, dt: f64) -> f64 {
        let _ = (system, state, dt);
        0.0
    }

    /// Whether its states are static: velocities, momentum and true time play no part.
    fn is_static(&self) -> bool {
        false
    }

    /// Whether a step changes state or system before it is complete, so that one that is interrupted has to be undone from a copy made before it.
    fn changes_within_step(&self) -> bool {
        false
    }

    /// Why the energy of the body drifts by design, and what to change if it shall not; none for schemes whose drift is an error of the step.
    fn intended_drift(&self) -> Option<&'static str> {
        None
    }

    /// Prepares the state at t = 0: prescribed values and initial acceleration.
    fn start(&mut self, system: &mut System, state: &mut State) {
        state.start(system);
    }

    /// Steps from `state.t` to `t_next`.
    ///
    /// Schemes that iterate poll `interrupt` in every inner iteration. A step that is interrupted leaves state and system as they were before it, except for
    /// work arrays, unless [`changes_within_step`](Integrator::changes_within_step) says that the caller must restore them.
    ///
    /// # Errors
    /// Schemes that iterate report when they do not converge; [`PericlesError::Interrupted`](crate::PericlesError::Interrupted) if asked to stop.
    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()>;
}
