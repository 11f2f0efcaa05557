//! What can go wrong between a deck and its results.

use std::path::PathBuf;

use pericles::{PericlesError, SimulationError};
use pericles_deck::{BuildError, DeckError};
use pericles_io::{IoError, MeshError};

/// Everything that ends a run early, or keeps its results from being read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The deck is refused.
    #[error(transparent)]
    Deck(#[from] DeckError),
    /// A model without a deck is refused.
    #[error(transparent)]
    Model(#[from] BuildError),
    /// A file is to blame.
    #[error(transparent)]
    Io(#[from] IoError),
    /// The run became unstable, or found no way on.
    #[error("{source}")]
    Unstable {
        /// What happened.
        source: SimulationError,
        /// What is left of the run.
        left: String,
    },
    /// Anything else that keeps a run from going on.
    #[error("{0}")]
    Simulation(#[source] SimulationError),
    /// A checkpoint that does not go with its deck.
    #[error("the checkpoint {} cannot be used: {reason}", path.display())]
    Checkpoint {
        /// The checkpoint.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A file that the deck names is not what it was when the run began.
    #[error("{} is read by the run: {reason}", path.display())]
    InputChanged {
        /// The file.
        path: PathBuf,
        /// What has happened to it.
        reason: String,
    },
    /// There are no results.
    #[error("{} is no output folder of a run: {reason}", path.display())]
    NoResults {
        /// The folder.
        path: PathBuf,
        /// What it lacks.
        reason: &'static str,
    },
    /// There is nothing to resume.
    #[error("{} is no output folder of a run: it has no checkpoints", path.display())]
    NoRun {
        /// The folder.
        path: PathBuf,
    },
    /// A name that nothing has: of a number, a study, an example.
    #[error("there is no {kind} \"{name}\"")]
    Unknown {
        /// What it should name.
        kind: &'static str,
        /// The name given.
        name: String,
        /// The nearest name, and where to find the others.
        hint: String,
    },
    /// A file of results that is not what Pericles writes.
    #[error("{} cannot be used: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A file that gives no surface, or no fields.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A step of the library outside of a run.
    #[error(transparent)]
    Library(#[from] PericlesError),
    /// The system refuses threads.
    #[error("the threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A value that has no JSON.
    #[error("the results cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl RunError {
    /// A name that is none of the allowed ones; `listing` says where all of them are shown.
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
            // Below this the two have little in common.
            hint: if likeness > 0.6 {
                format!("did you mean {nearest}? {listing}")
            } else {
                listing.to_owned()
            },
        }
    }

    /// Sorts the failure of a simulation; `left` tells what is left of the run if it came to no end of its own.
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
