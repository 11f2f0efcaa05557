//! `run` and `resume`: a simulation in its folder, from a first step to its end or to a signal.

use pericles_run::sweep::is_sweep;
use pericles_run::units::{count, quantity};
use pericles_run::{Assembled, Deadline, Run, Source};

use crate::args::{ResumeArgs, RunArgs};
use crate::charts;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::folder::output_folder;
use crate::given;
use crate::screen::Screen;
use crate::signals::Signals;
use crate::summary;
use crate::sweep;
use crate::text_chart::TextChart;

/// Runs a deck.
///
/// # Errors
/// A deck that is refused, output that cannot be written, an unstable run.
pub(crate) fn run(args: &RunArgs) -> Result<Exit, CliError> {
    if !args.sweep.is_empty() {
        return sweep::run(args);
    }
    let deadline = Deadline::from_now(args.options.limits.wall_time);
    args.options.execution.threads.start()?;
    let deck = given::deck(&args.deck, &args.overrides.set)?;
    let file = args.deck.display().to_string();
    let quiet = args.options.execution.quiet;
    if !quiet {
        console::note(format_args!("{file}: building the model"));
    }
    let source = Source::of_deck(deck, file);
    // The folder is made once nothing in the deck can be wrong any more.
    let mut screen = Screen::new(quiet);
    let means = args.options.means();
    let assembled = Assembled::of(&source, &means, &mut |event| screen.show(event))?;
    let folder = output_folder(args.out.as_deref(), Some(args.force), &args.deck, "")?;
    let run = Run::begin(&source, assembled, folder)?;
    drive(run, deadline, quiet, args.chart)
}

/// Goes on with a run from its last checkpoint.
///
/// # Errors
/// No usable checkpoint, and what can go wrong with a run.
pub(crate) fn resume(args: &ResumeArgs) -> Result<Exit, CliError> {
    if is_sweep(&args.dir) {
        return sweep::resume(args);
    }
    let deadline = Deadline::from_now(args.options.limits.wall_time);
    args.options.execution.threads.start()?;
    let quiet = args.options.execution.quiet;
    let mut screen = Screen::new(quiet);
    let means = args.options.means();
    let Some(run) = Run::resume(&args.dir, &means, &mut |event| screen.show(event))? else {
        if !quiet {
            let path = args.dir.display();
            console::print(format_args!(
                "{path}: the run has finished; nothing to resume"
            ))?;
        }
        return Ok(Exit::Done);
    };
    if !quiet {
        let path = run.folder().display();
        let (state, steps) = (run.simulation().state(), run.simulation().steps());
        console::note(format_args!(
            "{path}: going on from step {} of {}, t = {}",
            count(state.step),
            count(steps),
            quantity(state.t, "s")
        ));
    }
    drive(run, deadline, quiet, args.chart)
}

/// Drives a run to its end, to a signal or close to the deadline, and says how it went.
///
/// # Errors
/// Output that cannot be written, an unstable run.
fn drive(
    mut run: Run,
    deadline: Option<Deadline>,
    quiet: bool,
    chart: bool,
) -> Result<Exit, CliError> {
    let signals = Signals::watch().map_err(CliError::Signals)?;
    let mut screen = Screen::new(quiet);
    let ending = run.drive(deadline, signals.cancel(), &mut |event| screen.show(event))?;
    let exit = signals.exit_of(ending);
    if !quiet {
        summary::closing(run.report(), run.folder())?;
    }
    if chart {
        let charts = charts::of_table(&run.folder().join("history.csv"), |_| true)?;
        for chart in &charts {
            console::print(format_args!("{}", TextChart::of(chart)))?;
        }
    }
    Ok(exit)
}
