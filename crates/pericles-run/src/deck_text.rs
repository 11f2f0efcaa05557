//! A deck as a run keeps it: enough to read it again without its file.

use pericles_deck::Deck;
use serde::{Deserialize, Serialize};

use crate::error::RunError;
use crate::inputs::Inputs;

/// A deck as it was given.
#[derive(Debug, Clone, Serialize, Deserialize, PartialEq)]
pub struct DeckText {
    /// What messages call it.
    pub file: String,
    /// Its text.
    pub source: String,
    /// The overrides, `key=value`.
    pub overrides: Vec<String>,
    /// The files that the deck names.
    #[serde(default, skip_serializing_if = "Inputs::is_empty")]
    pub inputs: Inputs,
}

impl DeckText {
    /// The text of a deck that was read from `file`.
    pub fn of(deck: &Deck, file: String) -> Self {
        Self {
            inputs: Inputs::of(&deck.model, deck.folder()),
            file,
            source: deck.source().to_owned(),
            overrides: deck.overrides().map(str::to_owned).collect(),
        }
    }

    /// Reads the deck again, from whatever folder.
    ///
    /// # Errors
    /// What this version no longer accepts; a file that the deck names and that is no longer what it was.
    pub fn read(&self) -> Result<Deck, RunError> {
        let file = self.inputs.located(&self.file);
        let deck = Deck::parse(&self.source, &file, &self.overrides)?;
        self.inputs.check(deck.folder())?;
        Ok(deck)
    }
}
