//! Boundary conditions: loads, prescribed motions, damping layers and other boundaries with a state.

mod components;
mod damping;
mod function;
mod load;
mod loading;
mod motion;
mod rayleigh;
mod reaction;
mod table;
mod values;

pub use components::MotionComponent;
pub use damping::{DampedSteps, DampingLayer, DampingProfile};
pub use function::{TimeCourse, TimeFunction};
pub use load::{ALWAYS, FieldFunction, Load, LoadDensity};
pub use loading::ProportionalLoading;
pub use motion::{AxisMotion, MotionKind, PrescribedMotion, Trajectory};
pub use rayleigh::{RayleighDamping, RayleighRates, Stiffness, StiffnessProduct};
pub use table::TimeTable;
pub use values::PointValues;

use crate::archive::Checkpointed;
use crate::domain::Domain;
use crate::parallel::PointSubset;
use crate::step_end::StepEnd;
use crate::step_kind::StepKind;

/// Work and impulse of a boundary on the body over a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Exchange {
    /// Work, J.
    pub work: f64,
    /// Impulse, N s.
    pub impulse: [f64; 3],
}

impl Exchange {
    /// Adds another exchange.
    pub fn add(&mut self, other: Self) {
        self.work += other.work;
        for (sum, impulse) in self.impulse.iter_mut().zip(other.impulse) {
            *sum += impulse;
        }
    }

    /// Returns the totals over all processes of a component-major vector of impulses (N s) on `points` points and of the
    /// work (J) of each. All processes must call it together.
    fn total(domain: &Domain, points: usize, impulse: &[f64], work: &[f64]) -> Self {
        let along = |c: usize| {
            let axis = impulse.chunks(points.max(1)).nth(c).unwrap_or(&[]);
            domain.sum(axis.len(), |k| axis[k])
        };
        Self {
            work: domain.sum(work.len(), |k| work[k]),
            impulse: std::array::from_fn(along),
        }
    }
}

/// A stage of a step, as passed to a boundary.
#[derive(Debug, Clone)]
pub struct Stage<'a> {
    /// Time, s.
    pub t: f64,
    /// Displacement, m.
    pub u: &'a [f64],
    /// Velocity, m/s; for velocity Verlet the mean velocity of the previous step.
    pub v: &'a [f64],
    /// Points whose accelerations are computed.
    pub on: PointSubset<'a>,
}

/// Linear action of a boundary within an implicit step.
///
/// With displacements u at the middle of the step the boundary adds the acceleration d − S u, where d depends on
/// previous steps and S is symmetric and positive semidefinite in the inner product weighted by the masses.
pub trait ImplicitBoundary {
    /// Adds the acceleration of the present state.
    fn add_present(&self, acceleration: &mut [f64]);

    /// Adds d − S u.
    fn add_middle(&self, u: &[f64], acceleration: &mut [f64]);

    /// Adds S u.
    fn add_stiffness(&self, u: &[f64], out: &mut [f64]);
}

/// A boundary that acts around force evaluations: ghost points, absorbing boundaries, damping layers.
pub trait Boundary: Checkpointed + Send + Sync {
    /// Called before the force is evaluated at time t, with displacement and velocity of the stage.
    fn before_force(&mut self, t: f64, u: &mut [f64], v: &mut [f64]) {
        let _ = (t, u, v);
    }

    /// Called once for the initial state and once for every accepted state, before [`Boundary::after_stage`] of
    /// that state: updates the memory. Returns work and impulse on the body over the step that ended, which has
    /// length 0 at the start.
    fn accept(&mut self, step: &StepEnd<'_>) -> Exchange {
        let _ = step;
        Exchange::default()
    }

    /// Called when the accelerations of a stage are known on the points of `on`; may change them. Velocities are
    /// the values of the stage.
    fn after_stage(&mut self, stage: &Stage<'_>, acceleration: &mut [f64]);

    /// [`Boundary::accept`] with access to the stiffness of the body.
    fn accept_with(&mut self, step: &StepEnd<'_>, stiffness: Stiffness<'_>) -> Exchange {
        let _ = stiffness;
        self.accept(step)
    }

    /// [`Boundary::after_stage`] with access to the stiffness of the body.
    fn after_stage_with(
        &mut self,
        stage: &Stage<'_>,
        stiffness: Stiffness<'_>,
        acceleration: &mut [f64],
    ) {
        let _ = stiffness;
        self.after_stage(stage, acceleration);
    }

    /// Returns work and impulse on the body over the step that ended which depend on the accelerations at its end, in addition
    /// to those of [`Boundary::accept`]. Called once for every accepted state, after [`Boundary::after_stage`].
    fn account(&mut self, step: &StepEnd<'_>) -> Exchange {
        let _ = step;
        Exchange::default()
    }

    /// Returns whether the boundary depends on more than the current state. Schemes with trial steps or steps of
    /// varying length do not support such a boundary.
    fn has_memory(&self) -> bool {
        true
    }

    /// Supported kinds of steps; empty if all are supported.
    fn step_kinds(&self) -> &'static [StepKind] {
        &[]
    }

    /// Damps velocities (m/s) over a time dt in which no other force acts. Schemes without a force evaluation in
    /// the step or with split forces ([`StepKind::Flow`], [`StepKind::Kicks`]) call it for half a step before and
    /// after their own step. Returns work and impulse on the body.
    fn damp(&self, dt: f64, v: &mut [f64]) -> Exchange {
        let _ = (dt, v);
        Exchange::default()
    }

    /// Returns the boundary as a damping layer of explicit steps, if it is one.
    fn as_layer(&self) -> Option<&DampingLayer> {
        None
    }

    /// Returns [`Boundary::as_layer`] for modification.
    fn as_layer_mut(&mut self) -> Option<&mut DampingLayer> {
        None
    }

    /// Returns the action within an implicit step; `None` for boundaries that only explicit schemes support.
    fn within_step(&self) -> Option<&dyn ImplicitBoundary> {
        None
    }

    /// Number of steps for which the boundary is made; `None` if any.
    fn steps(&self) -> Option<u64> {
        None
    }
}
