//! The program `pericles`: peridynamics from a deck. It is a library, so that packages for other languages can include
//! the program ([`command`]).
//!
//! Each command is one module, which reads its arguments, calls a library and prints the results. `run`, `check`,
//! `modes`, `dispersion` and `resume` act on decks and output folders; `sweep` and `converge` on one deck with
//! several values; `info`, `plot`, `view`, `diff`, `export` and `report` (`page`) on results; `reproduce` on the built-in
//! studies; `import` on input files of other codes; `geodesics` on surfaces; `mesh` on mesh files; `bench` on fixed bodies. The commands share the console,
//! the display of a run (`screen`), signal handling, the processes that share a run
//! (`processes`), and errors, each of which leads to one message and one exit
//! status (`exit`).

mod args;
mod bench;
#[cfg(test)]
mod book;
mod bug;
mod charts;
mod check;
mod console;
mod converge;
mod devices;
mod diff;
mod dispersion;
mod drawn;
mod error;
mod exit;
mod export;
mod fit;
mod folder;
mod frames;
mod geodesics;
mod given;
mod import;
mod info;
mod manual;
mod mesh;
mod modes;
mod new;
mod page;
mod plot;
mod processes;
mod progress;
mod reproduce;
mod run;
mod schema;
mod screen;
mod signals;
mod summary;
mod sweep;
mod text_chart;
mod view;

use std::ffi::OsString;

use clap::Parser;
use clap::error::ErrorKind;
use pericles::operator::InstructionSet;

use args::{Cli, Command};
use exit::Exit;
use processes::Processes;

/// The commit from which the program was built, followed by `-dirty` if the sources differed from it; `None` if it was
/// built outside a checkout and the builder did not name it in the variable `PERICLES_COMMIT`.
pub const COMMIT: Option<&str> = option_env!("PERICLES_SOURCE_COMMIT");

/// Returns the graphics processors for runs by other programs; `None` without the feature `gpu`.
pub fn graphics_processors() -> Option<std::sync::Arc<dyn pericles_run::Devices>> {
    devices::devices()
}

/// Parses the command line. If a deck is given without a command, advises `pericles run`.
///
/// # Errors
/// The exit status, if there is nothing to do: after an error, which is printed, and after `--help` and `--version`.
fn parsed(arguments: &[OsString]) -> Result<Cli, u8> {
    Cli::try_parse_from(arguments).map_err(|error| {
        let word = arguments.get(1).map(|word| word.to_string_lossy());
        let word = word.unwrap_or_default();
        // A failed write to standard error cannot be reported.
        let _ = error.print();
        if error.kind() == ErrorKind::InvalidSubcommand && word.ends_with(".toml") {
            console::note(format_args!("To run a deck, use `pericles run {word}`."));
        }
        u8::try_from(error.exit_code()).unwrap_or(1)
    })
}

/// Runs a command line, of which the first argument is the name of the program, and returns the exit status. Meant to be
/// called once, by a process that ends afterwards: it installs signal handlers.
pub fn command(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    bug::end_at_panics();
    pericles_run::set_commit(COMMIT);
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let cli = match parsed(&arguments) {
        Ok(cli) => cli,
        Err(status) => return status,
    };
    if let Some(set) = cli.instruction_set.filter(|set| !set.limit_process()) {
        let name = set.name();
        let available = InstructionSet::detect().name();
        console::note(format_args!(
            "error: --instruction-set {name} is not available: this machine supports {available} and smaller sets."
        ));
        return Exit::Usage.status();
    }
    let processes = match Processes::start(cli.command.is_shared()) {
        Ok(processes) => processes,
        Err(error) => return processes::rejected(&error),
    };
    let outcome = match cli.command {
        Command::Run(args) => run::run(&args, &processes),
        Command::Check(args) => check::check(&args),
        Command::Resume(args) => run::resume(&args, &processes),
        Command::Devices(args) => devices::list(&args),
        Command::Info(args) => info::info(&args),
        Command::Report(args) => page::report(&args),
        Command::Plot(args) => plot::plot(&args),
        Command::Diff(args) => diff::diff(&args),
        Command::Bench(args) => bench::bench(&args),
        Command::Dispersion(args) => dispersion::dispersion(&args),
        Command::Geodesics(args) => geodesics::geodesics(&args),
        Command::Mesh(args) => mesh::mesh(&args),
        Command::Modes(args) => modes::modes(&args),
        Command::Export(args) => export::export(&args),
        Command::View(args) => view::view(&args),
        Command::Converge(args) => converge::converge(&args),
        Command::Fit(args) => fit::fit(&args),
        Command::Reproduce(args) => reproduce::reproduce(&args),
        Command::New(args) => new::new(&args),
        Command::Import(args) => import::import(&args),
        Command::Schema(args) => schema::schema(&args),
        Command::Completions(args) => manual::completions(&args),
        Command::Man(args) => manual::man(&args),
    };
    processes.conclude(outcome)
}
