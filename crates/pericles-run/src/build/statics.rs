//! The integrator of static states.

use std::sync::Arc;

use pericles::System;
use pericles::observe::Probe;
use pericles::time::Integrator;
use pericles_deck::{BuildError, RigidModes, StaticBreaking, Statics};
use pericles_statics::{BreakingRule, Control, StaticOptions, StaticScheme};

use super::assembler::Assembler;
use super::rejection::at;
use crate::control::ControlSignal;

impl Assembler<'_> {
    pub(super) fn statics(
        &self,
        options: &Statics,
        system: &System,
        probes: &[Probe],
    ) -> Result<Box<dyn Integrator>, BuildError> {
        let control = match &options.control {
            Some(control) => Some(Control {
                quantity: Arc::new(ControlSignal::new(control, self.model, probes)?),
                rate: control.rate,
                reference: self.model.time.end,
            }),
            None => None,
        };
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
        let scheme = match control {
            Some(control) => StaticScheme::controlled(options, control, system)
                .map_err(|error| at("time.control", error)),
            None => StaticScheme::new(options, system).map_err(|error| self.at_scheme(error)),
        };
        Ok(Box::new(scheme?))
    }
}
