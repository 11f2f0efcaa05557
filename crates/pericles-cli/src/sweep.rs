//! `run --sweep`: parameter sweeps; each run has its own folder.

use pericles_run::sweep::{Plan, Settings, Sweep, SweepEvent};
use pericles_run::units::threads;
use pericles_run::{DeckText, Ending, RunError};

use crate::args::{ResumeArgs, RunArgs, RunOptions};
use crate::console;
use crate::error::{self, CliError};
use crate::exit::Exit;
use crate::folder::output_folder;
use crate::given;
use crate::signals::Signals;

/// Runs a deck for all combinations of values.
///
/// # Errors
/// The deck is invalid for one of the values (before anything is run), or output cannot be written.
pub(crate) fn run(args: &RunArgs) -> Result<Exit, CliError> {
    let deck = given::deck(&args.deck, &args.overrides.set)?;
    let text = DeckText::of(&deck, args.deck.display().to_string());
    // Before the folder is created, so that invalid values do not leave half a sweep.
    let plan = Plan::new(text, args.sweep.clone(), args.origin.path()?)?;
    let folder = output_folder(args.out.as_deref(), None, &args.deck, "-sweep")?;
    drive(&plan.begin(folder)?, &args.options)
}

/// Resumes a sweep: finished runs are kept, others continue from their checkpoint or start.
///
/// # Errors
/// The folder does not contain a sweep, or output cannot be written.
pub(crate) fn resume(args: &ResumeArgs) -> Result<Exit, CliError> {
    if !args.set.is_empty() {
        let reason = "it is a sweep; give the folder of one of its runs".into();
        return Err(RunError::NotExtended { reason }.into());
    }
    drive(&Sweep::open(&args.dir)?, &args.options)
}

/// Runs all unfinished runs, by default on one thread each, and prints the table of values and outcomes.
///
/// # Errors
/// Output cannot be written.
pub(crate) fn drive(sweep: &Sweep, options: &RunOptions) -> Result<Exit, CliError> {
    let settings = options.of_several();
    let quiet = options.execution.quiet;
    let signals = Signals::watch().map_err(CliError::Signals)?;
    let show = |event: SweepEvent<'_>| show(&event, &settings, &signals, quiet);
    let end = sweep.drive(&settings, signals.cancel(), &show)?;
    if !quiet {
        for line in end.table.lines() {
            console::print(format_args!("{line}"))?;
        }
        console::print(format_args!("Summary in {}", end.table.path().display()))?;
    }
    Ok(signals
        .asked()
        .unwrap_or_else(|| exit_of(&end.worst, &signals)))
}

/// Returns the exit status for a run of a sweep.
fn exit_of(how: &Result<Ending, RunError>, signals: &Signals) -> Exit {
    match how {
        Ok(ending) => signals.exit_of(*ending),
        Err(error) => error::exit_of(error),
    }
}

fn show(event: &SweepEvent<'_>, settings: &Settings, signals: &Signals, quiet: bool) {
    match event {
        SweepEvent::CacheNote(note) => console::note(format_args!("{note}")),
        SweepEvent::Begins {
            runs,
            at_once,
            folder,
        } if !quiet => console::note(format_args!(
            "{runs} runs, {at_once} at a time on {} each; results in {}",
            threads(settings.threads),
            folder.display()
        )),
        SweepEvent::Ended { run, how } => {
            if let Err(error) = how {
                console::note(format_args!("{run}:"));
                error::report(error);
            }
            if !quiet {
                let word = match exit_of(how, signals) {
                    Exit::Done => "finished",
                    Exit::StoppedEarly | Exit::Interrupted | Exit::Terminated => "stopped",
                    _ => "failed",
                };
                console::note(format_args!("{run}: {word}"));
            }
        }
        _ => {}
    }
}
