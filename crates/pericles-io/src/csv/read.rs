//! Reading of CSV tables, for tests and studies.

use std::fs;
use std::path::Path;

use super::Column;
use crate::IoError;

/// The content of a CSV table.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CsvData {
    /// Names and units of the columns.
    pub columns: Vec<Column>,
    /// One vector per column, all of equal length; empty cells are NaN.
    pub values: Vec<Vec<f64>>,
}

impl CsvData {
    /// Returns the values of the first column with this name; see [`Column::is_named`].
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let mut columns = self.columns.iter();
        let index = columns.position(|column| column.is_named(name))?;
        Some(&self.values[index])
    }

    /// Returns the number of rows below the header.
    pub fn rows(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }
}

/// Reads a table of numbers; integers are read as reals.
pub fn read_csv(path: impl AsRef<Path>) -> Result<CsvData, IoError> {
    let path = path.as_ref();
    let text = fs::read_to_string(path).map_err(|source| match source.kind() {
        std::io::ErrorKind::InvalidData => IoError::damaged(path, "it is not UTF-8 text"),
        _ => IoError::reading(path, source),
    })?;
    let mut lines = text.lines().enumerate();
    let header = lines
        .next()
        .and_then(|(_, line)| split_quoted(line))
        .ok_or_else(|| IoError::damaged(path, "it has no header row"))?;
    let columns: Vec<_> = header
        .iter()
        .map(|cell| Column::from_header(cell))
        .collect();
    let mut values = vec![Vec::new(); columns.len()];
    for (index, line) in lines {
        let row = index + 1;
        let count = line.split(',').count();
        if count != columns.len() {
            let expected = columns.len();
            let reason = format!("row {row} has {count} cells instead of {expected}");
            return Err(IoError::damaged(path, reason));
        }
        for (cell, column) in line.split(',').zip(&mut values) {
            column.push(match cell.trim() {
                "" => f64::NAN,
                text => text.parse().map_err(|_| {
                    IoError::damaged(
                        path,
                        format!("row {row} holds {text:?}, which is not a number"),
                    )
                })?,
            });
        }
    }
    Ok(CsvData { columns, values })
}

/// Splits a row with quoted cells; `None` if a quote is not closed.
fn split_quoted(line: &str) -> Option<Vec<String>> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    let mut characters = line.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '"' if quoted && characters.peek() == Some(&'"') => {
                characters.next();
                cells.last_mut()?.push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            _ => cells.last_mut()?.push(character),
        }
    }
    (!quoted).then_some(cells)
}
