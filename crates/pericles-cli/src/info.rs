//! `info`: contents of an output folder and status of the run.

use std::path::Path;

use pericles_io::read_csv;
use pericles_run::sweep::{SweepResults, is_sweep};
use pericles_run::units::{bytes, count, duration, percent, quantity, threads};
use pericles_run::{Results, file_name};

use crate::args::InfoArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use pericles_run::TimeAxis;

/// Describes the results of a run.
///
/// # Errors
/// The folder contains no results, or damaged files.
pub(crate) fn info(args: &InfoArgs) -> Result<Exit, CliError> {
    if is_sweep(&args.dir) {
        return sweep(&SweepResults::open(&args.dir)?);
    }
    let results = Results::open(&args.dir)?;
    let mut lines = lines(&results)?;
    for warning in results.texts("/model/warnings") {
        lines.push(("warning", warning.to_owned()));
    }
    let title = match results.text("/title") {
        "" => "no title",
        title => title,
    };
    let mut text = format!("{}: {title}", results.folder().display());
    for (name, value) in lines {
        text += &format!("\n  {name:<12} {value}");
    }
    console::print(format_args!("{text}"))?;
    Ok(Exit::Done)
}

/// Returns name and text of each line about a run, without its warnings.
///
/// # Errors
/// The folder has damaged files.
pub(crate) fn lines(results: &Results) -> Result<Vec<(&'static str, String)>, CliError> {
    let mut lines = vec![("status", status(results))];
    lines.extend(steps(results).into_iter().map(|step| ("step", step)));
    lines.extend(origin(results));
    lines.push(("fields", fields(results)?));
    for table in results.tables() {
        lines.push(("table", described(&table)?));
    }
    let pictures = results.pictures();
    if let (Some(first), Some(last)) = (pictures.first(), pictures.last()) {
        let text = format!(
            "{} in pictures/, {} to {}",
            pictures.len(),
            file_name(first),
            file_name(last)
        );
        lines.push(("pictures", text));
    }
    let steps: Vec<String> = results.checkpoints().into_iter().map(count).collect();
    if !steps.is_empty() {
        lines.push(("checkpoints", format!("at step {}", steps.join(" and "))));
    }
    lines.extend(audit(results));
    Ok(lines)
}

/// Describes the steps of a run of several steps.
fn steps(results: &Results) -> Vec<String> {
    let list = results.value("/steps").and_then(|list| list.as_array());
    let described = list.into_iter().flatten().map(|step| {
        let name = step["name"].as_str().unwrap_or_default();
        let (Some(status), Some(start), Some(duration)) = (
            step["status"].as_str(),
            step["start"].as_f64(),
            step["duration"].as_f64(),
        ) else {
            return format!("{name}: not started");
        };
        let scheme = step["scheme"].as_str().unwrap_or_default();
        let times = [start, start + duration].map(|t| quantity(t, "s"));
        format!(
            "{name}: {status}; {scheme}, t = {} to {}",
            times[0], times[1]
        )
    });
    described.collect()
}

/// Describes a sweep: deck, keys and the table of its runs.
fn sweep(sweep: &SweepResults) -> Result<Exit, CliError> {
    let folder = sweep.folder().display();
    let mut text = format!("{folder}: parameter sweep of {}", sweep.deck_file());
    for (key, values) in sweep.keys() {
        text += &format!("\n  {:<12} {key} = {}", "key", values.join(", "));
    }
    let finished = sweep.runs().filter(
        |(_, results)| matches!(results, Some(results) if results.text("/status") == "finished"),
    );
    let (finished, runs) = (finished.count(), sweep.runs().count());
    text += &format!("\n  {:<12} {finished} of {runs} finished", "runs");
    if finished < runs {
        text += &format!("; resume the others with: pericles resume {folder}");
    }
    for line in sweep.table().lines() {
        text += &format!("\n  {line}");
    }
    console::print(format_args!("{text}"))?;
    Ok(Exit::Done)
}

