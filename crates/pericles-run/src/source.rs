//! The source of a run, a deck or a model, and its record in the output folder.

use std::path::Path;

use pericles_deck::{BuildError, Deck, Model};
use serde::{Deserialize, Serialize};

use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::inputs::Inputs;

/// The source of a run.
#[derive(Debug, Clone)]
pub enum Source {
    /// A deck; messages refer to locations in its text.
    Deck {
        /// The deck.
        deck: Box<Deck>,
        /// Its text.
        text: DeckText,
    },
    /// A model built or read by a program; messages name its keys.
    Model(Box<ModelData>),
}

/// A model without a deck, with the digests of its input files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModelData {
    /// The model.
    pub model: Model,
    /// Its input files.
    #[serde(default, skip_serializing_if = "Inputs::is_empty")]
    pub inputs: Inputs,
}

/// The record of a [`Source`] in `run.json` and checkpoints, sufficient to build the same run again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum SourceRecord {
    /// The text of a deck.
    #[serde(rename = "deck")]
    Deck(DeckText),
    /// A model.
    #[serde(rename = "model_data")]
    Model(Box<ModelData>),
}

impl Source {
    /// Creates the source from a deck that was read from `file`.
    pub fn of_deck(deck: Deck, file: String) -> Self {
        Self::Deck {
            text: DeckText::of(&deck, file),
            deck: Box::new(deck),
        }
    }

    /// Creates the source from a model; paths of its input files are relative to `folder`.
    ///
    /// ```
    /// use std::path::Path;
    /// use pericles_deck::Model;
    /// use pericles_run::Source;
    ///
    /// # let deck = pericles_deck::Deck::parse(
    /// #     "body = { shape = \"bar\", length = 1, spacing = 0.1 }\nmaterial = { density = 1, youngs_modulus = 1, horizon_ratio = 3 }\ntime = { end = 1 }",
    /// #     "bar.toml", &[],
    /// # )?;
    /// # let text = serde_json::to_string(&deck.model)?;
    /// let mut model: Model = serde_json::from_str(&text)?;
    /// model.time.end = 2e-3;
    /// let source = Source::of_model(model, Path::new("."));
    /// assert_eq!(source.model().time.end, 2e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_model(model: Model, folder: &Path) -> Self {
        Self::Model(Box::new(ModelData {
            inputs: Inputs::of(&model, folder),
            model,
        }))
    }

    /// Returns the model.
    pub fn model(&self) -> &Model {
        match self {
            Self::Deck { deck, .. } => &deck.model,
            Self::Model(data) => &data.model,
        }
    }

    /// Returns the base folder of relative paths; empty for the current folder.
    pub fn folder(&self) -> &Path {
        match self {
            Self::Deck { deck, .. } => deck.folder(),
            Self::Model(data) => data.inputs.folder(),
        }
    }

    /// Converts an error of the model: for a deck it has the location in the text, for a model the keys.
    pub fn rejection(&self, error: BuildError) -> RunError {
        match self {
            Self::Deck { deck, .. } => deck.rejection(error).into(),
            Self::Model(_) => error.into(),
        }
    }

    /// Returns the record for `run.json` and checkpoints.
    pub fn record(&self) -> SourceRecord {
        match self {
            Self::Deck { text, .. } => SourceRecord::Deck(text.clone()),
            Self::Model(data) => SourceRecord::Model(data.clone()),
        }
    }
}

impl SourceRecord {
    /// Restores the source, independent of the current folder.
    ///
    /// # Errors
    /// The deck is rejected, or an input file is missing or has changed.
    pub fn read(self) -> Result<Source, RunError> {
        match self {
            Self::Deck(text) => Ok(Source::Deck {
                deck: Box::new(text.read()?),
                text,
            }),
            Self::Model(data) => {
                data.inputs.check(data.inputs.folder())?;
                Ok(Source::Model(data))
            }
        }
    }
}
