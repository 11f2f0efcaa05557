//! Columns of tables over another column.

use std::path::Path;

use pericles_io::{Axis, Column, CsvData, Curve, LineChart, read_csv};
use pericles_run::{Results, RunError, file_name};

use crate::args::PlotArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use pericles_run::TimeAxis;

/// The column of times.
const TIME: &str = "time";

/// A table and the name of its file.
struct NamedTable {
    name: String,
    data: CsvData,
}

/// Draws the columns `--y` over the column `--x`, by default over the time. Columns of different tables are drawn at the
/// times that both tables have.
///
/// # Errors
/// A column does not exist, two tables have too few equal times, or the chart cannot be written.
pub(super) fn plot(results: &Results, args: &PlotArgs) -> Result<Exit, CliError> {
    let tables: Result<Vec<NamedTable>, CliError> = results
        .tables()
        .iter()
        .map(|path| NamedTable::read(path))
        .collect();
    let tables = tables?;
    let columns = tables.iter().flat_map(|table| &table.data.columns);
    let columns: Vec<&Column> = columns.collect();
    let column = |name: &str| {
        let mut named = columns.iter().filter(|column| column.is_named(name));
        let column = named.next().map(|column| column.name());
        column.ok_or_else(|| {
            let known: Vec<&str> = columns.iter().map(|column| column.name()).collect();
            let listing = format!("the tables have the columns {}", known.join(", "));
            RunError::unknown("column", name, &known, &listing)
        })
    };
    let x = column(args.x.as_deref().unwrap_or(TIME))?;
    let ys: Result<Vec<&str>, RunError> = args.y.iter().map(|y| column(y)).collect();
    let ys = ys?;
    let mut curves = Vec::new();
    for y in &ys {
        curves.push(PairOfColumns::of(&tables, x, y)?);
    }
    let place = super::place(args)?;
    let name = format!("{}-over-{x}", ys.join("-"));
    let along = (x == TIME).then(|| TimeAxis::of(results));
    super::write(chart(x, &ys, &curves, along), &name, &place, args)?;
    Ok(Exit::Done)
}

impl NamedTable {
    fn read(path: &Path) -> Result<Self, CliError> {
        Ok(Self {
            name: file_name(path),
            data: read_csv(path)?,
        })
    }

    fn unit(&self, name: &str) -> String {
        let mut columns = self.data.columns.iter();
        let column = columns.find(|column| column.name() == name);
        column.map_or("", |column| column.unit()).to_owned()
    }

    fn column(&self, name: &str) -> &[f64] {
        self.data.column(name).unwrap_or_default()
    }
}

/// The values of two columns at the same times.
struct PairOfColumns {
    x: Vec<f64>,
    y: Vec<f64>,
    units: [String; 2],
}

impl PairOfColumns {
    /// Returns columns of one table if there is one with both, else of the first tables that have them.
    fn of(tables: &[NamedTable], x: &str, y: &str) -> Result<Self, CliError> {
        let having = |names: &[&str]| {
            let has_all = |table: &&NamedTable| {
                let mut names = names.iter();
                names.all(|name| table.data.column(name).is_some())
            };
            tables.iter().find(has_all)
        };
        if let Some(table) = having(&[x, y]) {
            return Ok(Self {
                x: table.column(x).to_vec(),
                y: table.column(y).to_vec(),
                units: [x, y].map(|name| table.unit(name)),
            });
        }
        let (Some(one), Some(other)) = (having(&[x]), having(&[y])) else {
            return Err(CliError::NoCommonTimes {
                columns: format!("{x}, {y}"),
                reason: "no table has them".into(),
            });
        };
        let rows = rows_at_equal_times(one, other).map_err(|reason| CliError::NoCommonTimes {
            columns: format!("{x} ({}), {y} ({})", one.name, other.name),
            reason,
        })?;
        let [first, second] = [one, other].map(|table| table.data.rows());
        if rows.len() < first.max(second) {
            console::note(format_args!(
                "note: {} has {first} rows and {} has {second}; drawn are the {} rows with equal times",
                one.name,
                other.name,
                rows.len()
            ));
        }
        let pick = |table: &NamedTable, name: &str, side: usize| {
            let column = table.column(name);
            rows.iter().map(|pair| column[pair[side]]).collect()
        };
        Ok(Self {
            x: pick(one, x, 0),
            y: pick(other, y, 1),
            units: [one.unit(x), other.unit(y)],
        })
    }
}

/// Returns the numbers of the rows of two tables with equal times, in the order of time.
///
/// # Errors
/// A table has several rows per time, or fewer than two times are equal.
fn rows_at_equal_times(one: &NamedTable, other: &NamedTable) -> Result<Vec<[usize; 2]>, String> {
    for table in [one, other] {
        if table
            .column("time")
            .windows(2)
            .any(|pair| pair[0] >= pair[1])
        {
            return Err(format!(
                "{} has several rows per time, such as one per crack",
                table.name
            ));
        }
    }
    let (first, second) = (one.column(TIME), other.column(TIME));
    let mut rows = Vec::new();
    let mut k = 0;
    for (row, time) in first.iter().enumerate() {
        while second.get(k).is_some_and(|earlier| earlier < time) {
            k += 1;
        }
        if second.get(k) == Some(time) {
            rows.push([row, k]);
        }
    }
    match rows.len() {
        0 | 1 => Err(format!(
            "the tables have {} equal time(s); at least 2 are needed",
            rows.len()
        )),
        _ => Ok(rows),
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn table(name: &str, text: &str) -> NamedTable {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join(name);
        std::fs::write(&path, text).unwrap();
        NamedTable::read(&path).unwrap()
    }

    #[test]
    fn columns_of_different_tables_are_paired_at_equal_times() {
        let tables = [
            table("a.csv", "step,time [s],u [m]\n0,0,1\n1,0.5,2\n2,1.0,3\n"),
            table("b.csv", "step,time [s],f [N]\n0,0,7\n2,1.0,8\n3,1.5,9\n"),
            table("c.csv", "step,time [s],g [N]\n0,0,7\n1,0.75,8\n"),
            table("d.csv", "step,time [s],crack,h\n0,0,1,7\n0,0,2,8\n"),
        ];
        let pair = PairOfColumns::of(&tables, "u", "f").unwrap();
        assert_eq!((pair.x, pair.y), (vec![1.0, 3.0], vec![7.0, 8.0]));
        assert_eq!(pair.units, ["m", "N"]);
        // Over the time, each column has the times of its own table.
        let pair = PairOfColumns::of(&tables, "time", "f").unwrap();
        assert_eq!(pair.x, [0.0, 1.0, 1.5]);
        for (y, says) in [("g", "1 equal time(s)"), ("h", "several rows per time")] {
            let error = PairOfColumns::of(&tables, "u", y).err().unwrap();
            assert!(error.to_string().contains(says), "{error}");
        }
    }
}
