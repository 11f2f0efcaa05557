//! JSON files of runs.

use std::io::Write;
use std::path::Path;

use pericles_io::write_atomically;
use serde::Serialize;

use crate::error::RunError;

/// Writes a value as a JSON file with indentation, atomically. NaN and infinities become null.
///
/// # Errors
/// The file cannot be written.
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<(), RunError> {
    let text = serde_json::to_string_pretty(value)?;
    Ok(write_atomically(path, |file| writeln!(file, "{text}"))?)
}
