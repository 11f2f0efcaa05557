//! Columns, their header, and the cells of a row.

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
    /// A column of real numbers; the unit is empty for a pure number.
    pub fn real(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            integer: false,
        }
    }

    /// A column of whole numbers.
    pub fn integer(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: String::new(),
            integer: true,
        }
    }

    /// The name, without the unit.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The unit; empty for a pure number.
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
    /// A real number; NaN leaves the cell empty.
    Real(f64),
    /// A whole number.
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

/// The header of a table, with its line end.
pub(super) fn header_row(path: &Path, columns: &[Column]) -> Result<String, IoError> {
    let cells: Vec<_> = columns.iter().map(Column::header).collect();
    if cells.is_empty() || cells.iter().any(|cell| cell.contains(['\n', '\r'])) {
        return Err(IoError::Unsuitable {
            path: path.to_path_buf(),
            reason: "a table needs at least one column, and names of one line".into(),
        });
    }
    Ok(csv_row(&cells))
}

/// A row of texts with its line end, those with commas, quotes or line ends quoted as in RFC 4180.
pub fn csv_row(cells: &[String]) -> String {
    let quoted = cells.iter().map(|cell| {
        if cell.contains(['"', ',', '\n', '\r']) {
            format!("\"{}\"", cell.replace('"', "\"\""))
        } else {
            cell.clone()
        }
    });
    quoted.collect::<Vec<_>>().join(",") + "\n"
}
