//! What a run is made of, a deck or a model alone, and what its folder keeps of it.

use std::path::Path;

use pericles_deck::{BuildError, Deck, Model};
use serde::{Deserialize, Serialize};

use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::inputs::Inputs;

/// What a run is made of.
#[derive(Debug, Clone)]
pub enum Source {
    /// A deck. Messages point into its text.
    Deck {
        /// The deck.
        deck: Box<Deck>,
        /// Its text.
        text: DeckText,
    },
    /// A model that a program made or read. Messages name its keys.
    Model(Box<ModelData>),
}

/// A model without a deck, with the digests of the files that it names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModelData {
    /// The model.
    pub model: Model,
    /// The files that it names.
    #[serde(default, skip_serializing_if = "Inputs::is_empty")]
    pub inputs: Inputs,
}

/// The part of a [`Source`] that `run.json` and checkpoints hold: enough to make the same run again.
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
    /// A deck that was read from `file`.
    pub fn of_deck(deck: Deck, file: String) -> Self {
        Self::Deck {
            text: DeckText::of(&deck, file),
            deck: Box::new(deck),
        }
    }

    /// A model alone; relative paths of its files start at `folder`.
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

    /// The model.
    pub fn model(&self) -> &Model {
        match self {
            Self::Deck { deck, .. } => &deck.model,
            Self::Model(data) => &data.model,
        }
    }

    /// The folder at which relative paths of the model start; empty for the present folder.
    pub fn folder(&self) -> &Path {
        match self {
            Self::Deck { deck, .. } => deck.folder(),
            Self::Model(data) => data.inputs.folder(),
        }
    }

    /// The refusal of the model: it points into the text of a deck, and names the keys of a model alone.
    pub fn refusal(&self, error: BuildError) -> RunError {
        match self {
            Self::Deck { deck, .. } => deck.refusal(error).into(),
            Self::Model(_) => error.into(),
        }
    }

    /// What `run.json` and checkpoints hold of it.
    pub fn record(&self) -> SourceRecord {
        match self {
            Self::Deck { text, .. } => SourceRecord::Deck(text.clone()),
            Self::Model(data) => SourceRecord::Model(data.clone()),
        }
    }
}

impl SourceRecord {
    /// Makes the source again, from whatever folder.
    ///
    /// # Errors
    /// A deck that this version no longer accepts; a file that the source names and that has changed or no longer exists.
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

    /// The files that the source names, with their digests.
    pub(crate) fn inputs(&self) -> &Inputs {
        match self {
            Self::Deck(text) => &text.inputs,
            Self::Model(data) => &data.inputs,
        }
    }
}
