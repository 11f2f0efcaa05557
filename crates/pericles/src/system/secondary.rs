//! Secondary fields of a system.

use super::System;
use crate::error::Result;
use crate::secondary::{BodyStep, SecondaryField};

impl System {
    /// Adds a secondary field.
    ///
    /// # Errors
    /// The errors of [`SecondaryField::start`].
    pub fn add_field(&mut self, mut field: Box<dyn SecondaryField>) -> Result<()> {
        field.start(self.operator())?;
        self.fields.push(field);
        self.follow_dissipation();
        Ok(())
    }

    /// Makes the forces record which points dissipate energy, if a field needs it.
    pub(super) fn follow_dissipation(&mut self) {
        if self.reads_dissipation()
            && let Some(breaking) = self.operator_mut().breaking_mut()
        {
            breaking.bonds_mut().follow_dissipation();
        }
    }

    fn reads_dissipation(&self) -> bool {
        self.fields().any(SecondaryField::reads_dissipation)
    }

    /// The secondary fields.
    pub fn fields(&self) -> impl Iterator<Item = &dyn SecondaryField> {
        self.fields.iter().map(|field| &**field)
    }

    /// Moves the accepted state of the secondary fields to the end of a step; the time loop calls it after every step.
    ///
    /// # Errors
    /// The errors of [`SecondaryField::end_step`].
    pub fn end_fields(&mut self, t: f64) -> Result<()> {
        let mut dissipated = Vec::new();
        if self.reads_dissipation() {
            dissipated.resize(self.points(), 0.0);
            if let Some(breaking) = self.operator_mut().breaking_mut() {
                breaking.bonds_mut().take_dissipated(&mut dissipated);
            }
        }
        let body = BodyStep {
            t,
            forces: self.forces.sum(),
            dissipated: &dissipated,
        };
        let mut fields = self.fields.iter_mut();
        fields.try_for_each(|field| field.end_step(body))
    }
}
