//! The decks of the studies of this topic.

use pericles_deck::Deck;
use pericles_run::RunError;

/// The paper of the topic.
pub(super) const PAPER: &str = "Coclite et al. 2022";

/// A deck inside the library.
#[derive(Clone, Copy)]
pub(super) struct Preset {
    pub(super) name: &'static str,
    pub(super) file: &'static str,
    pub(super) text: &'static str,
}

pub(super) const STANDARD: Preset = Preset {
    name: "standard",
    file: "standard.toml",
    text: include_str!("../../../../validation/manifolds/standard.toml"),
};

pub(super) const CALIBRATED: Preset = Preset {
    name: "calibrated",
    file: "paper-calibrated.toml",
    text: include_str!("../../../../validation/manifolds/paper-calibrated.toml"),
};

pub(super) const POLES: Preset = Preset {
    name: "poles",
    file: "poles.toml",
    text: include_str!("../../../../validation/manifolds/poles.toml"),
};

impl Preset {
    pub(super) fn deck(&self, changes: &[String]) -> Result<Deck, RunError> {
        Ok(Deck::parse(self.text, self.file, changes)?)
    }
}

/// `key=value`, for a list of changes.
pub(super) fn change(key: &str, value: impl std::fmt::Display) -> String {
    format!("{key}={value}")
}
