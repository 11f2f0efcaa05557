//! Loads, prescribed motion, and boundaries with memory.

mod damping;
mod function;
mod load;
mod motion;
mod rayleigh;
mod table;

pub use damping::{DampedSteps, DampingLayer, DampingProfile};
pub use function::{TimeCourse, TimeFunction};
pub use load::{ALWAYS, FieldFunction, Load, LoadDensity};
pub use motion::{AxisMotion, MotionKind, PrescribedMotion, Trajectory};
pub use rayleigh::{RayleighDamping, RayleighRates, Stiffness, StiffnessProduct};
pub use table::TimeTable;

use crate::archive::Saved;
use crate::parallel::On;
use crate::step_end::StepEnd;
use crate::step_kind::StepKind;

/// What a boundary gave the body over a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Exchange {
    /// Work, J.
    pub work: f64,
    /// Impulse, N s.
    pub impulse: [f64; 3],
}

impl Exchange {
    /// Adds another one.
    pub fn add(&mut self, other: Self) {
        self.work += other.work;
        for (sum, impulse) in self.impulse.iter_mut().zip(other.impulse) {
            *sum += impulse;
        }
    }
}

/// A stage of a step, as a boundary sees it.
#[derive(Debug, Clone)]
pub struct Stage<'a> {
    /// Its time, s.
    pub t: f64,
    /// Displacement, m.
    pub u: &'a [f64],
    /// Velocity, m/s; of velocity Verlet the mean velocity of the step before.
    pub v: &'a [f64],
    /// The points whose accelerations are computed.
    pub on: On<'a>,
}

/// What a boundary gives the body within a step whose end is an unknown: an acceleration that depends linearly on it.
///
/// With displacements u at the middle of the step the acceleration is d − S u, where d is what the boundary remembers of the steps before, and S is symmetric and positive semidefinite when weighed by
/// masses.
pub trait WithinStep {
    /// Adds the acceleration that is part of the present state's.
    fn add_present(&self, acceleration: &mut [f64]);

    /// Adds d − S u.
    fn add_middle(&self, u: &[f64], acceleration: &mut [f64]);

    /// Adds S u.
    fn add_stiffness(&self, u: &[f64], out: &mut [f64]);
}

/// A boundary that acts on the state around force evaluations: ghost points, absorbing ends, damping layers.
pub trait Boundary: Saved + Send + Sync {
    /// Called before the force is evaluated at time t, with the displacement and velocity of that stage.
    fn before_force(&mut self, t: f64, u: &mut [f64], v: &mut [f64]) {
        let _ = (t, u, v);
    }

    /// Called once for the initial state and for every accepted one, before [`Boundary::after_stage`] is called for it: here memory goes on. Returns what the
    /// boundary did to the body over the step that ended, which has length 0 at the start.
    fn accept(&mut self, step: &StepEnd<'_>) -> Exchange {
        let _ = step;
        Exchange::default()
    }

    /// Called after the accelerations of a stage are known for the points named by `on`; may change these. Velocities are those of the stage.
    fn after_stage(&mut self, stage: &Stage<'_>, acceleration: &mut [f64]);

    /// [`Boundary::accept`] with what it may ask of the forces of the body.
    fn accept_with(&mut self, step: &StepEnd<'_>, stiffness: Stiffness<'_>) -> Exchange {
        let _ = stiffness;
        self.accept(step)
    }

    /// [`Boundary::after_stage`] with what it may ask of the forces of the body.
    fn after_stage_with(
        &mut self,
        stage: &Stage<'_>,
        stiffness: Stiffness<'_>,
        acceleration: &mut [f64],
    ) {
        let _ = stiffness;
        self.after_stage(stage, acceleration);
    }

    /// Whether what it does depends on more than the state that it is given: schemes that try steps, or whose steps have different lengths, cannot follow such a boundary.
    fn has_memory(&self) -> bool {
        true
    }

    /// The kinds of steps it is made for; empty if any.
    fn step_kinds(&self) -> &'static [StepKind] {
        &[]
    }

    /// Damps velocities (m/s) as it does over a time dt in which nothing else acts, for schemes that take the force nowhere or in parts ([`StepKind::Flow`], [`StepKind::Kicks`]): they let it act
    /// for half of a step before and half of it after their own. Returns what the boundary did to the body.
    fn damp(&self, dt: f64, v: &mut [f64]) -> Exchange {
        let _ = (dt, v);
        Exchange::default()
    }

    /// Its part in a step that is solved for as a whole; none for boundaries that explicit schemes alone can follow.
    fn within_step(&self) -> Option<&dyn WithinStep> {
        None
    }

    /// Steps that it is made for; none if any number.
    fn steps(&self) -> Option<u64> {
        None
    }
}
