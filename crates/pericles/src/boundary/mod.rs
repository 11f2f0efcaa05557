//! Loads, prescribed motion, and boundaries with memory.

mod damping;
mod function;
mod load;
mod motion;
mod table;

pub use damping::{DampingLayer, DampingProfile};
pub use function::{TimeCourse, TimeFunction};
pub use load::{ALWAYS, FieldFunction, Load, LoadDensity};
pub use motion::{AxisMotion, MotionKind, PrescribedMotion, Trajectory};
pub use table::TimeTable;

use crate::archive::Saved;
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

    /// Called after the accelerations of a stage are known; may change them.
    fn after_stage(&mut self, t: f64, u: &[f64], v: &[f64], acceleration: &mut [f64]);

    /// The kinds of steps it is made for; empty if any.
    fn step_kinds(&self) -> &'static [StepKind] {
        &[]
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
