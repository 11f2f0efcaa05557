//! Columns of a table over another column.

use pericles_io::{Axis, CsvData, Curve, LineChart, read_csv};
use pericles_run::{Results, RunError};

use crate::args::PlotArgs;
use crate::error::CliError;
use crate::exit::Exit;

/// Draws the columns `--y` over the column `--x`, by default over the time.
///
/// # Errors
/// No table contains all columns, or the chart cannot be written.
pub(super) fn plot(results: &Results, args: &PlotArgs) -> Result<Exit, CliError> {
    let x = args.x.as_deref().unwrap_or("time");
    let mut known = Vec::new();
    let mut tables = Vec::new();
    for path in results.tables() {
        let table = read_csv(path)?;
        known.extend(table.columns.iter().map(|column| column.name().to_owned()));
        tables.push(table);
    }
    let wanted = || std::iter::once(x).chain(args.y.iter().map(String::as_str));
    if let Some(unknown) = wanted().find(|name| !known.iter().any(|column| column == name)) {
        let listing = format!("the tables have the columns {}", known.join(", "));
        return Err(RunError::unknown("column", unknown, &known, &listing).into());
    }
    let has_all = |table: &&CsvData| wanted().all(|name| table.column(name).is_some());
    let Some(table) = tables.iter().find(has_all) else {
        let names: Vec<&str> = wanted().collect();
        return Err(CliError::NoCommonTable {
            columns: names.join(", "),
        });
    };
    let place = super::place(args)?;
    let name = format!("{}-over-{x}", args.y.join("-"));
    super::write(chart(table, x, &args.y), &name, &place, args)?;
    Ok(Exit::Done)
}

/// Returns the chart of columns of one table; curves of several columns are named in the legend.
fn chart(table: &CsvData, x: &str, y: &[String]) -> LineChart {
    let unit = |name: &str| {
        let mut columns = table.columns.iter();
        let column = columns.find(|column| column.name() == name);
        column.map_or("", |column| column.unit()).to_owned()
    };
    let plain = |name: &str| name.replace('_', " ");
    let first = y.first().map_or("", String::as_str);
    let upward = match y.len() {
        1 => plain(first),
        _ => "value".into(),
    };
    let chart = LineChart::new(Axis::new(plain(x), unit(x)), Axis::new(upward, unit(first)));
    let values = |name: &str| table.column(name).unwrap_or_default();
    y.iter().fold(chart, |chart, name| {
        let label = match y.len() {
            1 => String::new(),
            _ => plain(name),
        };
        chart.curve(Curve::line(label, values(x), values(name)))
    })
}
