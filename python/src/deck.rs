//! Decks.

use pericles_run::{DeckText, Source};
use pyo3::prelude::*;

use crate::errors;

/// A deck that was read.
#[pyclass(frozen, module = "pericles._pericles")]
pub struct Deck {
    pub source: Source,
}

impl Deck {
    /// The text of the deck.
    pub fn text(&self) -> &DeckText {
        match &self.source {
            Source::Deck { text, .. } => text,
            Source::Model(_) => unreachable!("made from a deck"),
        }
    }

    /// The deck of the source.
    pub fn deck(&self) -> &pericles_deck::Deck {
        match &self.source {
            Source::Deck { deck, .. } => deck,
            Source::Model(_) => unreachable!("made from a deck"),
        }
    }
}

#[pymethods]
impl Deck {
    /// Parses a text; `name` is the file that messages name, `sets` are sets that arrays will define.
    #[staticmethod]
    #[pyo3(signature = (text, name, overrides, sets))]
    fn parse(text: &str, name: &str, overrides: Vec<String>, sets: Vec<String>) -> PyResult<Self> {
        let deck = pericles_deck::Deck::parse_with_sets(text, name, &overrides, &sets);
        let deck = deck.map_err(errors::of_deck)?;
        Ok(Self {
            source: Source::of_deck(deck, name.to_owned()),
        })
    }

    /// Names of the steps of a deck with several runs.
    fn steps(&self) -> Vec<String> {
        self.deck().steps().to_vec()
    }

    /// All values in SI units with defaults, as JSON.
    fn values(&self) -> String {
        self.deck().to_json().to_string()
    }

    /// The title.
    #[getter]
    fn title(&self) -> Option<String> {
        self.deck().model.title.clone()
    }
}

/// A time of a text with a unit as in decks, s.
#[pyfunction]
pub fn seconds(text: &str) -> Option<f64> {
    pericles_deck::seconds(text)
}

/// A text with a unit as in decks, such as "2 mm", in an SI unit such as "m"; None for other texts and units of other quantities.
#[pyfunction]
pub fn in_unit(text: &str, unit: &str) -> Option<f64> {
    pericles_deck::in_unit(text, unit)
}

/// Whether a text is a number with a unit, not an expression.
#[pyfunction]
pub fn is_quantity(text: &str) -> bool {
    pericles_deck::is_quantity(text)
}
