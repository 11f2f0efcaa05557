//! Columns, their headers, and the cells of a row.

use std::path::Path;

use crate::IoError;

/// One column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    pub(super) name: String,
    unit: String,
    pub(super) integer: bool,
}

impl Column {
    /// Creates a column of real numbers; `unit` is empty for dimensionless values.
    pub fn real(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            integer: false,
        }
    }

    /// Creates a column of integers.
    pub fn integer(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: String::new(),
            integer: true,
        }
    }

    /// Returns the name, without the unit.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns whether the column has this name, in which dots may separate the source from its component and the table
    /// from both: `tip.u_x` is the column `tip_u_x`, and `reaction.top.y` the column `top_y`.
    pub fn is_named(&self, name: &str) -> bool {
        /// Words for the tables in names.
        const TABLES: [&str; 5] = ["history", "probe", "reaction", "impactor", "quantity"];
        let joined = |name: &str| self.name == name.replace('.', "_");
        let in_table = |(table, rest): (&str, &str)| TABLES.contains(&table) && joined(rest);
        self.name == name
            || name.contains('.') && (joined(name) || name.split_once('.').is_some_and(in_table))
    }

    /// Returns the unit; empty for dimensionless values.
    pub fn unit(&self) -> &str {
        &self.unit
    }

    fn header(&self) -> String {
        if self.unit.is_empty() {
            self.name.clone()
        } else {
            format!("{} [{}]", self.name, self.unit)
        }
    }

    pub(super) fn from_header(cell: &str) -> Self {
        let cell = match cell.strip_prefix('\'') {
            Some(name) if is_formula(name) => name,
            _ => cell,
        };
        match cell
            .strip_suffix(']')
            .and_then(|rest| rest.rsplit_once(" ["))
        {
            Some((name, unit)) => Self::real(name, unit),
            None => Self::real(cell, ""),
        }
    }
}

/// One value of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell {
    /// A real number; NaN is written as an empty cell.
    Real(f64),
    /// An integer.
    Integer(i64),
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Self::Real(value)
    }
}

impl From<i64> for Cell {
    fn from(value: i64) -> Self {
        Self::Integer(value)
    }
}

/// Returns the header row with its line ending.
pub(super) fn header_row(path: &Path, columns: &[Column]) -> Result<String, IoError> {
    let cells: Vec<_> = columns.iter().map(Column::header).collect();
    if cells.is_empty() || cells.iter().any(|cell| cell.contains(['\n', '\r'])) {
        return Err(IoError::Unsuitable {
            path: path.to_path_buf(),
            reason: "a table needs at least one column, and column names without line breaks"
                .into(),
        });
    }
    Ok(csv_row(&cells))
}

/// Returns whether a spreadsheet would evaluate the text: it begins like a formula and is not a number, with
/// or without a unit.
fn is_formula(cell: &str) -> bool {
    let number = || {
        let first = cell.split_whitespace().next().unwrap_or_default();
        first.parse::<f64>().is_ok()
    };
    cell.starts_with(['=', '@', '+', '-']) && !number()
}

/// Formats a row of texts with its line ending; cells with commas, quotes or line breaks are quoted (RFC
/// 4180). Text that a spreadsheet would evaluate as a formula is prefixed with an apostrophe, which marks it
/// as text.
pub fn csv_row(cells: &[String]) -> String {
    let quoted = cells.iter().map(|cell| {
        let cell = match is_formula(cell) {
            true => format!("'{cell}"),
            false => cell.clone(),
        };
        if cell.contains(['"', ',', '\n', '\r']) {
            format!("\"{}\"", cell.replace('"', "\"\""))
        } else {
            cell
        }
    });
    quoted.collect::<Vec<_>>().join(",") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_separate_the_parts_of_a_name() {
        let column = Column::real("top_y", "N");
        for name in ["top_y", "top.y", "reaction.top.y", "reaction.top_y"] {
            assert!(column.is_named(name), "{name}");
        }
        for name in ["top", "y", "top.y.x", "force.top.y", "audit.top_y", "Top_y"] {
            assert!(!column.is_named(name), "{name}");
        }
        assert!(Column::real("a.b_u_x", "m").is_named("a.b_u_x"));
    }

    #[test]
    fn cells_that_look_like_formulas_are_marked_as_text() {
        let names = [
            "=HYPERLINK(1)",
            "@SUM(1)",
            "+top",
            "-2+3|cmd",
            "top",
            "'quoted",
        ];
        let row = csv_row(&names.map(String::from));
        assert_eq!(row, "'=HYPERLINK(1),'@SUM(1),'+top,'-2+3|cmd,top,'quoted\n");
        for (cell, name) in row.trim_end().split(',').zip(names) {
            assert_eq!(Column::from_header(cell).name(), name);
        }
        let numbers = ["-1 mm", "+2.5", "-3e-4", "-inf"];
        assert_eq!(
            csv_row(&numbers.map(String::from)),
            "-1 mm,+2.5,-3e-4,-inf\n"
        );
    }
}
