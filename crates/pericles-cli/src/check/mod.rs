//! `check`: report size, memory, time step and estimated run time of a deck without running it, as text and as JSON
//! with every printed number.

mod ranks;
mod refinement;

use std::path::Path;

use pericles_deck::Model;
use pericles_run::refinement::{Comparison, LONGEST, RefinementFacts, seconds_per_step};
use pericles_run::units::{duration, threads};
use pericles_run::{
    Assembled, Assembly, Facts, InitialState, Means, Section, Source, SourceRecord, draw_sets,
};
use serde_json::{Value, json};

use crate::args::CheckArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::given;
use crate::screen::Screen;

/// Checks a deck.
///
/// # Errors
/// The deck is invalid.
pub(crate) fn check(args: &CheckArgs) -> Result<Exit, CliError> {
    let count_of_threads = args.threads.start()?;
    let deck = given::deck(&args.deck, &args.overrides.set)?;
    let means = args.device.with(Means {
        caching: args.caching.wanted(),
        memory: args.memory.bytes(),
        ..Means::default()
    });
    let origin = args.origin.open(&means)?;
    let mut start = InitialState::from(origin.as_ref());
    let mut results = Vec::new();
    let with = (&means, count_of_threads);
    let source = Source::of_deck(deck, args.deck.display().to_string());
    let steps = match source.record() {
        SourceRecord::Deck(text) => text.steps()?,
        SourceRecord::Model(_) => Vec::new(),
    };
    if steps.is_empty() {
        results.push(check_source(args, &source, start, with, "")?);
    }
    for (name, step) in steps {
        let source = SourceRecord::Deck(step).read()?;
        results.push(check_source(
            args,
            &source,
            start,
            with,
            &format!(", step {name}"),
        )?);
        start = InitialState::Pending;
    }
    if let Some(path) = &args.json {
        let results = match <[Value; 1]>::try_from(results) {
            Ok([result]) => result,
            Err(steps) => json!({ "deck": args.deck.display().to_string(), "steps": steps }),
        };
        console::write_json(path, &results)?;
    }
    Ok(Exit::Done)
}

/// Checks a deck without steps, or one of its steps, and returns its values; null if they are not wanted.
///
/// # Errors
/// The deck is invalid.
fn check_source(
    args: &CheckArgs,
    source: &Source,
    start: InitialState<'_>,
    (means, count_of_threads): (&Means, usize),
    label: &str,
) -> Result<Value, CliError> {
    let mut screen = Screen::new(false);
    let Assembled {
        assembly,
        mut facts,
    } = Assembled::starting(source, start, means, &mut |event| {
        screen.show(event);
    })?;
    for warning in &facts.warnings {
        console::note(format_args!("warning: {warning}"));
    }
    let model = source.model();
    if let Some(path) = &args.picture {
        draw_sets(model, &assembly, path)?;
    }
    facts.add_details(model, &assembly);
    let divided = ranks::forecasts(source, &assembly, &args.ranks)?;
    let mut cost = None;
    if model.time.scheme.is_static() {
        // A step leads from one static state to the next: timing one would be the whole run.
        let note = "not estimated: it depends on the iterations per static state";
        facts.line(Section::Cost, "run time", note);
    } else {
        cost = Some(run_time(model, &mut facts, assembly, count_of_threads)?);
    }
    ranks::add_lines(&mut facts, &divided, cost);
    let (deck, title) = (args.deck.display().to_string(), model.title.as_deref());
    if args.json.as_deref() != Some(Path::new("-")) {
        let title = title.unwrap_or("no title");
        let mut text = format!("{deck}{label}: {title}");
        for (name, value) in facts.printed() {
            text += &format!("\n  {name:<18} {value}");
        }
        console::print(format_args!("{text}"))?;
    }
    let mut values = facts.to_json();
    values.insert("deck".into(), deck.into());
    values.insert("title".into(), title.into());
    Ok(values.into())
}

/// The cost of a step of the whole body on this machine.
#[derive(Debug, Clone, Copy)]
struct StepCost {
    /// Time, s.
    seconds: f64,
    /// Number of force evaluations of the whole body.
    evaluations: f64,
}

/// Estimates the run time from a few steps; for multirate schemes it also adds the lines about their speed-up.
fn run_time(
    model: &Model,
    facts: &mut Facts,
    mut assembly: Assembly,
    count_of_threads: usize,
) -> Result<StepCost, CliError> {
    let (dt, steps, points) = (assembly.dt, assembly.steps, assembly.cloud.len());
    let device = assembly.device.clone();
    let instruction_set = assembly.system.operator().instruction_set().name();
    let multirate = RefinementFacts::of(model, &assembly);
    assembly
        .integrator
        .start(&mut assembly.system, &mut assembly.state);
    let before = (assembly.state.step, assembly.system.evaluated_points());
    let comparison = Comparison::measure(model, &mut assembly)?;
    if let (Some(multirate), Some(comparison)) = (&multirate, &comparison) {
        let scheme = assembly.integrator.name();
        refinement::add_lines(facts, multirate, (scheme, dt), comparison);
    }
    let step = match comparison {
        Some(comparison) => comparison.seconds,
        None => seconds_per_step(
            &mut assembly.system,
            &mut assembly.state,
            &mut *assembly.integrator,
            dt,
            // At most as many steps as the run has: histories of absorbing boundaries have no room for more.
            steps,
            LONGEST,
        )?,
    };
    let timed = (assembly.state.step - before.0).max(1) as f64;
    let evaluated = (assembly.system.evaluated_points() - before.1) as f64;
    let seconds = step * steps as f64;
    let place = match device {
        Some(device) => device.name,
        None => format!("{} ({instruction_set})", threads(count_of_threads)),
    };
    let text = format!("about {} on {place}, without output", duration(seconds));
    facts
        .line(Section::Cost, "run time", text)
        .checked("run_seconds", "s", seconds)
        .checked("threads", "", count_of_threads);
    Ok(StepCost {
        seconds: step,
        evaluations: evaluated / (timed * points as f64),
    })
}
