//! `fit`: keys of a deck fitted to a measured curve.

use pericles_run::fit::{Fit, FitEnd, FitEvent, Plan, Question};
use pericles_run::sweep::SweepEvent;
use pericles_run::{DeckText, RunError};

use crate::args::{FitArgs, ResumeArgs, RunOptions};
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::folder::output_folder;
use crate::given;
use crate::signals::Signals;

/// Fits keys of a deck to a measured curve.
///
/// # Errors
/// The deck, the curve or a bound is invalid (before anything is run), a run fails, or output cannot be written.
pub(crate) fn fit(args: &FitArgs) -> Result<Exit, CliError> {
    let deck = given::deck(&args.deck, &args.overrides.set)?;
    let text = DeckText::of(&deck, args.deck.display().to_string());
    let question = Question {
        curve: &args.curve,
        columns: [&args.x, &args.y],
        keys: args.keys.clone(),
        step: args.step,
        tolerance: args.tolerance,
        runs: args.runs,
    };
    let plan = Plan::new(text, &question)?;
    let folder = output_folder(args.out.as_deref(), None, &args.deck, "-fit")?;
    drive(&plan.begin(folder)?, &args.options)
}

/// Resumes a fit: runs that have finished are read, others continue from their checkpoint or start.
///
/// # Errors
/// The folder does not contain a fit, and the errors of [`fit`].
pub(crate) fn resume(args: &ResumeArgs) -> Result<Exit, CliError> {
    if !args.set.is_empty() {
        let reason = "it is a fit; give the folder of one of its runs".into();
        return Err(RunError::NotExtended { reason }.into());
    }
    drive(&Fit::open(&args.dir)?, &args.options)
}

/// Runs the fit in a folder until its values no longer change.
///
/// # Errors
/// A run fails, or output cannot be written.
fn drive(fit: &Fit, options: &RunOptions) -> Result<Exit, CliError> {
    let settings = options.of_several();
    let quiet = options.execution.quiet;
    let signals = Signals::watch().map_err(CliError::Signals)?;
    let show = |event: FitEvent<'_>| match event {
        FitEvent::Run(SweepEvent::CacheNote(note)) => console::note(format_args!("{note}")),
        FitEvent::Values(values) if !quiet => {
            let values: Vec<String> = values
                .iter()
                .map(|(key, value)| format!("{key}={value:.5e}"))
                .collect();
            console::note(format_args!("run with {}", values.join(" ")));
        }
        _ => {}
    };
    let outcome = match fit.drive(&settings, signals.cancel(), &show)? {
        FitEnd::Found(outcome) => outcome,
        FitEnd::Stopped(how) => {
            if !quiet {
                let folder = fit.folder().display();
                console::note(format_args!(
                    "stopped; resume with: pericles resume {folder}"
                ));
            }
            return Ok(signals.exit_of(how));
        }
    };
    for warning in outcome.warnings() {
        console::note(format_args!("warning: {warning}"));
    }
    if !quiet {
        for line in outcome.lines() {
            console::print(format_args!("{line}"))?;
        }
        let sets: Vec<String> = outcome
            .overrides()
            .iter()
            .map(|set| format!("--set {set}"))
            .collect();
        console::print(format_args!("fitted values: {}", sets.join(" ")))?;
        console::print(format_args!(
            "Results in {}: fit.csv, curve.csv, fit.png",
            fit.folder().display()
        ))?;
    }
    Ok(match outcome.has_converged() {
        true => Exit::Done,
        false => Exit::Comparison,
    })
}
