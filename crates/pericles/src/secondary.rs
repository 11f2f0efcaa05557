//! Secondary fields: scalars of the body that change with time besides its motion, such as temperature.

use std::any::Any;

use crate::archive::{Archive, Checkpointed};
use crate::error::Result;
use crate::operator::Force;

/// The end of a step of the body, for its secondary fields.
#[derive(Clone, Copy)]
pub struct BodyStep<'a> {
    /// Time at the end of the step, s.
    pub t: f64,
    /// The forces with the bonds that are intact now.
    pub forces: &'a dyn Force,
    /// Energy that each point has dissipated in the step by fracture and inelastic deformation, J; empty if no field
    /// [needs it](SecondaryField::reads_dissipation).
    pub dissipated: &'a [f64],
}

/// A computed scalar field of a body, such as its temperature.
///
/// The field is accepted up to the end of the last step. Forces that depend on it evaluate it at any later time, as a
/// function of the accepted state only, through a shared [`Temperature`](crate::Temperature); rejected steps need no
/// action. [`SecondaryField::end_step`] then moves the accepted state to the end of a step.
pub trait SecondaryField: Any + Checkpointed + Send + Sync {
    /// Name in reports.
    fn name(&self) -> &str;

    /// Prepares a run: checks that the field belongs to the body and reads which bonds exist.
    ///
    /// # Errors
    /// A body of another size; conditions that are not finite.
    fn start(&mut self, forces: &dyn Force) -> Result<()>;

    /// Takes the values at the time t (s) of another run from an archive of the field; keeps its own if there are none.
    /// [`SecondaryField::start`] follows.
    ///
    /// # Errors
    /// Values of another number of points.
    fn take_over(&mut self, state: &Archive, t: f64) -> Result<()>;

    /// Returns whether [`BodyStep::dissipated`] is needed.
    fn reads_dissipation(&self) -> bool {
        false
    }

    /// Moves the accepted state to the end of a step and reads which bonds have broken.
    ///
    /// # Errors
    /// Equations that could not be solved.
    fn end_step(&mut self, body: BodyStep<'_>) -> Result<()>;

    /// Sets the values of points that have become active at the end of the last step.
    fn set_new(&mut self, points: &[u32]);

    /// Reads which bonds exist, because bonds have come into being.
    fn read_bonds(&mut self, forces: &dyn Force);

    /// Sets the values of all points at a time.
    fn values_into(&self, t: f64, out: &mut [f64]);

    /// Sets the flux of all points at a time, component-major.
    fn flux_into(&self, t: f64, out: &mut [f64]);
}

impl dyn SecondaryField {
    /// Returns the field as one of the given type.
    pub fn downcast_ref<T: SecondaryField>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}
