//! `info`: what an output folder holds.

use std::path::Path;

use pericles_io::read_csv;
use pericles_run::units::{bytes, count, duration, percent, quantity, threads};
use pericles_run::{Results, file_name};

use crate::args::InfoArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

/// Describes the results of a run.
///
/// # Errors
/// A folder that holds none, files of it that are damaged.
pub(crate) fn info(args: &InfoArgs) -> Result<Exit, CliError> {
    let results = Results::open(&args.dir)?;
    let mut lines = vec![("status", status(&results))];
    lines.extend(origin(&results));
    lines.push(("fields", fields(&results)?));
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
        lines.push(("checkpoints", format!("of step {}", steps.join(" and "))));
    }
    lines.extend(audit(&results));
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

/// How far the run came, and what to do if it did not come to its end.
pub(crate) fn status(results: &Results) -> String {
    let status = results.text("/status");
    let seconds = results.number("/progress/wall_seconds").unwrap_or(f64::NAN);
    let mut text = format!(
        "{status}; step {} of {}, t = {}, after {}",
        count(results.count("/progress/last_step")),
        count(results.count("/model/steps")),
        quantity(results.number("/progress/t").unwrap_or_default(), "s"),
        duration(seconds),
    );
    let folder = results.folder().display();
    match status {
        "failed" => text += &format!("\n{:15}{}", "", results.text("/error")),
        "stopped" => text += &format!("; go on with: pericles resume {folder}"),
        // Its process may have died: run.json is written at the start and at the end.
        "running" => text = format!("running, or ended by force; then: pericles resume {folder}"),
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
            "written by a program; run.json has it under model_data".into(),
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
                "{}D, {} points, {} bonds as a {}, spacing {}, horizon {}",
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
        "{} states from {} to {}, {}: {}; open fields.pvd in ParaView",
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
        quantity(value.unwrap_or(f64::NAN), "J")
    };
    Some((
        "audit",
        format!(
            "kinetic {}, elastic {}, dissipated {}, work {}; off by {}; {} bonds broken",
            energy("kinetic_energy"),
            energy("elastic_energy"),
            energy("dissipated_energy"),
            energy("external_work"),
            percent(results.number("/audit/energy_drift").unwrap_or(f64::NAN)),
            count(results.count("/audit/broken_bonds")),
        ),
    ))
}
