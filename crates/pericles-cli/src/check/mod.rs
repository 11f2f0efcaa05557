//! `check`: report size, memory, time step and estimated run time of a deck without running it, as text and as JSON
//! with every printed number.

mod line;
mod material;
mod mesh;
mod ranks;
mod refinement;
mod waves;

use std::path::Path;

use pericles::observe::Probe;
use pericles_deck::{Body, Model};
use pericles_run::refinement::{Comparison, LONGEST, seconds_per_step};
use pericles_run::units::{
    bytes, count, duration, frequency, percent, quantity, significant, threads,
};
use pericles_run::{
    Assembled, Assembly, Facts, InitialState, Means, Source, SourceRecord, draw_sets,
};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::{Value, json};

use crate::args::CheckArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::given;
use crate::screen::Screen;

use self::line::Line;
use self::material::{interface, material, surface_material};
use self::waves::plane_waves;

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
    let Assembled { assembly, facts } = Assembled::starting(source, start, means, &mut |event| {
        screen.show(event);
    })?;
    for warning in &facts.warnings {
        console::note(format_args!("warning: {warning}"));
    }
    let model = source.model();
    if let Some(path) = &args.picture {
        draw_sets(model, &assembly, path)?;
    }
    let mut lines = body(model, &facts);
    lines.extend(mesh::mesh(&assembly));
    lines.extend(neighbours(&assembly));
    let means = assembly.with_means(model);
    match (&means.body, &assembly.constants) {
        (Body::Solid(solid), Some(constants)) => {
            let others = (&means.materials[..], &assembly.other_materials[..]);
            lines.extend(material(solid, constants, &facts, others));
            lines.extend(model.interfaces.iter().map(interface));
        }
        (Body::Solid(_), None) => {}
        (Body::Surface(surface), _) => lines.extend(surface_material(surface)),
    }
    let properties = facts.properties.iter();
    lines.extend(properties.map(|one| Line::new("property", one.line())));
    lines.extend(plane_waves(model, &assembly));
    lines.extend(
        facts
            .start
            .iter()
            .map(|start| Line::new("start", start.line())),
    );
    lines.extend(time(&facts));
    /// Largest number of listed loads; `run.json` has all.
    const LOADS: usize = 20;
    for load in facts.loads.iter().take(LOADS) {
        lines.push(Line::new("load", load.line()));
    }
    if facts.loads.len() > LOADS {
        let more = facts.loads.len() - LOADS;
        lines.push(
            Line::new("loads", format!("{} more", count(more as u64)))
                .with("loads_not_listed", more),
        );
    }
    lines.extend(device(&facts));
    lines.extend(heat(&facts));
    lines.extend(contact(&facts));
    lines.extend(probes(&assembly));
    for end in &facts.ends {
        lines.push(Line::new("absorbing boundary", end.line()));
    }
    if let Some(open) = &facts.open {
        lines.push(Line::new("open boundary", open.line()));
        let waves = open.reflection.iter();
        lines.extend(waves.map(|waves| Line::new("reflection", waves.line())));
    }
    let divided = ranks::forecasts(source, &assembly, &args.ranks)?;
    let mut cost = None;
    if model.time.scheme.is_static() {
        // A step leads from one static state to the next: timing one would be the whole run.
        let note = "not estimated: it depends on the iterations per static state";
        lines.push(Line::new("run time", note));
    } else {
        let (time, found) = run_time(model, &facts, assembly, count_of_threads, &mut lines)?;
        lines.push(time);
        cost = Some(found);
    }
    lines.extend(ranks::lines(&divided, cost));
    if args.json.as_deref() != Some(Path::new("-")) {
        let title = model.title.as_deref().unwrap_or("no title");
        let mut text = format!("{}{label}: {title}", args.deck.display());
        for line in &lines {
            text += &format!("\n  {line}");
        }
        console::print(format_args!("{text}"))?;
    }
    match args.json {
        Some(_) => json_of(&args.deck, model, &facts, &lines),
        None => Ok(Value::Null),
    }
}

