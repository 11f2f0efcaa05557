//! `run --sweep`: one deck at several values of its keys, each run in a folder of its own.

use pericles_run::sweep::{Plan, Settings, Sweep, SweepEvent};
use pericles_run::units::threads;
use pericles_run::{Deadline, DeckText, Ending, RunError};

use crate::args::{ResumeArgs, RunArgs, RunOptions};
use crate::console;
use crate::error::{self, CliError};
use crate::exit::Exit;
use crate::folder::output_folder;
use crate::given;
use crate::signals::Signals;

/// Runs a deck at all combinations of values.
///
/// # Errors
/// Values that the deck refuses, before anything is run; output that cannot be written.
pub(crate) fn run(args: &RunArgs) -> Result<Exit, CliError> {
    let deck = given::deck(&args.deck, &args.overrides.set)?;
    let text = DeckText::of(&deck, args.deck.display().to_string());
    // Before the folder is made: nobody wants half a sweep.
    let plan = Plan::new(text, args.sweep.clone())?;
    let folder = output_folder(args.out.as_deref(), None, &args.deck, "-sweep")?;
    drive(&plan.begin(folder)?, &args.options)
}

/// Goes on with a sweep: runs that have finished stay, others go on from their checkpoint or begin.
///
/// # Errors
/// A folder that is none of a sweep, output that cannot be written.
pub(crate) fn resume(args: &ResumeArgs) -> Result<Exit, CliError> {
    drive(&Sweep::open(&args.dir)?, &args.options)
}

/// Runs what has not finished, and shows the values and how the runs ended; one thread a run unless the command line says otherwise.
///
/// # Errors
/// Output that cannot be written.
pub(crate) fn drive(sweep: &Sweep, options: &RunOptions) -> Result<Exit, CliError> {
    let settings = Settings {
        threads: options.execution.threads.count_or(1),
        means: options.means(),
        deadline: Deadline::from_now(options.limits.wall_time),
    };
    let quiet = options.execution.quiet;
    let signals = Signals::watch().map_err(CliError::Signals)?;
    let show = |event: SweepEvent<'_>| show(&event, &settings, &signals, quiet);
    let end = sweep.drive(&settings, signals.cancel(), &show)?;
    if !quiet {
        for line in end.table.lines() {
            console::print(format_args!("{line}"))?;
        }
        console::print(format_args!("all of it in {}", end.table.path().display()))?;
    }
    Ok(signals
        .asked()
        .unwrap_or_else(|| exit_of(&end.worst, &signals)))
}

/// The exit status that a run of a sweep leads to.
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
