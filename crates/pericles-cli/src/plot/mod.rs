//! `plot`: render pictures of fields and charts of time histories from an output folder.

mod curves;
mod fields;
mod sweep;

use std::path::{Path, PathBuf};

use pericles_io::{IoError, LineChart, PictureStyle};
use pericles_run::sweep::is_sweep;
use pericles_run::{Results, RunError, file_name};

use crate::args::PlotArgs;
use crate::charts::{self, Chart, Scales};
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::text_chart::TextChart;

pub(crate) use sweep::usual as usual_scalars;

/// Renders the requested fields and columns or, by default, pictures of the last state and charts of all tables and profiles.
///
/// # Errors
/// The folder has no results or damaged files, a field or column does not exist, or a picture cannot be written.
pub(crate) fn plot(args: &PlotArgs) -> Result<Exit, CliError> {
    if is_sweep(&args.dir) {
        return sweep::plot(args);
    }
    let results = Results::open(&args.dir)?;
    if !args.y.is_empty() {
        return curves::plot(&results, args);
    }
    let everything = args.fields.is_empty() && args.columns.is_empty();
    let charts = if everything || !args.columns.is_empty() {
        charts_of(&results, &args.columns)?
    } else {
        Vec::new()
    };
    if args.terminal {
        for (_, chart) in &charts {
            console::print(format_args!("{}", TextChart::of(chart)))?;
        }
        return Ok(Exit::Done);
    }
    let place = place(args)?;
    let style = args.style.style(PictureStyle::default())?;
    let mut written: Vec<PathBuf> = Vec::new();
    if everything || !args.fields.is_empty() {
        written.extend(fields::draw(&results, args, &place)?);
    }
    for (table, chart) in charts {
        let name = format!(
            "{table}-{}.{}",
            chart.name.replace(' ', "_"),
            args.format.ending()
        );
        let path = place.join(name);
        chart.drawn().style(style).write(&path)?;
        written.push(path);
    }
    let tables = results.tables().into_iter();
    for table in tables.filter(|table| everything && stem(table).starts_with("profile_")) {
        if let Some(chart) = charts::of_profile(&table)? {
            let path = place.join(format!("{}.{}", stem(&table), args.format.ending()));
            chart.style(style).write(&path)?;
            written.push(path);
        }
    }
    for path in &written {
        console::print(format_args!("{}", path.display()))?;
    }
    Ok(Exit::Done)
}

/// Creates the folder of the pictures.
fn place(args: &PlotArgs) -> Result<PathBuf, IoError> {
    let place = args.out.clone().unwrap_or_else(|| args.dir.join("plots"));
    std::fs::create_dir_all(&place).map_err(|error| IoError::writing(&place, error))?;
    Ok(place)
}

/// Writes a chart into the folder of the pictures and prints its path; characters of the name that are not allowed in file names are
/// replaced.
fn write(chart: LineChart, name: &str, place: &Path, args: &PlotArgs) -> Result<(), CliError> {
    let plain = |c: char| match c.is_alphanumeric() || "+-.=_".contains(c) {
        true => c,
        false => '_',
    };
    let name: String = name.chars().map(plain).collect();
    let path = place.join(format!("{name}.{}", args.format.ending()));
    let style = args.style.style(PictureStyle::default())?;
    chart.style(style).write(&path)?;
    Ok(console::print(format_args!("{}", path.display()))?)
}

fn stem(table: &Path) -> String {
    file_name(table).trim_end_matches(".csv").to_owned()
}

/// Returns the charts of the requested columns, by default of all, with the names of their tables.
fn charts_of(results: &Results, columns: &[String]) -> Result<Vec<(String, Chart)>, CliError> {
    let scales = Scales::of(results);
    let (mut charts, mut known) = (Vec::new(), Vec::new());
    for table in results.tables() {
        let found = charts::of_table(&table, &scales, |column| {
            known.push(column.to_owned());
            columns.is_empty() || columns.iter().any(|wanted| wanted == column)
        })?;
        charts.extend(found.into_iter().map(|chart| (stem(&table), chart)));
    }
    match columns.iter().find(|column| !known.contains(column)) {
        Some(unknown) => Err(RunError::unknown(
            "column",
            unknown,
            &known,
            &format!("the tables have the columns {}", known.join(", ")),
        )
        .into()),
        None => Ok(charts),
    }
}
