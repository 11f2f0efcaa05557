//! A run that starts from the state of the body in another run.
//!
//! The state of a body is what its points and bonds have become: broken bonds and the energy that they dissipated, stored
//! variables of materials, and secondary fields. Displacement and velocity belong to the
//! [`State`](crate::time::State); loads, constraints, boundaries and contact belong to the run.

use super::System;
use crate::archive::{Archive, Checkpointed};
use crate::error::Result;

impl System {
    /// Adds the state of the body to an archive.
    pub fn save_body(&self, archive: &mut Archive) {
        self.forces.save(archive);
        self.fields.save(archive);
    }

    /// Starts from the state of the body at the time t (s) of another run, before the first step of this one. Arrays of
    /// [`System::save_body`] that `state` lacks keep their initial values: a body whose bonds could not break has no
    /// broken ones. Times of the other run are not taken over. Energy that was dissipated there counts as
    /// [energy at the start](crate::observe::StartEnergy).
    ///
    /// # Errors
    /// [`PericlesError::BadArchive`](crate::PericlesError::BadArchive): an array has another type or length.
    pub fn take_over(&mut self, state: &Archive, t: f64) -> Result<()> {
        let mut own = Archive::default();
        self.forces.save(&mut own);
        own.replace_by(state)?;
        self.forces.restore(&own)?;
        for field in &mut self.fields {
            field.take_over(state, t)?;
            field.start(self.forces.sum())?;
        }
        Ok(())
    }
}
