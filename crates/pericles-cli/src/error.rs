//! Errors of the command-line program and how they are reported.

use std::borrow::Borrow;
use std::fmt::{self, Display, Formatter};
use std::io::IsTerminal;
use std::path::PathBuf;

use miette::{Diagnostic, LabeledSpan, SourceCode};
use pericles::{DeviceError, PericlesError, SimulationError};
use pericles_deck::DeckError;
use pericles_io::{IoError, MeshError};
use pericles_manifold::surface::SurfaceError;
use pericles_run::RunError;

use crate::console;
use crate::drawn::Drawn;
use crate::exit::Exit;

/// An error that ends a command.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[non_exhaustive]
pub(crate) enum CliError {
    /// A run cannot start or continue, or its results cannot be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Run(OfRun<RunError>),
    /// The deck cannot be read.
    #[error("cannot read the deck {}: {reason}", path.display())]
    NoDeck {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
        /// A suggestion.
        #[help]
        hint: Option<String>,
    },
    /// The output folder exists.
    #[error("{} already exists", path.display())]
    OutExists {
        /// The folder.
        path: PathBuf,
        /// The advice.
        #[help]
        help: &'static str,
    },
    /// An input file of another code cannot be imported.
    #[error(transparent)]
    Import(#[from] pericles_import::ImportError),
    /// A deck would be overwritten.
    #[error("{} already exists", path.display())]
    #[diagnostic(help("choose another name with --out, or use --force to replace the file"))]
    DeckExists {
        /// The deck.
        path: PathBuf,
    },
    /// A file would be overwritten.
    #[error("{} already exists", path.display())]
    #[diagnostic(help("choose another name, or move the file"))]
    FileExists {
        /// The file.
        path: PathBuf,
    },
    /// A surface is not usable.
    #[error("{name}: {source}")]
    Surface {
        /// The file or shape.
        name: String,
        /// Why.
        source: SurfaceError,
    },
    /// A mesh has no usable elements.
    #[error("{}: {problem}", file.display())]
    Mesh {
        /// The file.
        file: PathBuf,
        /// The problem.
        problem: String,
    },
    /// The width of a picture is out of range.
    #[error("{problem}")]
    #[diagnostic(help("choose --width and --dpi accordingly"))]
    PictureWidth {
        /// The width and what is allowed.
        problem: String,
    },
    /// A size of text or a resolution without a width on paper.
    #[error("--font-size and --dpi require a width on paper")]
    #[diagnostic(help("give a length, such as --width 88mm"))]
    NoPaperWidth,
    /// The ranges of `--crop` do not have the dimension of the body.
    #[error("--crop has {given} range(s); the body has {dimension} dimension(s)")]
    #[diagnostic(help("give one range for each axis, such as 10mm:30mm,0:20mm in two dimensions"))]
    CropRanges {
        /// Number of ranges given.
        given: usize,
        /// Dimension of the body.
        dimension: usize,
    },
    /// A run has no field files.
    #[error("{} contains no field files", folder.display())]
    #[diagnostic(help("the deck requested none; add `fields` to [output] and run it again"))]
    NoFields {
        /// The folder of the run.
        folder: PathBuf,
    },
    /// The spectrum of an unstable lattice cannot be measured.
    #[error(
        "the spectrum cannot be measured: the kernel is unstable on this grid (some waves grow exponentially)"
    )]
    #[diagnostic(help("omit --measure, or use a stable kernel"))]
    UnstableSpectrum,
    /// The scheme for `--prestress` is not static.
    #[error("--prestress requires a static scheme; the deck has time.scheme = \"{scheme}\"")]
    #[diagnostic(help("use time.scheme = \"static\", or omit --prestress"))]
    NotStatic {
        /// The scheme of the deck.
        scheme: &'static str,
    },
    /// A vector has more components than the body has dimensions.
    #[error("{option} has {given} components; the body has {dimension} dimension(s)")]
    #[diagnostic(help("give at most one component per dimension of the body"))]
    Components {
        /// The option.
        option: &'static str,
        /// Number of components given.
        given: usize,
        /// Dimension of the body.
        dimension: usize,
    },
    /// A word is neither a shape nor a file.
    #[error("unknown shape \"{given}\"")]
    UnknownShape {
        /// The word.
        given: String,
        /// What is allowed.
        #[help]
        allowed: &'static str,
    },
    /// A vertex number is out of range.
    #[error("the surface has no vertex {number}; its {vertices} vertices are numbered 0 to {}", vertices.saturating_sub(1))]
    NoVertex {
        /// The number given.
        number: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// Several processes were started for a command that runs as a single one.
    #[error("{processes} processes were started, but this command runs as a single process")]
    #[diagnostic(help(
        "start it without mpirun or srun; `pericles run` and `pericles resume` divide a run among several processes"
    ))]
    OneProcess {
        /// Number of processes.
        processes: usize,
    },
    /// Several processes were started, and the program cannot connect them.
    #[error(
        "{processes} processes were started, but this program was built without MPI: each of them would make the whole run"
    )]
    #[diagnostic(help(
        "build it with MPI, `cargo build --release -p pericles-cli --features mpi`, or start one process and use --threads"
    ))]
    NoMpi {
        /// Number of processes.
        processes: usize,
    },
    /// The launcher and the MPI library belong to different MPI implementations.
    #[error(
        "the launcher has started {launched} processes, but the MPI library of this program ({library}) connects {connected}"
    )]
    #[diagnostic(help(
        "start the program with the mpirun of this library, or build it with the library of the launcher: MPICC=mpicc of that library"
    ))]
    OtherMpi {
        /// Number of processes according to the launcher.
        launched: usize,
        /// Number of processes according to the library.
        connected: usize,
        /// Name of the library.
        library: String,
    },
    /// The MPI library does not support threads.
    #[error(
        "the MPI library of this program ({library}) does not allow calls from several threads"
    )]
    #[diagnostic(help(
        "build the program with an MPI library that supports MPI_THREAD_SERIALIZED"
    ))]
    OneThread {
        /// Name of the library.
        library: String,
    },
    /// Signal handlers cannot be installed.
    #[error("cannot install handlers for Ctrl-C and SIGTERM: {0}")]
    Signals(#[source] std::io::Error),
}

