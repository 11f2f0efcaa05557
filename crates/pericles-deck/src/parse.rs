//! Reads decks from files and texts.

use std::path::Path;

use crate::deck::{Deck, Document};
use crate::error::DeckError;
use crate::reader::Ledger;
use crate::schema::home_of;

impl Deck {
    /// Reads a deck from a file and applies overrides `key=value` in order.
    ///
    /// # Errors
    /// The file cannot be read, or has errors; all errors are reported.
    pub fn read(path: impl AsRef<Path>, overrides: &[String]) -> Result<Self, DeckError> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path).map_err(|reason| DeckError::Unreadable {
            path: path.into(),
            reason,
        })?;
        Self::parse(&text, &path.display().to_string(), overrides)
    }

    /// Reads a deck from a text; `file_name` is used in messages. All steps of a deck with `[[step]]` are read, and the
    /// first one is returned; [`Deck::parse_step`] returns others.
    ///
    /// # Errors
    /// The text has errors; all errors are reported.
    pub fn parse(text: &str, file_name: &str, overrides: &[String]) -> Result<Self, DeckError> {
        Self::parse_with_sets(text, file_name, overrides, &[])
    }

    /// Parses a deck of a program that adds sets of points to those of the deck, so that loads, constraints and
    /// assignments of the deck may name them. Assembly rejects names without points.
    ///
    /// ```
    /// use pericles_deck::Deck;
    ///
    /// let text = r#"
    ///     body = { shape = "bar", length = "1 m", spacing = "1 cm" }
    ///     material = { density = 7850, youngs_modulus = "210 GPa", horizon_ratio = 3 }
    ///     initial = [{ set = "struck", velocity = "1 m/s" }]
    ///     time = { end = "1 ms" }
    /// "#;
    /// assert!(Deck::parse(text, "bar.toml", &[]).is_err());
    /// let deck = Deck::parse_with_sets(text, "bar.toml", &[], &["struck".into()])?;
    /// assert_eq!(deck.model.initial[0].set, "struck");
    /// # Ok::<(), pericles_deck::DeckError>(())
    /// ```
    ///
    /// # Errors
    /// The text has errors; all errors are reported.
    pub fn parse_with_sets(
        text: &str,
        file_name: &str,
        overrides: &[String],
        sets: &[String],
    ) -> Result<Self, DeckError> {
        let deck = Self::parse_step(text, file_name, overrides, sets, 0)?;
        for number in 1..deck.steps.len() {
            Self::parse_step(text, file_name, overrides, sets, number)?;
        }
        Ok(deck)
    }

    /// Reads a step of a deck, numbered from zero, as a deck of its own; a deck without steps is its first step.
    ///
    /// # Errors
    /// The text has errors in this step; all errors are reported.
    pub fn parse_step(
        text: &str,
        file_name: &str,
        overrides: &[String],
        sets: &[String],
        number: usize,
    ) -> Result<Self, DeckError> {
        let document = Document::of_step(text, file_name, overrides, number)?;
        let ledger = Ledger::new(document.sources, home_of);
        let (mut deck, _) = Self::read_with(ledger, &document.root, sets)?;
        deck.steps = document.steps;
        deck.reject_unstable_table()?;
        Ok(deck)
    }
}
