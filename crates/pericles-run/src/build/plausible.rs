//! Warnings about implausible values and values without effect.

use pericles::System;
use pericles::boundary::MotionKind;
use pericles::domain::Domain;
use pericles::observe::Schedule;
use pericles::time::State;
use pericles_deck::{Caution, CrackOutput, Model, ModelWarning, Remark, Scheme, Solid};

use super::assembler::Assembler;
use super::constants::MaterialConstants;

impl Assembler<'_> {
    /// Warns of densities and moduli that no solid has. Decks in dimensionless units (ρ = 1, E = 1) are not checked.
    pub(super) fn check_solid(
        &self,
        solid: &Solid,
        constants: &MaterialConstants,
    ) -> Vec<ModelWarning> {
        /// Largest density, kg/m³; osmium has 22 600.
        const DENSEST: f64 = 1e5;
        /// Smallest density of ordinary solids, kg/m³; aerogels have less.
        const SOLID: f64 = 100.0;
        /// Smallest modulus, Pa; the softest gels have 1000.
        const SOFTEST: f64 = 1e3;
        let density = solid.material.density();
        let modulus = constants.young();
        let heavy =
            (density > DENSEST).then_some(("material.density", Caution::HeavySolid { density }));
        let soft = (density > SOLID && density <= DENSEST && modulus < SOFTEST)
            .then_some(("material", Caution::SoftSolid { modulus, density }));
        let found = heavy.into_iter().chain(soft);
        found
            .map(|(key, caution)| Remark::new(key, caution))
            .collect()
    }

    /// Warns of keys that have an effect only if bonds break.
    pub(super) fn check_idle_keys(&self, system: &System) -> Vec<ModelWarning> {
        if system.operator().can_break() {
            return Vec::new();
        }
        let Model { body, output, .. } = self.model;
        let solid = body.solid();
        let measures_damage = solid.is_some_and(|solid| solid.material.damage.is_some());
        // Bonds cut by pre-cracks count as damage even if no bond breaks later.
        let uncracked = self.model.cracks.is_empty();
        let cracks = output.cracks;
        let writes_cracks = cracks.schedule != Schedule::Never
            && cracks != CrackOutput::usual(output.history.schedule);
        let idle = [
            ("material.no_fail", !body.no_fail().is_empty()),
            ("material.damage", measures_damage && uncracked),
            ("output.cracks", writes_cracks),
            (
                "output.fragments",
                output.fragments.schedule != Schedule::Never,
            ),
        ];
        let given = idle.into_iter().filter(|(_, idle)| *idle);
        given
            .map(|(key, _)| Remark::new(key, Caution::NothingBreaks { key }))
            .collect()
    }

    /// Warns of heat from dissipated energy in a body that dissipates none.
    pub(super) fn check_dissipation(&self, system: &System) -> Option<ModelWarning> {
        let conduction = self.model.thermal.as_ref()?.conduction.as_ref()?;
        let force = system.operator();
        let moves = self.model.time.scheme != Scheme::Thermal;
        let dissipates = moves && (force.can_break() || force.capabilities().path_dependent);
        (conduction.dissipation > 0.0 && !dissipates)
            .then(|| Remark::new("thermal.dissipation", Caution::NothingDissipates { moves }))
    }

    /// Warns of a run without loads, constraints and initial motion.
    pub(super) fn check_rest(&self, domain: &Domain, state: &State) -> Option<ModelWarning> {
        let at_rest = domain.all(state.u.iter().chain(&state.v).all(|x| *x == 0.0));
        let loaded = self.model.loads.iter().any(|load| {
            let mut components = load.amplitude.components().iter();
            components.any(|entry| entry.number() != Some(0.0))
        });
        let moved = self.model.constraints.iter().any(|motion| {
            let fixed = motion
                .amplitude
                .iter()
                .flatten()
                .all(|entry| entry.number() == Some(0.0));
            !fixed && (motion.moves() || motion.kind == MotionKind::Displacement)
        });
        let struck = !self.model.impactors.is_empty();
        let heated = self.model.thermal.is_some();
        let acts = loaded || moved || struck || heated || !self.model.boundaries.is_empty();
        (at_rest && !acts).then(|| Remark::new("time", Caution::NothingActs))
    }
}