/// Returns all values in SI units: the facts under their keys in `model` of `run.json`, and the values of the lines.
fn json_of(path: &Path, model: &Model, facts: &Facts, lines: &[Line]) -> Result<Value, CliError> {
    #[derive(Serialize)]
    struct Named<'a> {
        deck: String,
        title: Option<&'a str>,
        #[serde(flatten)]
        facts: &'a Facts,
    }
    let mut json = serde_json::to_value(Named {
        deck: path.display().to_string(),
        title: model.title.as_deref(),
        facts,
    })?;
    if let Value::Object(object) = &mut json {
        line::add_values(object, lines);
    }
    Ok(json)
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
    facts: &Facts,
    mut assembly: Assembly,
    count_of_threads: usize,
    lines: &mut Vec<Line>,
) -> Result<(Line, StepCost), CliError> {
    assembly
        .integrator
        .start(&mut assembly.system, &mut assembly.state);
    let before = (assembly.state.step, assembly.system.evaluated_points());
    let comparison = Comparison::measure(model, &mut assembly)?;
    if let (Some(two), Some(comparison)) = (&facts.refinement, &comparison) {
        lines.extend(refinement::lines(two, facts.scheme, facts.dt, comparison));
    }
    let step = match comparison {
        Some(comparison) => comparison.seconds,
        None => seconds_per_step(
            &mut assembly.system,
            &mut assembly.state,
            &mut *assembly.integrator,
            facts.dt,
            // At most as many steps as the run has: histories of absorbing boundaries have no room for more.
            facts.steps,
            LONGEST,
        )?,
    };
    let steps = (assembly.state.step - before.0).max(1) as f64;
    let evaluated = (assembly.system.evaluated_points() - before.1) as f64;
    let cost = StepCost {
        seconds: step,
        evaluations: evaluated / (steps * facts.points as f64),
    };
    let seconds = step * facts.steps as f64;
    let place = match &facts.device {
        Some(device) => device.name.clone(),
        None => format!("{} ({})", threads(count_of_threads), facts.instruction_set),
    };
    let text = format!("about {} on {place}, without output", duration(seconds));
    let line = Line::new("run time", text)
        .with("run_seconds", seconds)
        .with("threads", count_of_threads);
    Ok((line, cost))
}

/// Returns the line about the device that computes the steps.
fn device(facts: &Facts) -> Option<Line> {
    let device = facts.device.as_ref()?;
    Some(Line::new("device", device.line()).with("device", json!(device)))
}

/// Returns the line about heat conduction.
fn heat(facts: &Facts) -> Option<Line> {
    let heat = facts.heat.as_ref()?;
    let step = heat.step.unwrap_or(facts.dt);
    let parts = match heat.scheme {
        "explicit" => (step / heat.explicit_limit).ceil().max(1.0),
        _ => 1.0,
    };
    let sub_steps = match parts {
        1.0 => String::new(),
        parts => format!(", about {} sub-steps per step", significant(parts, 3)),
    };
    let text = format!(
        "{}, step {}{sub_steps}; limit of the explicit scheme {}",
        heat.scheme,
        quantity(step, "s"),
        quantity(heat.explicit_limit, "s")
    );
    let line = Line::new("heat conduction", text);
    Some(
        line.with("thermal_step", step)
            .with("thermal_sub_steps", parts),
    )
}

/// Returns the lines about pieces, contact and impactors.
fn contact(facts: &Facts) -> Vec<Line> {
    let pieces = facts.pieces.map(|pieces| {
        let text = format!("{pieces}, without bonds between them");
        Line::new("pieces", text).with("pieces", pieces)
    });
    let step = facts.contact_frequency.map(|contact| {
        let lasts = std::f64::consts::PI / contact;
        let steps = lasts / facts.dt;
        let text = format!(
            "of two points lasts {}, {} steps",
            quantity(lasts, "s"),
            significant(steps, 3)
        );
        Line::new("contact", text)
            .with("contact_duration", lasts)
            .with("contact_steps", steps)
    });
    let impactors = facts.impactors.iter();
    let impactors = impactors.map(|name| Line::new("impactor", name.clone()));
    pieces.into_iter().chain(step).chain(impactors).collect()
}

fn body(model: &Model, facts: &Facts) -> Vec<Line> {
    let body = match &model.body {
        Body::Surface(_) => Line::new("body", "surface in 3D"),
        Body::Solid(solid) => {
            let state = solid.state.name();
            let text = format!("{}D, {state}", facts.dimension);
            Line::new("body", text).with("state", state)
        }
    };
    let per_point = facts.directed_bonds as f64 / facts.points as f64;
    let ratio = facts.horizon / facts.spacing;
    let mut lines = vec![
        body,
        Line::new("points", count(facts.points as u64)),
        Line::new(
            "bonds",
            format!(
                "{} ({} directed, {} per point), force kernel: {}",
                count(facts.bonds),
                count(facts.directed_bonds),
                significant(per_point, 3),
                facts.operator
            ),
        )
        .with("directed_bonds_per_point", per_point),
        Line::new(
            "memory",
            format!("about {} (peak)", bytes(facts.memory_estimate)),
        ),
        Line::new(
            "spacing, horizon",
            format!(
                "{}, {}; ratio {}",
                quantity(facts.spacing, "m"),
                quantity(facts.horizon, "m"),
                significant(ratio, 4)
            ),
        )
        .with("horizon_ratio", ratio),
    ];
    if facts.precut_bonds > 0 {
        let cut = Line::new("pre-cracked bonds", count(facts.precut_bonds));
        lines.insert(3, cut);
    }
    lines
}

