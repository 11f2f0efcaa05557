//! Properties of a run before its first step, for reports, `check` and `run.json`.
//!
//! A property is added to the list of [`Facts`] by one function of a module of this folder, with its key, unit, value and printed
//! line. Nothing else changes for a new one.

mod body;
mod conditions;
mod details;
mod list;
mod material;
mod surface;
mod time;
mod waves;

use pericles_deck::{Body, Deck, Model, ModelWarning};

use crate::build::Assembly;

pub use list::{Fact, Facts, Line, Section};

impl Facts {
    /// Returns the properties of an assembled model. Warnings name their keys. All processes that share the body must call it
    /// together.
    pub fn of(model: &Model, assembly: &Assembly) -> Self {
        let waves = assembly.check_waves(model);
        let warnings = assembly.warnings.iter().chain(&waves);
        Self::with(model, assembly, warnings.map(ModelWarning::line).collect())
    }

    /// Returns the properties of the assembly of a deck, with locations of warnings.
    pub fn of_deck(deck: &Deck, assembly: &Assembly) -> Self {
        let waves = assembly.check_waves(&deck.model);
        let warnings = assembly.warnings.iter().chain(&waves);
        let located = |warning: &ModelWarning| deck.located(warning.clone()).line();
        Self::with(&deck.model, assembly, warnings.map(located).collect())
    }

    fn with(model: &Model, assembly: &Assembly, warnings: Vec<String>) -> Self {
        let model = assembly.with_means(model);
        let mut facts = Self::default();
        facts.body(model, assembly);
        match &model.body {
            Body::Solid(solid) => facts.solid(solid, model, assembly),
            Body::Surface(surface) => facts.surface(surface),
        }
        facts.properties(assembly);
        facts.time(model, assembly);
        facts.device(assembly);
        facts.loads(assembly);
        facts.heat(assembly);
        facts.activation(assembly);
        facts.contact(model, assembly);
        facts.boundaries(assembly);
        facts.warnings = warnings;
        facts
    }

    /// Adds the properties that only `check` reports, because they need loops over all bonds or elements: meshes, neighbours,
    /// plane waves, probes.
    pub fn add_details(&mut self, model: &Model, assembly: &Assembly) {
        self.meshes(assembly);
        self.neighbours(assembly);
        self.plane_waves(model, assembly);
        self.probes(assembly);
    }
}
