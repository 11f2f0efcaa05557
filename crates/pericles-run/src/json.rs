//! JSON files of runs, and tables of text.

use std::io::Write;
use std::path::Path;

use pericles_io::{IoError, csv_row, write_atomically};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::RunError;

/// Writes a value as a JSON file with indentation, atomically. NaN and infinities become null.
///
/// # Errors
/// The file cannot be written.
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<(), RunError> {
    let text = serde_json::to_string_pretty(value)?;
    Ok(write_atomically(path, |file| writeln!(file, "{text}"))?)
}

/// Reads a value from a JSON file.
///
/// # Errors
/// The file cannot be read or does not contain such a value.
pub(crate) fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, RunError> {
    let text = std::fs::read_to_string(path).map_err(|error| IoError::reading(path, error))?;
    serde_json::from_str(&text).map_err(|error| RunError::Damaged {
        path: path.to_owned(),
        reason: error.to_string(),
    })
}

/// Writes rows of cells as a CSV table, atomically.
///
/// # Errors
/// The file cannot be written.
pub(crate) fn write_rows(path: &Path, rows: &[Vec<String>]) -> Result<(), RunError> {
    Ok(write_atomically(path, |file| {
        let mut rows = rows.iter();
        rows.try_for_each(|row| file.write_all(csv_row(row).as_bytes()))
    })?)
}