impl CliError {
    /// Returns the exit status.
    pub(crate) fn exit(&self) -> Exit {
        match self {
            Self::Run(OfRun(error)) => exit_of(error),
            Self::NoDeck { .. }
            | Self::Import(_)
            | Self::UnstableSpectrum
            | Self::NotStatic { .. }
            | Self::Surface { .. }
            | Self::Mesh { .. }
            | Self::NoFields { .. } => Exit::Input,
            Self::UnknownShape { .. }
            | Self::NoVertex { .. }
            | Self::PictureWidth { .. }
            | Self::NoPaperWidth
            | Self::CropRanges { .. }
            | Self::Components { .. } => Exit::Usage,
            Self::OutExists { .. } | Self::DeckExists { .. } | Self::FileExists { .. } => {
                Exit::Output
            }
            Self::OneProcess { .. }
            | Self::NoMpi { .. }
            | Self::OtherMpi { .. }
            | Self::OneThread { .. } => Exit::Processes,
            Self::Signals(_) => Exit::Internal,
        }
    }

    /// Returns whether another of the processes that share a run reports the error.
    pub(crate) fn is_elsewhere(&self) -> bool {
        matches!(self, Self::Run(OfRun(error)) if error.is_elsewhere())
    }

    /// Reports the error on standard error.
    pub(crate) fn report(&self) {
        match self {
            Self::Run(OfRun(error)) => report(error),
            other => report_diagnostic(other),
        }
    }
}

/// Returns the error of a graphics processor.
fn device_error(error: &RunError) -> Option<&DeviceError> {
    let error = match error {
        RunError::Library(error) => error,
        RunError::Simulation(SimulationError::Stuck { source, .. })
        | RunError::Unstable {
            source: SimulationError::Stuck { source, .. },
            ..
        } => source,
        _ => return None,
    };
    error.extension()
}

/// Returns the exit status for an error of a run.
pub(crate) fn exit_of(error: &RunError) -> Exit {
    if let Some(error) = device_error(error) {
        return match error {
            DeviceError::Missing(_) | DeviceError::Failed(_) => Exit::Device,
            DeviceError::Unsuitable(_) => Exit::Input,
            DeviceError::Memory(_) => Exit::Memory,
        };
    }
    match error {
        RunError::Deck(error) if error.is_too_large() => Exit::Memory,
        RunError::Io(IoError::TooLarge { .. })
        | RunError::Mesh(MeshError::Io(IoError::TooLarge { .. })) => Exit::Memory,
        RunError::Model(error) if error.is_too_large() => Exit::Memory,
        RunError::Deck(_)
        | RunError::Model(_)
        | RunError::Checkpoint { .. }
        | RunError::InputChanged { .. }
        | RunError::NotExtended { .. }
        | RunError::NoCommonTimes { .. }
        | RunError::NoFit { .. }
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
        // Internal errors of the simulation, thread pool and JSON.
        _ => Exit::Internal,
    }
}

/// Reports an error of a run on standard error: with the locations in the deck marked on a terminal, otherwise as plain
/// lines.
pub(crate) fn report(error: &RunError) {
    match error {
        // One by one: the message of the whole error would list them all again.
        RunError::Deck(error)
            if !error.problems().is_empty() && std::io::stderr().is_terminal() =>
        {
            /// Longer lines would fill the screen.
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

/// An error of a run, owned or borrowed, with advice.
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
                "the folder may have been modified since the run stopped; run the deck again",
            ),
            RunError::NotExtended { .. } => Box::new(
                "a resumed run may only have another `time.end`; `pericles run DECK --from DIR` starts from its state with other conditions",
            ),
            RunError::InputChanged { .. } => {
                Box::new("restore the original file, or start a new run")
            }
            RunError::NoCommonTimes { .. } => Box::new(
                "choose columns of one table, or of tables with the same schedule; [[output.quantity]] makes columns with the schedule of the history, such as crack_1_advance",
            ),
            RunError::NoResults { .. } | RunError::NoRun { .. } => {
                Box::new("give the output folder of `pericles run`, such as ./branching")
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

/// Converts errors of the libraries into errors of a run.
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
    fn errors_map_to_exit_statuses() {
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
            cause: pericles::InstabilityCause::NotANumber,
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
