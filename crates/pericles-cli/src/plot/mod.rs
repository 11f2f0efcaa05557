//! `plot`: pictures of fields and charts of histories, drawn again from an output folder.

mod fields;

use std::path::{Path, PathBuf};

use pericles_io::IoError;
use pericles_run::{Results, RunError, file_name};

use crate::args::PlotArgs;
use crate::charts::{self, Chart};
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::text_chart::TextChart;

/// Draws what is asked for; without a field or a column the pictures of the last state and the charts of all tables.
///
/// # Errors
/// A folder without results, files of it that are damaged, fields or columns that it has not, pictures that cannot be written.
pub(crate) fn plot(args: &PlotArgs) -> Result<Exit, CliError> {
    let results = Results::open(&args.dir)?;
    let everything = args.fields.is_empty() && args.columns.is_empty();
    let charts = if everything || !args.columns.is_empty() {
        charts_of(&results, &args.columns)?
    } else {
        Vec::new()
    };
    if args.terminal {
        // Pictures of fields need pixels.
        for (_, chart) in &charts {
            console::print(format_args!("{}", TextChart::of(chart)))?;
        }
        return Ok(Exit::Done);
    }
    let place = args.out.clone().unwrap_or_else(|| args.dir.join("plots"));
    std::fs::create_dir_all(&place).map_err(|error| IoError::writing(&place, error))?;
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
        chart.drawn().width(args.width).write(&path)?;
        written.push(path);
    }
    for path in &written {
        console::print(format_args!("{}", path.display()))?;
    }
    Ok(Exit::Done)
}

/// The charts of all tables, or of the columns that are asked for, with the names of their tables.
fn charts_of(results: &Results, columns: &[String]) -> Result<Vec<(String, Chart)>, CliError> {
    let stem = |table: &Path| file_name(table).trim_end_matches(".csv").to_owned();
    let (mut charts, mut known) = (Vec::new(), Vec::new());
    for table in results.tables() {
        let found = charts::of_table(&table, |column| {
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
            &format!("the tables have {}", known.join(", ")),
        )
        .into()),
        None => Ok(charts),
    }
}
