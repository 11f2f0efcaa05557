//! Entries of the energy balance: work and impulse of steps, load steps and heating.

use super::System;
use crate::operator::PointSubset;
use crate::step_end::{Path, StepEnd};

impl System {
    /// Adds work and impulse of a step to the energy balance; `acceleration` contains the free accelerations f/ρ of
    /// all points at its end.
    pub fn book_step(&mut self, step: &StepEnd<'_>, acceleration: &[f64]) {
        let n = self.points();
        let is_static = matches!(step.path, Path::Chord { .. });
        let activation = self.activation.as_ref();
        let shares = |i: usize| activation.map_or([1.0; 2], |one| one.load_shares(i, is_static));
        for load in &self.loads {
            let at = (self.loading, &*self.cloud);
            self.ledger.book_load(step, load, at, shares);
        }
        if is_static && let Some(activation) = &mut self.activation {
            activation.settle();
        }
        let density = |i: usize| self.density.at(i);
        let chord = match step.path {
            Path::Chord { u, .. } => Some([u, step.u]),
            _ => None,
        };
        for motion in &mut self.motions {
            let (work, impulse) = motion.account(
                step.t,
                step.dt,
                n,
                acceleration,
                chord,
                (&density, &self.cloud),
            );
            self.ledger.book(work, impulse);
        }
    }

    /// Updates the energy balance for a load step between two static states: loads and constraints act with the
    /// mean of their forces at both ends, without inertia. With length zero they are constant. `work` is a work
    /// array for accelerations.
    pub fn book_equilibrium(&mut self, step: &StepEnd<'_>, work: &mut [f64]) {
        if self.has_interactions() {
            self.zero(&PointSubset::All, work);
            let touched = self.end_interactions(step, work);
            self.book_exchange(touched);
        }
        self.free_acceleration(step.t, step.u, &PointSubset::All, work);
        let n = self.points();
        for motion in &self.motions {
            motion.add_acceleration(step.t, n, work);
        }
        self.book_heating(step);
        self.book_step(step, work);
    }

    /// Adds the work of temperature changes within a step that does not end with [`System::end_step`].
    pub(crate) fn book_heating(&mut self, step: &StepEnd<'_>) {
        let work = self.operator().heating(step);
        self.ledger.book(work, [0.0; 3]);
    }

    /// Stores the reactions of constraints to the internal forces alone at displacement u: the reactions of a body before
    /// loads and heating. `work` is a work array for accelerations.
    pub fn note_unloaded(&mut self, t: f64, u: &[f64], work: &mut [f64]) {
        self.zero(&PointSubset::All, work);
        self.count(&PointSubset::All);
        let is_heated = self.operator().capabilities().thermal.is_some();
        let unheated = if is_heated { f64::NEG_INFINITY } else { t };
        self.operator()
            .add_force(unheated, u, PointSubset::All, work);
        self.divide_by_density(&PointSubset::All, work);
        let n = self.points();
        let density = |i: usize| self.density.at(i);
        for motion in &mut self.motions {
            motion.add_acceleration(t, n, work);
            motion.account(t, 0.0, n, work, None, (&density, &self.cloud));
        }
    }
}
