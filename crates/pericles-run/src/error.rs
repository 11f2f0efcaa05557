//! Errors of runs and their results.

use std::path::PathBuf;

use pericles::{PericlesError, SimulationError};
use pericles_deck::{BuildError, DeckError};
use pericles_io::{IoError, MeshError};

/// An error that ends a run, or prevents its results from being read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The deck is invalid.
    #[error(transparent)]
    Deck(#[from] DeckError),
    /// A model without a deck is invalid.
    #[error(transparent)]
    Model(#[from] BuildError),
    /// A file cannot be read or written.
    #[error(transparent)]
    Io(#[from] IoError),
    /// The run became unstable, or cannot continue.
    #[error("{source}")]
    Unstable {
        /// The cause.
        source: SimulationError,
        /// The saved state and checkpoints.
        left: String,
    },
    /// A run cannot be extended as requested.
    #[error("the run cannot be extended: {reason}")]
    NotExtended {
        /// Why.
        reason: String,
    },
    /// Any other error of the simulation.
    #[error("{0}")]
    Simulation(#[source] SimulationError),
    /// A checkpoint does not match its deck.
    #[error("the checkpoint {} cannot be used: {reason}", path.display())]
    Checkpoint {
        /// The checkpoint.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// An input file has changed since the run started.
    #[error("the input file {} of the run cannot be used: {reason}", path.display())]
    InputChanged {
        /// The file.
        path: PathBuf,
        /// The change.
        reason: String,
    },
    /// A program added arrays or functions to the deck of the run.
    #[error(
        "the deck of the run does not describe it completely: a program added {amended}; build the model again in that program, and load the checkpoint there"
    )]
    Amended {
        /// What the program added.
        amended: String,
    },
    /// The folder contains no results.
    #[error("{} is not the output folder of a run: {reason}", path.display())]
    NoResults {
        /// The folder.
        path: PathBuf,
        /// Why.
        reason: &'static str,
    },
    /// The folder contains no checkpoints.
    #[error("{} is not the output folder of a run: it has no checkpoints", path.display())]
    NoRun {
        /// The folder.
        path: PathBuf,
    },
    /// An unknown name of a scalar, study, example, field, column or case.
    #[error("there is no {kind} \"{name}\"")]
    Unknown {
        /// The kind of object.
        kind: &'static str,
        /// The name given.
        name: String,
        /// The most similar name, and how to list all names.
        hint: String,
    },
    /// Columns are in tables without common times.
    #[error("the columns {columns} cannot be drawn over each other: {reason}")]
    NoCommonTimes {
        /// The columns and their tables.
        columns: String,
        /// The reason.
        reason: String,
    },
    /// Keys of a deck cannot be fitted to a curve.
    #[error("{reason}")]
    NoFit {
        /// Why, and what is allowed.
        reason: String,
    },
    /// A result file is damaged or was not written by Pericles.
    #[error("{} cannot be used: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A mesh, surface or field file cannot be used.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// An error of the engine outside of a run.
    #[error(transparent)]
    Library(#[from] PericlesError),
    /// The thread pool cannot be started.
    #[error("cannot start the threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A value cannot be represented in JSON.
    #[error("the results cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl RunError {
    /// Creates the error for an unknown name, with the most similar allowed name; `listing` tells how to list all.
    pub fn unknown(
        kind: &'static str,
        name: &str,
        allowed: impl IntoIterator<Item = impl AsRef<str>>,
        listing: &str,
    ) -> Self {
        let (likeness, nearest) = allowed
            .into_iter()
            .map(|word| {
                (
                    strsim::jaro_winkler(name, word.as_ref()),
                    word.as_ref().to_owned(),
                )
            })
            .fold((0.0, String::new()), |a, b| if b.0 > a.0 { b } else { a });
        Self::Unknown {
            kind,
            name: name.to_owned(),
            // Names with a lower similarity are not suggested.
            hint: if likeness > 0.6 {
                format!("did you mean {nearest}? {listing}")
            } else {
                listing.to_owned()
            },
        }
    }

    /// Returns whether another of the processes that share the run has reported the error.
    pub fn is_elsewhere(&self) -> bool {
        let is = |error: &PericlesError| matches!(error, PericlesError::OnAnotherProcess);
        match self {
            Self::Library(error) => is(error),
            Self::Io(IoError::OnAnotherProcess { .. }) => true,
            Self::Simulation(SimulationError::Observe(source)) => {
                source.downcast_ref().is_some_and(is)
            }
            _ => false,
        }
    }

    /// Converts an error of a simulation; for unstable runs `left` describes the saved state and checkpoints.
    pub fn of_run(error: SimulationError, left: impl FnOnce() -> String) -> Self {
        match error {
            SimulationError::Observe(source) => match source.downcast::<IoError>() {
                Ok(error) => Self::Io(*error),
                Err(source) => Self::Simulation(SimulationError::Observe(source)),
            },
            SimulationError::Unstable { .. }
            | SimulationError::Stuck { .. }
            | SimulationError::NoStaticState { .. } => Self::Unstable {
                source: error,
                left: left(),
            },
            other => Self::Simulation(other),
        }
    }
}
