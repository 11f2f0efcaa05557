//! What can go wrong on the way from the command line to the results, and how it is reported.

use std::io::IsTerminal;
use std::path::PathBuf;

use miette::Diagnostic;
use pericles::{PericlesError, SimulationError};
use pericles_deck::DeckError;
use pericles_io::{IoError, MeshError};
use pericles_manifold::surface::SurfaceError;

use crate::console;
use crate::drawn::Drawn;
use crate::exit::Exit;

/// Everything that ends a command early.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[non_exhaustive]
pub(crate) enum CliError {
    /// The deck is refused.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Deck(#[from] DeckError),
    /// There is no deck to read.
    #[error("cannot read the deck {}: {reason}", path.display())]
    NoDeck {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
        /// What may have been meant.
        #[help]
        hint: Option<String>,
    },
    /// A file is to blame.
    #[error(transparent)]
    Io(#[from] IoError),
    /// The output folder is taken.
    #[error("{} exists already", path.display())]
    OutExists {
        /// The folder.
        path: PathBuf,
        /// What to do.
        #[help]
        help: &'static str,
    },
    /// The run became unstable, or found no way on.
    #[error("{source}")]
    Unstable {
        /// What happened.
        source: SimulationError,
        /// What is left of the run.
        #[help]
        left: String,
    },
    /// Anything else that keeps a run from going on.
    #[error("{0}")]
    Simulation(#[source] SimulationError),
    /// A checkpoint that does not go with its deck.
    #[error("the checkpoint {} cannot be used: {reason}", path.display())]
    #[diagnostic(help(
        "the folder may have been changed since the run stopped; run the deck again"
    ))]
    Checkpoint {
        /// The checkpoint.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A file that the deck names is not what it was when the run began.
    #[error("{} is read by the run: {reason}", path.display())]
    #[diagnostic(help("put the file back as it was, or start a new run"))]
    InputChanged {
        /// The file.
        path: PathBuf,
        /// What has happened to it.
        reason: String,
    },
    /// There are no results.
    #[error("{} is no output folder of a run: {reason}", path.display())]
    #[diagnostic(help("give the folder that `pericles run` made, such as ./branching"))]
    NoResults {
        /// The folder.
        path: PathBuf,
        /// What it lacks.
        reason: &'static str,
    },
    /// There is nothing to resume.
    #[error("{} is no output folder of a run: it has no checkpoints", path.display())]
    #[diagnostic(help("give the folder that `pericles run` made, such as ./branching"))]
    NoRun {
        /// The folder.
        path: PathBuf,
    },
    /// A name that nothing has: of a case, a study, an example.
    #[error("there is no {kind} \"{name}\"")]
    Unknown {
        /// What it should name.
        kind: &'static str,
        /// The name given.
        name: String,
        /// The nearest name, and where to find the others.
        #[help]
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
    /// A file that would be replaced.
    #[error("{} exists already", path.display())]
    #[diagnostic(help("give another name, or move the file away"))]
    FileExists {
        /// The file.
        path: PathBuf,
    },
    /// A file that gives no surface.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A surface that cannot be used.
    #[error("{name}: {source}")]
    Surface {
        /// The file or shape.
        name: String,
        /// Why.
        source: SurfaceError,
    },
    /// A spectrum of a lattice whose waves grow.
    #[error(
        "the spectrum cannot be measured: the kernel is unstable on this grid, some waves grow"
    )]
    #[diagnostic(help("leave --measure out, or use a stable kernel"))]
    UnstableSpectrum,
    /// A vector with more components than the body has dimensions.
    #[error("{option} has {given} components; the body has {dimension} dimension(s)")]
    #[diagnostic(help("give one component for each dimension of the body"))]
    Components {
        /// The option.
        option: &'static str,
        /// Components given.
        given: usize,
        /// Of the body.
        dimension: usize,
    },
    /// A word that is neither a shape nor a file.
    #[error("\"{given}\" is no shape")]
    UnknownShape {
        /// The word.
        given: String,
        /// What is allowed.
        #[help]
        allowed: &'static str,
    },
    /// A vertex that a surface does not have.
    #[error("the surface has no vertex {number}; its {vertices} vertices are numbered from 0 to {}", vertices.saturating_sub(1))]
    NoVertex {
        /// The number given.
        number: usize,
        /// How many there are.
        vertices: usize,
    },
    /// A step of the library outside of a run.
    #[error(transparent)]
    Library(#[from] PericlesError),
    /// The system refuses threads.
    #[error("the threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The system refuses signal handlers.
    #[error("Ctrl-C and SIGTERM cannot be watched: {0}")]
    Signals(#[source] std::io::Error),
    /// A value that has no JSON.
    #[error("the results cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl CliError {
    /// A name that is none of the allowed ones; `listing` says where all of them are shown.
    pub(crate) fn unknown(
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

    /// Sorts the failure of a run; `left` tells what is left if it came to no end of its own.
    pub(crate) fn of_run(error: SimulationError, left: impl FnOnce() -> String) -> Self {
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

    /// The exit status it leads to.
    pub(crate) fn exit(&self) -> Exit {
        match self {
            Self::Deck(error) if error.is_too_large() => Exit::Memory,
            Self::Io(IoError::TooLarge { .. })
            | Self::Mesh(MeshError::Io(IoError::TooLarge { .. })) => Exit::Memory,
            Self::Deck(_)
            | Self::NoDeck { .. }
            | Self::Checkpoint { .. }
            | Self::InputChanged { .. }
            | Self::NoRun { .. }
            | Self::NoResults { .. }
            | Self::UnstableSpectrum
            | Self::Library(_) => Exit::Input,
            Self::Mesh(_) | Self::Surface { .. } | Self::Damaged { .. } => Exit::Input,
            Self::UnknownShape { .. } | Self::NoVertex { .. } | Self::Components { .. } => {
                Exit::Usage
            }
            Self::Io(error) if error.is_output_problem() => Exit::Output,
            Self::Io(IoError::Shape { .. } | IoError::Unsuitable { .. }) => Exit::Internal,
            Self::Io(_) => Exit::Input,
            Self::OutExists { .. } | Self::FileExists { .. } => Exit::Output,
            Self::Unstable { .. } => Exit::Numerical,
            Self::Simulation(SimulationError::Misfit(_)) => Exit::Input,
            Self::Unknown { .. } => Exit::Usage,
            Self::Simulation(_) | Self::Threads(_) | Self::Signals(_) | Self::Json(_) => {
                Exit::Internal
            }
        }
    }

    /// Reports on the standard error: with the places in the deck marked on a terminal, in plain lines otherwise.
    pub(crate) fn report(&self) {
        if std::io::stderr().is_terminal() {
            return match self {
                // One by one: the error as a whole would list them all a second time.
                Self::Deck(error) if !error.problems().is_empty() => {
                    /// Lines that are longer fill the screen.
                    const LONGEST: usize = 500;
                    for problem in error.problems().iter().take(DeckError::SHOWN) {
                        if problem.location().line_length() > LONGEST {
                            console::note(format_args!("error: {}", problem.line()));
                        } else {
                            console::note_in_colour(format_args!("{}", Drawn(problem)));
                        }
                    }
                    let left = error.problems().len().saturating_sub(DeckError::SHOWN);
                    if left > 0 {
                        console::note(format_args!("and {left} more problems"));
                    }
                }
                other => console::note_in_colour(format_args!("{}", Drawn(other))),
            };
        }
        console::note(format_args!("error: {self}"));
        // The plain text of a refused deck says what is allowed itself.
        if let (Some(help), false) = (self.help(), matches!(self, Self::Deck(_))) {
            console::note(format_args!("help: {help}"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io;
    use std::path::Path;

    #[test]
    fn exit_statuses_tell_whose_fault_it_is() {
        let path = || PathBuf::from("out");
        let io = |kind| IoError::writing(Path::new("out/a.csv"), io::Error::from(kind));
        let observed = |error: IoError| {
            CliError::of_run(SimulationError::Observe(Box::new(error)), String::new)
        };
        let unstable = SimulationError::Unstable {
            step: 20,
            t: 1e-6,
            cause: pericles::Cause::NotANumber,
            point: 0,
            place: [0.0; 3],
            speed: f64::INFINITY,
        };
        let cases = [
            (CliError::from(io(io::ErrorKind::StorageFull)), 6),
            (observed(io(io::ErrorKind::StorageFull)), 6),
            (observed(IoError::Locked { path: path() }), 6),
            (
                CliError::OutExists {
                    path: path(),
                    help: "",
                },
                6,
            ),
            (CliError::NoRun { path: path() }, 3),
            (CliError::from(IoError::NotFound { path: path() }), 3),
            (CliError::of_run(unstable, || "left".into()), 4),
            (
                CliError::of_run(SimulationError::Observe("odd".into()), String::new),
                1,
            ),
        ];
        for (error, status) in cases {
            assert_eq!(error.exit().status(), status, "{error}");
        }
    }
}
