//! Columns of tables over another column.

use pericles_io::{Axis, Curve, LineChart};
use pericles_run::columns::{PairOfColumns, TIME, Tables};
use pericles_run::{Results, RunError};

use crate::args::PlotArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use pericles_run::TimeAxis;

/// Draws the columns `--y` over the column `--x`, by default over the time. Columns of different tables are drawn at the
/// times that both tables have.
///
/// # Errors
/// A column does not exist, two tables have too few equal times, or the chart cannot be written.
pub(super) fn plot(results: &Results, args: &PlotArgs) -> Result<Exit, CliError> {
    let tables = Tables::of(results)?;
    let x = tables.column(args.x.as_deref().unwrap_or(TIME))?;
    let ys: Result<Vec<&str>, RunError> = args.y.iter().map(|y| tables.column(y)).collect();
    let ys = ys?;
    let mut curves = Vec::new();
    for y in &ys {
        let pair = tables.pair(x, y)?;
        if let Some(left_out) = &pair.left_out {
            console::note(format_args!("note: {left_out}"));
        }
        curves.push(pair);
    }
    let place = super::place(args)?;
    let name = format!("{}-over-{x}", ys.join("-"));
    let along = (x == TIME).then(|| TimeAxis::of(results));
    super::write(chart(x, &ys, &curves, along), &name, &place, args)?;
    Ok(Exit::Done)
}

/// Returns the chart of columns; curves of several columns are named in the legend.
fn chart(x: &str, y: &[&str], curves: &[PairOfColumns], along: Option<TimeAxis>) -> LineChart {
    let plain = |name: &str| name.replace('_', " ");
    let first = y.first().copied().unwrap_or_default();
    let upward = match y.len() {
        1 => plain(first),
        _ => "value".into(),
    };
    let unit = |side: usize| {
        let mut units = curves.iter().map(|curve| curve.units[side].as_str());
        let first = units.next().unwrap_or_default();
        // Values with different units have no common one.
        let unit = if units.all(|unit| unit == first) {
            first
        } else {
            ""
        };
        unit.to_owned()
    };
    let across = match &along {
        Some(along) => along.axis(),
        None => Axis::new(plain(x), unit(0)),
    };
    let chart = LineChart::new(across, Axis::new(upward, unit(1)));
    y.iter().zip(curves).fold(chart, |chart, (name, curve)| {
        let label = match y.len() {
            1 => String::new(),
            _ => plain(name),
        };
        match &along {
            Some(along) => chart.curve(Curve::line(label, &along.scaled(&curve.x), &curve.y)),
            None => chart.curve(Curve::line(label, &curve.x, &curve.y)),
        }
    })
}
