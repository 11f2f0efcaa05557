//! Interactions: forces on the points by contact, with each other and with bodies that have a state of their own.

use std::any::Any;

use crate::archive::Checkpointed;
use crate::boundary::Exchange;
use crate::error::Result;
use crate::operator::Force;
use crate::parallel::PointSubset;
use crate::scalar::PointScalar;
use crate::step_end::StepEnd;

/// A configuration of the body at which an interaction is evaluated.
#[derive(Clone, Copy)]
pub struct Configuration<'a> {
    /// Time, s.
    pub t: f64,
    /// Displacement, m, component-major.
    pub u: &'a [f64],
    /// The internal forces, whose bonds decide which points may touch.
    pub forces: &'a dyn Force,
}

/// Data passed to an interaction at the end of a step: bonds have broken, and internal forces and loads are known.
#[derive(Clone, Copy)]
pub struct InteractionStep<'a> {
    /// The step.
    pub step: &'a StepEnd<'a>,
    /// The internal forces after bond failure.
    pub forces: &'a dyn Force,
    /// Density of each point, kg/m³.
    pub density: &'a PointScalar,
}

impl<'a> InteractionStep<'a> {
    /// Returns the configuration at the end of the step.
    pub fn configuration(&self) -> Configuration<'a> {
        Configuration {
            t: self.step.t,
            u: self.step.u,
            forces: self.forces,
        }
    }
}

/// A force on the points of a body that is not carried by bonds: contact between points, and contact with rigid
/// bodies that move on their own.
///
/// Unlike a [`Force`] it may have bodies with a state, depend on velocities at the end of steps, and exchange work and
/// impulse with the outside. Its sign convention is the same as for forces on the points. Like a force, it acts inside the
/// evaluation of the acceleration, so that reactions of constrained points contain it.
///
/// If the body is divided among processes, each evaluates the forces on its own points; bodies and energies are the same on all
/// of them. All processes must call the methods that take a configuration, the end of a step or densities together.
///
/// The part that depends on displacements and time only has the potential [`Interaction::energy`]. Dampers, friction
/// and free bodies act and advance in [`Interaction::end_step`] only, once per accepted step.
pub trait Interaction: Any + Checkpointed + Send + Sync {
    /// Name in reports.
    fn name(&self) -> &str;

    /// Checks that the interaction can act on a body with these internal forces.
    ///
    /// # Errors
    /// Forces without a query that the interaction needs; a body of another size.
    fn check(&self, forces: &dyn Force) -> Result<()>;

    /// Adds the force density (N/m³) with a potential at a configuration for the points `on`. Bodies with a prescribed
    /// motion are at their place at the time of the configuration.
    fn add_force(&self, at: &Configuration<'_>, on: &PointSubset<'_>, out: &mut [f64]);

    /// Returns the stored energy at a configuration, J.
    fn energy(&self, at: &Configuration<'_>) -> f64;

    /// Adds the derivative of the force density in a direction.
    fn add_tangent(&self, at: &Configuration<'_>, direction: &[f64], out: &mut [f64]);

    /// Returns the work (J) of prescribed motions of bodies between two configurations, with the mean of the forces at
    /// both.
    fn work_between(&self, from: &Configuration<'_>, to: &Configuration<'_>) -> f64 {
        let _ = (from, to);
        0.0
    }

    /// Ends a step: moves free bodies to its end, adds all force densities to `out`, which contains the forces of bonds and
    /// loads, and returns work and impulse on points and bodies by the outside. Steps of length zero start a run.
    fn end_step(&mut self, end: &InteractionStep<'_>, out: &mut [f64]) -> Exchange {
        self.add_force(&end.configuration(), &PointSubset::All, out);
        Exchange::default()
    }

    /// Adds the force density (N/m³) of dampers and friction at the last accepted state to `out`, for output.
    fn add_drag(&self, out: &mut [f64]) {
        let _ = out;
    }

    /// Energy dissipated by dampers and friction so far, J.
    fn dissipated(&self) -> f64 {
        0.0
    }

    /// Kinetic energy of free bodies, J.
    fn kinetic(&self) -> f64 {
        0.0
    }

    /// Difference between the energy of free bodies that velocity Verlet conserves with the step dt and
    /// [`Interaction::kinetic`], J.
    fn scheme_correction(&self, dt: f64) -> f64 {
        let _ = dt;
        0.0
    }

    /// Linear momentum of free bodies, kg m/s.
    fn momentum(&self) -> [f64; 3] {
        [0.0; 3]
    }

    /// Highest angular frequency (1/s) of a single contact: a pair of points, or a point and a body. A contact lasts π
    /// over this frequency.
    fn contact_frequency(&self, density: &PointScalar) -> f64;

    /// Returns whether all forces have a potential: no dampers, no friction.
    fn is_conservative(&self) -> bool;

    /// Returns whether bodies move under the forces of the points.
    fn has_free_bodies(&self) -> bool {
        false
    }

    /// Largest overlap at the last accepted state relative to the contact distance; 1 where points coincide.
    fn overlap(&self) -> f64;
}

impl dyn Interaction {
    /// Returns the interaction as one of the given type.
    pub fn downcast_ref<T: Interaction>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}
