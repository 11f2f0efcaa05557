//! What forces and observers read of a computed field.

use std::fmt;
use std::sync::{MutexGuard, PoisonError};

use pericles::Temperature;

use super::{FieldOptions, SharedField, State};
use crate::advance::Flows;
use crate::problem::Problem;
use crate::solver::Effort;

impl SharedField {
    pub(super) fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Calls `read` with the problem.
    pub fn with_problem<R>(&self, read: impl FnOnce(&Problem) -> R) -> R {
        read(&self.state().problem)
    }

    /// Returns the options.
    pub fn options(&self) -> FieldOptions {
        self.state().options
    }

    /// Returns the content at a time, J for heat.
    pub fn content(&self, t: f64) -> f64 {
        let mut state = self.state();
        let values = state.values_at(t);
        state.problem.content(&values)
    }

    /// Returns the content at the start, J for heat.
    pub fn initial_content(&self) -> f64 {
        self.state().initial
    }

    /// Returns the content that has flowed in by each condition until a time, J for heat.
    pub fn flows(&self, t: f64) -> Flows {
        let mut state = self.state();
        let mut flows = vec![0.0; state.problem.conditions().len()];
        state.mix_into(t, |state| &state.flows, &mut flows);
        flows
    }

    /// Returns the heat from dissipated energy since the start, J; `None` if dissipated energy does not become heat.
    pub fn heat_from_dissipation(&self) -> Option<f64> {
        let dissipation = self.state().dissipation;
        dissipation.map(|dissipation| dissipation.heat)
    }

    /// Returns the content that points have brought when they became active, J for heat; `None` if they keep their values.
    pub fn content_of_new_points(&self) -> Option<f64> {
        self.state().new.as_ref().map(|new| new.content)
    }

    /// Returns the smallest and the largest value at a time.
    pub fn range(&self, t: f64) -> [f64; 2] {
        let mut state = self.state();
        let values = state.values_at(t);
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut most = [-low, high];
        state.problem.domain().max_each(&mut most);
        [-most[0], most[1]]
    }

    /// Returns the largest stable step of the explicit scheme at a time, s.
    pub fn explicit_limit(&self, t: f64) -> f64 {
        let mut state = self.state();
        let values = state.values_at(t);
        state.problem.explicit_limit(&values)
    }

    /// Returns the number of products with the conductances up to the latest state.
    pub fn effort(&self) -> Effort {
        let state = self.state();
        state.ahead.as_ref().unwrap_or(&state.accepted).to.effort
    }
}

impl Temperature for SharedField {
    fn temperatures_into(&self, t: f64, out: &mut [f64]) {
        self.state().mix_into(t, |state| &state.values, out);
    }

    fn revision(&self) -> u64 {
        self.state().revision
    }
}

impl fmt::Debug for SharedField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SharedField").finish_non_exhaustive()
    }
}
