//! Interactions of a system: contact between points and with bodies of their own.

use super::System;
use crate::boundary::Exchange;
use crate::error::Result;
use crate::interaction::{Configuration, Interaction, InteractionStep};
use crate::parallel::PointSubset;
use crate::scalar::PointScalar;
use crate::step_end::StepEnd;

impl System {
    /// Adds an interaction.
    ///
    /// # Errors
    /// The errors of [`Interaction::check`].
    pub fn add_interaction(&mut self, interaction: Box<dyn Interaction>) -> Result<()> {
        interaction.check(self.operator())?;
        self.interactions.push(interaction);
        Ok(())
    }

    /// The interactions.
    pub fn interactions(&self) -> impl Iterator<Item = &dyn Interaction> {
        self.interactions.iter().map(|one| &**one)
    }

    /// Returns whether there are interactions.
    pub fn has_interactions(&self) -> bool {
        !self.interactions.is_empty()
    }

    /// Returns whether the internal forces are linear in the displacement while no bond breaks, in any precision, and
    /// nothing else acts that is not.
    pub fn is_linear(&self) -> bool {
        self.operator().is_linear() && !self.has_interactions()
    }

    /// Adds the force density of contact at displacement u, with dampers and friction as they are at the last accepted
    /// state, N/m³.
    pub fn add_contact_force(&self, t: f64, u: &[f64], out: &mut [f64]) {
        self.add_interactions(t, u, &PointSubset::All, out);
        self.interactions().for_each(|one| one.add_drag(out));
    }

    /// Returns the energy stored by the internal forces and by contact at displacement u, J.
    pub fn stored_energy(&self, t: f64, u: &[f64]) -> f64 {
        self.operator().energy(t, u) + self.contact_energy(t, u)
    }

    /// Returns the kinetic and stored energy at displacement u and velocity v, with contact and
    /// the bodies of interactions, J.
    pub fn mechanical_energy(&self, t: f64, u: &[f64], v: &[f64]) -> f64 {
        let kinetic = self.kinetic_energy(v) + self.body_kinetic_energy();
        kinetic + self.stored_energy(t, u)
    }

    /// Returns the energy stored by contact at displacement u, J.
    pub fn contact_energy(&self, t: f64, u: &[f64]) -> f64 {
        let at = self.configuration(t, u);
        self.interactions().map(|one| one.energy(&at)).sum()
    }

    /// Returns the work (J) of prescribed motions of bodies in contact between two times and displacements, with the mean
    /// of the forces at both.
    pub fn contact_work(&self, from: (f64, &[f64]), to: (f64, &[f64])) -> f64 {
        let [from, to] = [from, to].map(|(t, u)| self.configuration(t, u));
        let works = self.interactions().map(|one| one.work_between(&from, &to));
        works.sum()
    }

    /// Returns the energy dissipated by the internal forces and by contact so far, J.
    pub fn dissipated(&self) -> f64 {
        self.operator().dissipated() + self.contact_dissipated()
    }

    /// Returns the energy dissipated by contact so far, J.
    pub fn contact_dissipated(&self) -> f64 {
        self.interactions().map(|one| one.dissipated()).sum()
    }

    /// Kinetic energy of the bodies of interactions, J.
    pub fn body_kinetic_energy(&self) -> f64 {
        self.interactions().map(|one| one.kinetic()).sum()
    }

    /// Adds internal forces and interactions at displacement u, N/m³, for the points of `on`.
    pub fn add_internal_force(&self, t: f64, u: &[f64], on: &PointSubset<'_>, out: &mut [f64]) {
        self.operator().add_force(t, u, on.clone(), out);
        self.add_interactions(t, u, on, out);
    }

    /// Sets `out` to the derivative of internal forces and interactions at u in the given direction.
    pub fn internal_tangent_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.operator().tangent_into(t, u, direction, out);
        self.add_contact_tangent(t, u, direction, out);
    }

    pub(super) fn add_interactions(
        &self,
        t: f64,
        u: &[f64],
        on: &PointSubset<'_>,
        out: &mut [f64],
    ) {
        let at = self.configuration(t, u);
        for interaction in &self.interactions {
            interaction.add_force(&at, on, out);
        }
    }

    /// Adds the derivative of contact at u in the given direction.
    pub fn add_contact_tangent(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        let at = self.configuration(t, u);
        for interaction in &self.interactions {
            interaction.add_tangent(&at, direction, out);
        }
    }

    /// Ends a step of all interactions, adds their force densities and returns work and impulse of the outside.
    pub(super) fn end_interactions(&mut self, step: &StepEnd<'_>, out: &mut [f64]) -> Exchange {
        let mut exchange = Exchange::default();
        let end = InteractionStep {
            step,
            forces: self.forces.sum(),
            density: &self.density,
        };
        for interaction in &mut self.interactions {
            exchange.add(interaction.end_step(&end, out));
        }
        exchange
    }

    /// Difference between the energy of the bodies of interactions that velocity Verlet conserves and their kinetic
    /// energy, J.
    pub(crate) fn interaction_correction(&self, dt: f64) -> f64 {
        self.interactions()
            .map(|one| one.scheme_correction(dt))
            .sum()
    }

    /// Returns a frequency (1/s) that contacts add to those of the bonds, for the density of each point (kg/m³); zero
    /// without interactions. A point of a compact lattice has several contacts at a time, which together reach √1.7
    /// times the frequency of a single one at the upper end of the spectrum (measured on pressed lattice blocks with
    /// one, two and four contacts per point).
    pub fn contact_frequency(&self, density: &PointScalar) -> f64 {
        /// Ratio of squared frequencies of many contacts and one.
        const SEVERAL: f64 = 1.7;
        SEVERAL.sqrt() * self.single_contact_frequency(density)
    }

    /// Returns the highest frequency (1/s) of a single contact, for the density of each point (kg/m³); zero without
    /// interactions.
    pub fn single_contact_frequency(&self, density: &PointScalar) -> f64 {
        let all = self
            .interactions()
            .map(|one| one.contact_frequency(density));
        all.fold(0.0, f64::max)
    }

    /// Returns the largest stable time step (s) with several contacts per point, where `stable` is the step of the bonds
    /// alone under a scheme that is stable for ω dt ≤ `limit`.
    pub fn stable_contact_step(&self, stable: f64, limit: f64) -> f64 {
        if self.interactions.is_empty() {
            return stable;
        }
        let many = self.contact_frequency(&self.density) / limit;
        1.0 / (1.0 / stable).hypot(many)
    }

    /// Returns the longest time step (s) with at least five steps per contact of a lone pair, 0.63/ω; infinite without
    /// interactions. The velocity after the contact is then within 4 % of that before; at the limit of stability the
    /// ratio is between 0.9 and 1.1.
    pub fn longest_contact_step(&self) -> f64 {
        /// ω dt at five steps per contact, which lasts π/ω.
        const RESOLVED: f64 = 0.63;
        match self.single_contact_frequency(&self.density) {
            0.0 => f64::INFINITY,
            single => RESOLVED / single,
        }
    }

    fn configuration<'a>(&'a self, t: f64, u: &'a [f64]) -> Configuration<'a> {
        Configuration {
            t,
            u,
            forces: self.operator(),
        }
    }
}
