//! Columns of the tables of a run, paired at equal times.

use std::path::Path;

use pericles_io::{Column, CsvData, read_csv};

use crate::error::RunError;
use crate::results::{Results, file_name};

/// The column of times.
pub const TIME: &str = "time";

/// The tables of a run.
pub struct Tables(Vec<NamedTable>);

/// A table and the name of its file.
struct NamedTable {
    name: String,
    data: CsvData,
}

/// The values of two columns at the same times, in the order of the rows.
#[derive(Debug, Clone, PartialEq)]
pub struct PairOfColumns {
    /// Values of the first column.
    pub x: Vec<f64>,
    /// Values of the second column.
    pub y: Vec<f64>,
    /// Units of both.
    pub units: [String; 2],
    /// Which rows are left out because only one of the tables has their time.
    pub left_out: Option<String>,
}

impl Tables {
    /// Reads the tables of a run.
    ///
    /// # Errors
    /// A table is damaged.
    pub fn of(results: &Results) -> Result<Self, RunError> {
        let tables = results.tables();
        let tables = tables.iter().map(|path| NamedTable::read(path));
        tables.collect::<Result<_, _>>().map(Self)
    }

    /// Returns the name of the column as in its table, which may be given with dots (see [`Column::is_named`]).
    ///
    /// # Errors
    /// No table has the column.
    pub fn column(&self, name: &str) -> Result<&str, RunError> {
        let columns = self.0.iter().flat_map(|table| &table.data.columns);
        let columns: Vec<&Column> = columns.collect();
        let mut named = columns.iter().filter(|column| column.is_named(name));
        let column = named.next().map(|column| column.name());
        column.ok_or_else(|| {
            let known: Vec<&str> = columns.iter().map(|column| column.name()).collect();
            let listing = format!("the tables have the columns {}", known.join(", "));
            RunError::unknown("column", name, &known, &listing)
        })
    }

    /// Returns columns of one table if there is one with both, otherwise of the first tables that have them.
    ///
    /// # Errors
    /// A column does not exist, or two tables have too few equal times.
    pub fn pair(&self, x: &str, y: &str) -> Result<PairOfColumns, RunError> {
        let (x, y) = (self.column(x)?, self.column(y)?);
        let having = |names: &[&str]| {
            let has_all = |table: &&NamedTable| {
                let mut names = names.iter();
                names.all(|name| table.data.column(name).is_some())
            };
            self.0.iter().find(has_all)
        };
        if let Some(table) = having(&[x, y]) {
            return Ok(PairOfColumns {
                x: table.column(x).to_vec(),
                y: table.column(y).to_vec(),
                units: [x, y].map(|name| table.unit(name)),
                left_out: None,
            });
        }
        let (Some(one), Some(other)) = (having(&[x]), having(&[y])) else {
            return Err(RunError::NoCommonTimes {
                columns: format!("{x}, {y}"),
                reason: "no table has them".into(),
            });
        };
        let rows = rows_at_equal_times(one, other).map_err(|reason| RunError::NoCommonTimes {
            columns: format!("{x} ({}), {y} ({})", one.name, other.name),
            reason,
        })?;
        let [first, second] = [one, other].map(|table| table.data.rows());
        let left_out = (rows.len() < first.max(second)).then(|| {
            format!(
                "{} has {first} rows and {} has {second}; the {} rows with equal times are used",
                one.name,
                other.name,
                rows.len()
            )
        });
        let pick = |table: &NamedTable, name: &str, side: usize| {
            let column = table.column(name);
            rows.iter().map(|pair| column[pair[side]]).collect()
        };
        Ok(PairOfColumns {
            x: pick(one, x, 0),
            y: pick(other, y, 1),
            units: [one.unit(x), other.unit(y)],
            left_out,
        })
    }
}

impl NamedTable {
    fn read(path: &Path) -> Result<Self, RunError> {
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

/// Returns the numbers of the rows of two tables with equal times, in the order of time.
///
/// # Errors
/// A table has several rows per time, or fewer than two times are equal.
fn rows_at_equal_times(one: &NamedTable, other: &NamedTable) -> Result<Vec<[usize; 2]>, String> {
    for table in [one, other] {
        if table.column(TIME).windows(2).any(|pair| pair[0] >= pair[1]) {
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
        let tables = Tables(vec![
            table("a.csv", "step,time [s],u [m]\n0,0,1\n1,0.5,2\n2,1.0,3\n"),
            table("b.csv", "step,time [s],f [N]\n0,0,7\n2,1.0,8\n3,1.5,9\n"),
            table("c.csv", "step,time [s],g [N]\n0,0,7\n1,0.75,8\n"),
            table("d.csv", "step,time [s],crack,h\n0,0,1,7\n0,0,2,8\n"),
        ]);
        let pair = tables.pair("u", "f").unwrap();
        assert_eq!((pair.x, pair.y), (vec![1.0, 3.0], vec![7.0, 8.0]));
        assert_eq!(pair.units, ["m", "N"]);
        let left_out = pair.left_out.unwrap();
        assert!(
            left_out.contains("the 2 rows with equal times"),
            "{left_out}"
        );
        // Over the time, each column has the times of its own table.
        let pair = tables.pair("time", "f").unwrap();
        assert_eq!(pair.x, [0.0, 1.0, 1.5]);
        assert_eq!(pair.left_out, None);
        for (y, says) in [("g", "1 equal time(s)"), ("h", "several rows per time")] {
            let error = tables.pair("u", y).unwrap_err();
            assert!(error.to_string().contains(says), "{error}");
        }
    }
}
