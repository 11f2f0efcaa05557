//! Secondary fields of a system.

use super::System;
use crate::error::Result;
use crate::secondary::SecondaryField;

impl System {
    /// Adds a secondary field.
    ///
    /// # Errors
    /// Those of [`SecondaryField::start`].
    pub fn add_field(&mut self, mut field: Box<dyn SecondaryField>) -> Result<()> {
        field.start(self.operator())?;
        self.fields.push(field);
        Ok(())
    }

    /// The secondary fields.
    pub fn fields(&self) -> impl Iterator<Item = &dyn SecondaryField> {
        self.fields.iter().map(|field| &**field)
    }

    /// Moves the accepted state of the secondary fields to the end of a step; the time loop calls it after every step.
    ///
    /// # Errors
    /// Those of [`SecondaryField::end_step`].
    pub fn end_fields(&mut self, t: f64) -> Result<()> {
        let forces = self.forces.sum();
        let mut fields = self.fields.iter_mut();
        fields.try_for_each(|field| field.end_step(t, forces))
    }
}
