//! The integrator of static states.

use pericles::System;
use pericles::time::Integrator;
use pericles_deck::{BuildError, RigidModes, StaticBreaking, Statics};
use pericles_statics::{BreakingRule, StaticOptions, StaticScheme};

use super::assembler::Assembler;

impl Assembler<'_> {
    pub(super) fn statics(
        &self,
        options: &Statics,
        system: &System,
    ) -> Result<Box<dyn Integrator>, BuildError> {
        let options = StaticOptions {
            tolerance: options.tolerance,
            newton_steps: options.newton_steps,
            breaking: match options.breaking {
                StaticBreaking::WorstFirst => BreakingRule::default(),
                StaticBreaking::All => BreakingRule::All,
                StaticBreaking::Event => BreakingRule::events(self.model.time.end),
            },
            fix_rigid_modes: options.rigid_modes == RigidModes::Fix,
            ..StaticOptions::default()
        };
        let scheme = StaticScheme::new(options, system).map_err(|error| self.at_scheme(error))?;
        Ok(Box::new(scheme))
    }
}
