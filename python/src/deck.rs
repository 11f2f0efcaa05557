//! Decks.

use pericles_run::Source;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors;

/// A deck that was read.
#[pyclass(frozen, module = "pericles._pericles")]
pub struct Deck {
    pub source: Source,
}

impl Deck {
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
        if !deck.steps().is_empty() {
            return Err(PyValueError::new_err(format!(
                "{name}: a deck with [[step]] has several runs; run it with `pericles run {name}` and open its results"
            )));
        }
        Ok(Self {
            source: Source::of_deck(deck, name.to_owned()),
        })
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
