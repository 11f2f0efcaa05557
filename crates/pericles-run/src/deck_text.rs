//! The deck as stored with a run, sufficient to read it again without its file.

use pericles_deck::{Deck, DeckError};
use serde::{Deserialize, Serialize};

use crate::error::RunError;
use crate::inputs::Inputs;

/// The text of a deck with its overrides.
#[derive(Debug, Clone, Serialize, Deserialize, PartialEq)]
pub struct DeckText {
    /// The file name for messages.
    pub file: String,
    /// The text.
    pub source: String,
    /// The overrides, `key=value`.
    pub overrides: Vec<String>,
    /// The step that is run, numbered from zero, of a deck with `[[step]]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step: Option<usize>,
    /// The input files of the deck.
    #[serde(default, skip_serializing_if = "Inputs::is_empty")]
    pub inputs: Inputs,
    /// What a program added to the deck: arrays and functions, which have no text. Such a run can be continued only by
    /// that program.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub amended: Vec<String>,
}

impl DeckText {
    /// Returns the text of a deck that was read from `file`.
    pub fn of(deck: &Deck, file: String) -> Self {
        Self {
            inputs: Inputs::of(&deck.model, deck.folder()),
            file,
            source: deck.source().to_owned(),
            overrides: deck.overrides().map(str::to_owned).collect(),
            step: None,
            amended: Vec::new(),
        }
    }

    /// Returns the steps of the deck with their names; none for a deck without `[[step]]`.
    ///
    /// # Errors
    /// Those of [`DeckText::read`].
    pub fn steps(&self) -> Result<Vec<(String, Self)>, RunError> {
        let names = self.read()?.steps().to_vec();
        let step = |(number, name): (usize, String)| {
            let mut text = Self {
                step: Some(number),
                ..self.clone()
            };
            let deck = text.parsed()?;
            text.inputs = Inputs::of(&deck.model, deck.folder());
            Ok((name, text))
        };
        names.into_iter().enumerate().map(step).collect()
    }

    /// Reads the deck again, independent of the current folder.
    ///
    /// # Errors
    /// The deck is rejected, an input file has changed, or a program added conditions that the deck does not contain.
    pub fn read(&self) -> Result<Deck, RunError> {
        if !self.amended.is_empty() {
            return Err(RunError::Amended {
                amended: self.amended.join(", "),
            });
        }
        let deck = self.parsed()?;
        self.inputs.check(deck.folder())?;
        Ok(deck)
    }

    fn parsed(&self) -> Result<Deck, DeckError> {
        let file = self.inputs.located(&self.file);
        match self.step {
            Some(step) => Deck::parse_step(&self.source, &file, &self.overrides, &[], step),
            None => Deck::parse(&self.source, &file, &self.overrides),
        }
    }
}