/// Returns the progress of the run and, if it has not finished, how to continue.
fn status(results: &Results) -> String {
    let status = results.text("/status");
    let seconds = results.number("/progress/wall_seconds").unwrap_or(f64::NAN);
    let mut text = format!(
        "{status}; step {} of {}, {}, after {}",
        count(results.count("/progress/last_step")),
        count(results.count("/model/steps")),
        TimeAxis::of(results).stamp(results.number("/progress/t").unwrap_or_default()),
        duration(seconds),
    );
    let folder = results.folder().display();
    match status {
        "failed" => text += &format!("\n{:15}{}", "", results.text("/error")),
        "stopped" => text += &format!("; resume with `pericles resume {folder}`"),
        // Its process may have died: run.json is written at the start and at the end.
        "running" => {
            text = format!("running, or killed; if killed, resume with `pericles resume {folder}`")
        }
        _ => {}
    }
    text
}

fn origin(results: &Results) -> Vec<(&'static str, String)> {
    let overrides = results.texts("/deck/overrides");
    let overrides: String = overrides.map(|set| format!(" --set {set}")).collect();
    let source = match results.value("/deck") {
        Some(_) => ("deck", format!("{}{overrides}", results.text("/deck/file"))),
        None => (
            "model",
            "built by a program; stored in run.json under model_data".into(),
        ),
    };
    let used = results.count("/program/threads");
    vec![
        source,
        (
            "program",
            format!(
                "pericles {}, {}, {} on {}",
                results.text("/program/version"),
                results.text("/model/instruction_set"),
                threads(usize::try_from(used).unwrap_or_default()),
                results.text("/program/machine"),
            ),
        ),
        (
            "body",
            format!(
                "{}D, {} points, {} bonds (force kernel: {}), spacing {}, horizon {}",
                results.count("/model/dimension"),
                count(results.count("/model/points")),
                count(results.count("/model/bonds")),
                results.text("/model/operator"),
                quantity(results.number("/model/spacing").unwrap_or(f64::NAN), "m"),
                quantity(results.number("/model/horizon").unwrap_or(f64::NAN), "m"),
            ),
        ),
        (
            "time",
            format!(
                "{}, {} steps of {}",
                results.text("/model/scheme"),
                count(results.count("/model/steps")),
                quantity(results.number("/model/dt").unwrap_or(f64::NAN), "s"),
            ),
        ),
    ]
}

fn fields(results: &Results) -> Result<String, CliError> {
    let files = results.fields()?;
    let (Some(first), Some(last)) = (files.first(), files.last()) else {
        return Ok("none".into());
    };
    let names: Vec<String> = last
        .read()?
        .fields
        .into_iter()
        .map(|field| field.name)
        .collect();
    let size = |path: &Path| path.metadata().map_or(0, |data| data.len());
    Ok(format!(
        "{} output times from {} to {}, {}: {}; open fields.pvd in ParaView",
        files.len(),
        quantity(first.time, "s"),
        quantity(last.time, "s"),
        bytes(files.iter().map(|file| size(&file.path)).sum()),
        names.join(", ")
    ))
}

fn described(table: &Path) -> Result<String, CliError> {
    let data = read_csv(table)?;
    let columns: Vec<&str> = data.columns.iter().map(|column| column.name()).collect();
    Ok(format!(
        "{}, {} rows: {}",
        file_name(table),
        count(data.rows() as u64),
        columns.join(", ")
    ))
}

fn audit(results: &Results) -> Option<(&'static str, String)> {
    results.value("/audit").filter(|audit| audit.is_object())?;
    let energy = |name| {
        let value = results.number(&format!("/audit/{name}"));
        quantity(value.unwrap_or(f64::NAN), &results.unit_of(name))
    };
    Some((
        "energy",
        format!(
            "kinetic {}, elastic {}, dissipated {}, external work {}; balance error {}; {} bonds broken",
            energy("kinetic_energy"),
            energy("elastic_energy"),
            energy("dissipated_energy"),
            energy("external_work"),
            percent(results.number("/audit/energy_drift").unwrap_or(f64::NAN)),
            count(results.count("/audit/broken_bonds")),
        ),
    ))
}
