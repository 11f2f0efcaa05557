//! What can go wrong on the way from the command line to the results, and how it is reported.

use std::borrow::Borrow;
use std::fmt::{self, Display, Formatter};
use std::io::IsTerminal;
use std::path::PathBuf;

use miette::{Diagnostic, LabeledSpan, SourceCode};
use pericles::{PericlesError, SimulationError};
use pericles_deck::DeckError;
use pericles_io::{IoError, MeshError};
use pericles_manifold::surface::SurfaceError;
use pericles_run::RunError;

use crate::console;
use crate::drawn::Drawn;
use crate::exit::Exit;

/// Everything that ends a command early.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[non_exhaustive]
pub(crate) enum CliError {
    /// A run cannot begin or go on, or its results cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Run(OfRun<RunError>),
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
    /// The output folder is taken.
    #[error("{} exists already", path.display())]
    OutExists {
        /// The folder.
        path: PathBuf,
        /// What to do.
        #[help]
        help: &'static str,
    },
    /// A file that would be replaced.
    #[error("{} exists already", path.display())]
    #[diagnostic(help("give another name, or move the file away"))]
    FileExists {
        /// The file.
        path: PathBuf,
    },
    /// A surface that cannot be used.
    #[error("{name}: {source}")]
    Surface {
        /// The file or shape.
        name: String,
        /// Why.
        source: SurfaceError,
    },
    /// A mesh that gives no points.
    #[error("{}: {problem}", file.display())]
    Mesh {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// A run without fields.
    #[error("{} holds no field files", folder.display())]
    #[diagnostic(help("the deck wrote none: see [output] fields"))]
    NoFields {
        /// The folder of the run.
        folder: PathBuf,
    },
    /// A spectrum of a lattice whose waves grow.
    #[error(
        "the spectrum cannot be measured: the kernel is unstable on this grid, some waves grow"
    )]
    #[diagnostic(help("leave --measure out, or use a stable kernel"))]
    UnstableSpectrum,
    /// A prestress that is not static.
    #[error("--prestress needs a static run; the scheme of the deck is \"{scheme}\"")]
    #[diagnostic(help("use time.scheme = \"static\", or leave --prestress out"))]
    NotStatic {
        /// The scheme of the deck.
        scheme: &'static str,
    },
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
    /// The system refuses signal handlers.
    #[error("Ctrl-C and SIGTERM cannot be watched: {0}")]
    Signals(#[source] std::io::Error),
}

impl CliError {
    /// The exit status it leads to.
    pub(crate) fn exit(&self) -> Exit {
        match self {
            Self::Run(OfRun(error)) => exit_of(error),
            Self::NoDeck { .. }
            | Self::UnstableSpectrum
            | Self::NotStatic { .. }
            | Self::Surface { .. }
            | Self::Mesh { .. }
            | Self::NoFields { .. } => Exit::Input,
            Self::UnknownShape { .. } | Self::NoVertex { .. } | Self::Components { .. } => {
                Exit::Usage
            }
            Self::OutExists { .. } | Self::FileExists { .. } => Exit::Output,
            Self::Signals(_) => Exit::Internal,
        }
    }

    /// Reports on the standard error.
    pub(crate) fn report(&self) {
        match self {
            Self::Run(OfRun(error)) => report(error),
            other => report_diagnostic(other),
        }
    }
}

/// The exit status that an error of a run leads to.
pub(crate) fn exit_of(error: &RunError) -> Exit {
    match error {
        RunError::Deck(error) if error.is_too_large() => Exit::Memory,
        RunError::Io(IoError::TooLarge { .. })
        | RunError::Mesh(MeshError::Io(IoError::TooLarge { .. })) => Exit::Memory,
        RunError::Model(error) if error.is_too_large() => Exit::Memory,
        RunError::Deck(_)
        | RunError::Model(_)
        | RunError::Checkpoint { .. }
        | RunError::InputChanged { .. }
        | RunError::NoRun { .. }
        | RunError::NoResults { .. }
        | RunError::Mesh(_)
        | RunError::Damaged { .. }
        | RunError::Library(_) => Exit::Input,
        RunError::Io(error) if error.is_output_problem() => Exit::Output,
        RunError::Io(IoError::Shape { .. } | IoError::Unsuitable { .. }) => Exit::Internal,
        RunError::Io(_) => Exit::Input,
        RunError::Unstable { .. } => Exit::Numerical,
        RunError::Simulation(SimulationError::Misfit(_)) => Exit::Input,
        RunError::Unknown { .. } => Exit::Usage,
        // Those left are the simulation's own faults, threads and JSON.
        _ => Exit::Internal,
    }
}

/// Reports an error of a run on the standard error: with the places in the deck marked on a terminal, in plain lines otherwise.
pub(crate) fn report(error: &RunError) {
    match error {
        // One by one: the error as a whole would list them all a second time.
        RunError::Deck(error)
            if !error.problems().is_empty() && std::io::stderr().is_terminal() =>
        {
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
        other => report_diagnostic(&OfRun(other)),
    }
}

fn report_diagnostic(error: &dyn Diagnostic) {
    if std::io::stderr().is_terminal() {
        console::note_in_colour(format_args!("{}", Drawn(error)));
        return;
    }
    console::note(format_args!("error: {error}"));
    if let Some(help) = error.help() {
        console::note(format_args!("help: {help}"));
    }
}

/// An error of a run, owned or borrowed, with what the program advises.
#[derive(Debug)]
pub(crate) struct OfRun<E>(E);

impl<E: Borrow<RunError>> Display for OfRun<E> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Display::fmt(self.0.borrow(), f)
    }
}

impl<E: Borrow<RunError> + fmt::Debug> std::error::Error for OfRun<E> {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.0.borrow().source()
    }
}

impl<E: Borrow<RunError> + fmt::Debug> Diagnostic for OfRun<E> {
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(match self.0.borrow() {
            RunError::Unstable { left, .. } => Box::new(left),
            RunError::Unknown { hint, .. } => Box::new(hint),
            RunError::Checkpoint { .. } => Box::new(
                "the folder may have been changed since the run stopped; run the deck again",
            ),
            RunError::InputChanged { .. } => {
                Box::new("put the file back as it was, or start a new run")
            }
            RunError::NoResults { .. } | RunError::NoRun { .. } => {
                Box::new("give the folder that `pericles run` made, such as ./branching")
            }
            _ => return None,
        })
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        match self.0.borrow() {
            RunError::Deck(error) => error.labels(),
            _ => None,
        }
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        match self.0.borrow() {
            RunError::Deck(error) => error.source_code(),
            _ => None,
        }
    }
}

/// Errors that are those of a run wherever they happen.
macro_rules! of_run {
    ($($error:ty),*) => {$(
        impl From<$error> for CliError {
            fn from(error: $error) -> Self {
                Self::Run(OfRun(error.into()))
            }
        }
    )*};
}

of_run!(
    RunError,
    DeckError,
    IoError,
    MeshError,
    PericlesError,
    serde_json::Error
);

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
            CliError::from(RunError::of_run(
                SimulationError::Observe(Box::new(error)),
                String::new,
            ))
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
            (RunError::NoRun { path: path() }.into(), 3),
            (CliError::from(IoError::NotFound { path: path() }), 3),
            (RunError::of_run(unstable, || "left".into()).into(), 4),
            (
                RunError::of_run(SimulationError::Observe("odd".into()), String::new).into(),
                1,
            ),
        ];
        for (error, status) in cases {
            assert_eq!(error.exit().status(), status, "{error}");
        }
    }
}
