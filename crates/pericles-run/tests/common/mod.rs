//! Assembly of decks with located warnings.
#![allow(dead_code)] // each test uses its part

pub mod processes;

use std::ops::Deref;

use pericles::Simulation;
use pericles::material::BondConstants;
use pericles_deck::{Deck, DeckError, Warning};
use pericles_run::{Assembly, Resources, build};

/// An assembled deck.
pub struct Built {
    pub assembly: Assembly,
    pub warnings: Vec<Warning>,
}

impl Deref for Built {
    type Target = Assembly;

    fn deref(&self) -> &Assembly {
        &self.assembly
    }
}

impl Built {
    /// Returns the constants of the bonds.
    pub fn constants(&self) -> &BondConstants {
        self.assembly.constants.as_ref().unwrap().bonds().unwrap()
    }

    /// Returns the simulation without observers.
    pub fn simulation(self) -> Simulation {
        self.assembly.simulation().unwrap()
    }
}

/// Assembly of a deck in tests.
pub trait Build {
    /// Assembles the deck without cache and files.
    fn build(&self) -> Result<Built, DeckError> {
        self.build_with(Resources::default())
    }

    /// Assembles the deck.
    fn build_with(&self, resources: Resources<'_>) -> Result<Built, DeckError>;

    /// Returns the warnings about its waves.
    fn check_waves(&self, assembly: &Assembly) -> Vec<Warning>;
}

impl Build for Deck {
    fn build_with(&self, resources: Resources<'_>) -> Result<Built, DeckError> {
        let assembly = build(self, &resources)?;
        let located = |warning: &_| self.located(Clone::clone(warning));
        Ok(Built {
            warnings: assembly.warnings.iter().map(located).collect(),
            assembly,
        })
    }

    fn check_waves(&self, assembly: &Assembly) -> Vec<Warning> {
        let warnings = assembly.check_waves(&self.model).into_iter();
        warnings.map(|warning| self.located(warning)).collect()
    }
}