/// Smallest, mean and largest number of intact bonds of a point, if the operator gives access to single bonds.
fn neighbours(assembly: &Assembly) -> Option<Line> {
    let bonds = assembly.system.operator().capabilities().bonds?;
    let count_of = |i: usize| {
        let mut count = 0u64;
        bonds.for_each_undeformed(i, &mut |_| count += 1);
        (count, count, count)
    };
    let join = |a: (u64, u64, u64), b: (u64, u64, u64)| (a.0.min(b.0), a.1.max(b.1), a.2 + b.2);
    let points = (0..assembly.cloud.len()).into_par_iter();
    let (least, most, sum) = points.map(count_of).reduce(|| (u64::MAX, 0, 0), join);
    let mean = sum as f64 / assembly.cloud.len() as f64;
    let text = format!(
        "{} to {} per point, {} on average",
        count(least),
        count(most),
        significant(mean, 3)
    );
    let value = json!({ "least": least, "mean": mean, "most": most });
    Some(Line::new("neighbours", text).with("neighbours", value))
}

/// Locations of the probes: a point, or the mean over a set.
fn probes(assembly: &Assembly) -> Vec<Line> {
    let line = |probe: &Probe| {
        let mut value = json!({ "name": probe.name, "points": probe.points.len() });
        let text = match probe.points[..] {
            [point] => {
                let place = assembly.cloud.point(point as usize);
                let place = &place[..assembly.cloud.dimension()];
                let shown: Vec<String> = place.iter().map(|x| quantity(*x, "m")).collect();
                value["place"] = json!(place);
                format!("{} at ({})", probe.name, shown.join(", "))
            }
            _ => format!(
                "{}: mean over {} points",
                probe.name,
                count(probe.points.len() as u64)
            ),
        };
        Line::new("probe", text).with_entry("probes", value)
    };
    assembly.probes.iter().map(line).collect()
}

fn time(facts: &Facts) -> Vec<Line> {
    let mut lines = Vec::new();
    if let (Some(omega), Some(bound)) = (facts.highest_frequency, facts.highest_frequency_bound) {
        let certainty = match facts.highest_frequency_failure_probability {
            Some(probability) if probability > 0.0 => {
                format!(" (bound from random vectors, fails with probability {probability:.0e})")
            }
            _ => String::new(),
        };
        let range = range(omega, bound);
        lines.push(
            Line::new("highest frequency", format!("{range}{certainty}"))
                .with("highest_frequency_margin", bound / omega - 1.0),
        );
    }
    if let (Some(omega), Some(bound)) = (facts.limiting_frequency, facts.limiting_frequency_bound)
        && facts.refinement.is_some()
    {
        let line = Line::new("coarse frequency", range(omega, bound));
        lines.push(line.with("limiting_frequency_margin", bound / omega - 1.0));
    }
    if let Some(limit) = facts.stable_step {
        let text = format!("{} ({})", quantity(limit, "s"), facts.scheme);
        lines.push(Line::new("stable step", text));
    }
    let ratio = facts.stable_step.map(|limit| facts.dt / limit);
    let share = ratio.map(step_share).unwrap_or_default();
    let end = facts.steps as f64 * facts.dt;
    let text = format!(
        "{} of {}{share}; end at {}",
        count(facts.steps),
        quantity(facts.dt, "s"),
        quantity(end, "s")
    );
    let steps = Line::new("steps", text)
        .with("end", end)
        .with("dt_over_stable_step", ratio)
        .with(
            "dt_above_stable_step",
            ratio.map(|ratio| (ratio - 1.0).max(0.0)),
        );
    lines.push(steps);
    if let Some(control) = &facts.control {
        let text = format!(
            "the loads follow {}: {} per step, {} at the end",
            control.quantity,
            quantity(control.rate * facts.dt, "m"),
            quantity(control.rate * end, "m")
        );
        lines.push(Line::new("control", text));
    }
    lines
}

/// Formats a frequency with its estimate and upper bound.
fn range(omega: f64, bound: f64) -> String {
    format!(
        "{} 1/s, upper bound {} larger",
        frequency(omega),
        percent((bound / omega - 1.0).max(0.0))
    )
}

/// Formats the ratio of the time step to the stable one. A step above it is never printed as 100 %.
fn step_share(ratio: f64) -> String {
    if ratio > 1.0 {
        format!(", {} above the stable step", percent(ratio - 1.0))
    } else {
        format!(", {} of the stable step", percent(ratio))
    }
}
