//! The folder that a command writes into.

use std::path::Path;

use pericles_io::{IoError, OutputFolder};

use crate::error::CliError;

/// The folder asked for; without one the first free of `./<deck's name><suffix>`, the same with `-2`, `-3` …
///
/// # Errors
/// A folder that exists, unless `force` lets its results be replaced; one that cannot be made.
pub(crate) fn output_folder(
    out: Option<&Path>,
    force: Option<bool>,
    deck: &Path,
    suffix: &str,
) -> Result<OutputFolder, CliError> {
    let help = match force {
        Some(_) => "choose another --out, or replace the results in it with --force",
        None => "choose another --out, or move the folder away",
    };
    let Some(path) = out else {
        let mut name = deck.file_stem().unwrap_or("run".as_ref()).to_owned();
        name.push(suffix);
        return Ok(OutputFolder::create_numbered(Path::new(".").join(name))?);
    };
    OutputFolder::create(path, force.unwrap_or(false)).map_err(|error| match error {
        IoError::FolderExists { path } => CliError::OutExists { path, help },
        other => other.into(),
    })
}
