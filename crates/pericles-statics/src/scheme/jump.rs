//! Energy that a body loses where no static path leads to its next state, and that it does not dissipate in bonds.

use pericles::System;
use pericles::time::State;

use super::StaticScheme;
use crate::breaking::BreakingRule;

/// Energies before a jump.
pub(super) struct Change {
    t: f64,
    stored: f64,
    dissipated: f64,
}

impl Change {
    pub fn of(system: &System, t: f64, u: &[f64]) -> Self {
        Self {
            t,
            stored: system.stored_energy(t, u),
            dissipated: system.operator().dissipated(),
        }
    }

    /// Returns the stored energy that the body has lost and not dissipated in bonds, J.
    pub fn lost(&self, system: &System, u: &[f64]) -> f64 {
        let dissipated = system.operator().dissipated() - self.dissipated;
        self.stored - system.stored_energy(self.t, u) - dissipated
    }
}

impl StaticScheme {
    /// Breaks bonds beyond their limits at a static state; returns whether any broke. `is_jump` states that the energy
    /// released on the way to the state is known as the difference of stored energies. It then includes what bonds
    /// dissipated by softening on the way, which the end of the step books.
    pub(super) fn break_bonds(
        &mut self,
        system: &mut System,
        state: &mut State,
        (t, is_jump): (f64, bool),
        rule: BreakingRule,
    ) -> bool {
        let follows_history = system.operator().capabilities().path_dependent;
        let before = (is_jump && follows_history).then(|| Change::of(system, t, &state.u));
        let beyond = rule.apply(system, t, &state.u, &mut state.a);
        self.released += match before {
            Some(before) => before.lost(system, &state.u),
            None => beyond.unwrap_or(0.0),
        };
        beyond.is_some()
    }
}
