//! `run` and `resume`: run a simulation in its output folder until its end, a signal or the time limit.

use pericles_run::fit::is_fit;
use pericles_run::sequence::{Plan, Sequence, is_sequence};
use pericles_run::sweep::is_sweep;
use pericles_run::units::{count, quantity};
use pericles_run::{
    Assembled, Deadline, Ending, InitialState, Means, Results, Run, RunError, Source, SourceRecord,
    shared_folder,
};

use crate::args::{ResumeArgs, RunArgs};
use crate::charts::{Scales, of_table};
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::fit;
use crate::folder::output_folder;
use crate::given;
use crate::processes::Processes;
use crate::screen::Screen;
use crate::signals::Signals;
use crate::summary;
use crate::sweep;
use crate::text_chart::TextChart;

/// Runs a deck.
///
/// # Errors
/// The deck is invalid, output cannot be written, or the run becomes unstable.
pub(crate) fn run(args: &RunArgs, processes: &Processes) -> Result<Exit, CliError> {
    if !args.sweep.is_empty() {
        processes.require_one()?;
        return sweep::run(args);
    }
    let deadline = Deadline::from_now(args.options.limits.wall_time);
    let quiet = args.options.execution.quiet;
    processes.start_threads(&args.options.execution.threads, quiet)?;
    let deck = given::deck(&args.deck, &args.overrides.set)?;
    let file = args.deck.display().to_string();
    if !quiet && processes.is_first() {
        console::note(format_args!("{file}: building the model"));
    }
    let source = Source::of_deck(deck, file);
    // The folder is created only after the deck has been validated.
    let mut screen = Screen::shared(quiet, processes.is_first());
    let means = Means {
        comm: processes.comm(),
        memory: processes.memory(&args.options.limits.memory),
        ..args.options.means()
    };
    let origin = args.origin.open(&means)?;
    let start = InitialState::from(origin.as_ref());
    let steps = match source.record() {
        SourceRecord::Deck(text) => Plan::new(text, args.origin.path()?)?,
        SourceRecord::Model(_) => None,
    };
    if let Some(plan) = steps {
        plan.check(start, &means, &mut |event| screen.show(event))?;
        let folder = shared_folder(&*means.comm, || {
            output_folder(args.out.as_deref(), Some(args.force), &args.deck, "")
        })?;
        let sequence = plan.begin(folder, &means)?;
        return drive_steps(&sequence, &means, deadline, (quiet, args.chart), processes);
    }
    let assembled = Assembled::starting(&source, start, &means, &mut |event| {
        screen.show(event);
    })?;
    let folder = shared_folder(&*means.comm, || {
        output_folder(args.out.as_deref(), Some(args.force), &args.deck, "")
    })?;
    let run = Run::begin(&source, assembled, folder)?;
    let (_, exit) = drive(run, deadline, (quiet, args.chart), processes)?;
    Ok(exit)
}

/// Resumes a run from its last checkpoint.
///
/// # Errors
/// No usable checkpoint, and the errors of [`run`].
pub(crate) fn resume(args: &ResumeArgs, processes: &Processes) -> Result<Exit, CliError> {
    if is_sweep(&args.dir) {
        processes.require_one()?;
        return sweep::resume(args);
    }
    if is_fit(&args.dir) {
        processes.require_one()?;
        return fit::resume(args);
    }
    let deadline = Deadline::from_now(args.options.limits.wall_time);
    let quiet = args.options.execution.quiet;
    processes.start_threads(&args.options.execution.threads, quiet)?;
    let shows = !quiet && processes.is_first();
    let mut screen = Screen::shared(quiet, processes.is_first());
    let means = Means {
        comm: processes.comm(),
        memory: processes.memory(&args.options.limits.memory),
        ..args.options.means()
    };
    if is_sequence(&args.dir) {
        if !args.set.is_empty() {
            let reason = "it has several steps; give the folder of its last step".into();
            return Err(RunError::NotExtended { reason }.into());
        }
        let sequence = Sequence::open(&args.dir, &means)?;
        return drive_steps(&sequence, &means, deadline, (quiet, args.chart), processes);
    }
    let Some(run) = Run::extend(&args.dir, &args.set, &means, &mut |event| {
        screen.show(event);
    })?
    else {
        if shows {
            let path = args.dir.display();
            console::print(format_args!(
                "{path}: the run has finished; there is nothing to resume"
            ))?;
        }
        return Ok(Exit::Done);
    };
    if shows {
        let path = run.folder().display();
        let (state, steps) = (run.simulation().state(), run.simulation().steps());
        console::note(format_args!(
            "{path}: resuming at step {} of {}, t = {}",
            count(state.step),
            count(steps),
            quantity(state.t, "s")
        ));
    }
    let (_, exit) = drive(run, deadline, (quiet, args.chart), processes)?;
    Ok(exit)
}

/// Drives the steps that have not finished.
///
/// # Errors
/// A step cannot start or be resumed, output cannot be written, or a run becomes unstable.
fn drive_steps(
    sequence: &Sequence,
    means: &Means,
    deadline: Option<Deadline>,
    (quiet, chart): (bool, bool),
    processes: &Processes,
) -> Result<Exit, CliError> {
    let shows = !quiet && processes.is_first();
    let count = sequence.names().len();
    let mut screen = Screen::shared(quiet, processes.is_first());
    let mut exit = Exit::Done;
    sequence.drive(means, &mut |event| screen.show(event), |number, run| {
        if shows {
            let name = sequence.names().nth(number).unwrap_or_default();
            console::note(format_args!("step {} of {count}: {name}", number + 1));
        }
        let (ending, status) = drive(run, deadline.clone(), (quiet, chart), processes)?;
        exit = status;
        Ok::<_, CliError>(ending)
    })?;
    if shows && exit == Exit::Done {
        let folder = sequence.folder().display();
        console::print(format_args!(
            "All {count} steps have finished; results on one time line in {folder}"
        ))?;
    }
    Ok(exit)
}

/// Drives a run to its end, a signal or the deadline, and prints a summary; returns how it ended, and the exit status.
///
/// # Errors
/// Output cannot be written, or the run becomes unstable.
fn drive(
    mut run: Run,
    deadline: Option<Deadline>,
    (quiet, chart): (bool, bool),
    processes: &Processes,
) -> Result<(Ending, Exit), CliError> {
    let signals = Signals::watch().map_err(CliError::Signals)?;
    let mut screen = Screen::shared(quiet, processes.is_first());
    let ending = run.drive(deadline, signals.cancel(), &mut |event| screen.show(event))?;
    let exit = signals.exit_of(ending);
    if !processes.is_first() {
        return Ok((ending, exit));
    }
    if !quiet {
        summary::closing(run.report(), run.folder())?;
    }
    if chart {
        let scales = Scales::of(&Results::open(run.folder())?);
        let charts = of_table(&run.folder().join("history.csv"), &scales, |_| true)?;
        for chart in &charts {
            console::print(format_args!("{}", TextChart::of(chart)))?;
        }
    }
    Ok((ending, exit))
}
