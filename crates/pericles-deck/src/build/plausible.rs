//! Whether the values of a deck are physically plausible and have an effect.

use pericles::System;
use pericles::boundary::MotionKind;
use pericles::material::BondConstants;
use pericles::observe::Schedule;
use pericles::time::State;

use crate::caution::Caution;
use crate::conditions::LoadAmplitude;
use crate::deck::Deck;
use crate::finding::Warning;

impl Deck {
    /// Warns of densities and moduli that no solid has. Decks in units of their own (ρ = 1, E = 1) are left alone.
    pub(super) fn judge_solid(&self, constants: &BondConstants) -> Vec<Warning> {
        /// kg/m³. Osmium has 22 600.
        const DENSEST: f64 = 1e5;
        /// kg/m³. Aerogels have less than this.
        const SOLID: f64 = 100.0;
        /// Pa. The softest gels have 1000.
        const SOFTEST: f64 = 1e3;
        let density = self.material.bonds.density;
        let modulus = constants.young;
        let heavy =
            (density > DENSEST).then_some(("material.density", Caution::HeavySolid { density }));
        let soft = (density > SOLID && density <= DENSEST && modulus < SOFTEST)
            .then_some(("material", Caution::SoftSolid { modulus, density }));
        let found = heavy.into_iter().chain(soft);
        found
            .map(|(key, caution)| self.finding(&key.into(), caution))
            .collect()
    }

    /// Warns of keys that only breaking bonds give a meaning.
    pub(super) fn judge_idle_keys(&self, system: &System) -> Vec<Warning> {
        if system.operator().can_break() {
            return Vec::new();
        }
        let output = &self.output;
        // What pre-cracks took is damage, however the bonds behave later.
        let cracked = !self.cracks.is_empty();
        let idle = [
            ("material.no_fail", true),
            ("material.damage", !cracked),
            ("output.cracks", output.cracks.schedule != Schedule::Never),
            (
                "output.fragments",
                output.fragments.schedule != Schedule::Never,
            ),
        ];
        let given = idle
            .into_iter()
            .filter(|(key, idle)| *idle && self.record.is_given(&(*key).into()));
        given
            .map(|(key, _)| self.finding(&key.into(), Caution::NothingBreaks { key }))
            .collect()
    }

    /// Warns of a run in which nothing happens.
    pub(super) fn judge_rest(&self, state: &State) -> Option<Warning> {
        let at_rest = state.u.iter().chain(&state.v).all(|x| *x == 0.0);
        let loaded = self.loads.iter().any(|load| {
            let (LoadAmplitude::BodyForce(field)
            | LoadAmplitude::Traction {
                traction: field, ..
            }) = &load.amplitude;
            field.iter().any(|entry| entry.number() != Some(0.0))
        });
        let moved = self.prescribe.iter().any(|motion| {
            let fixed = motion
                .amplitude
                .iter()
                .flatten()
                .all(|entry| entry.number() == Some(0.0));
            !fixed && (motion.moves() || motion.kind == MotionKind::Displacement)
        });
        let acts = loaded || moved || !self.boundaries.is_empty();
        (at_rest && !acts).then(|| self.finding(&"time".into(), Caution::NothingActs))
    }
}
