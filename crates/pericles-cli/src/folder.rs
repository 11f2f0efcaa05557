//! The output folder of a command.

use std::path::Path;

use pericles_io::{IoError, OutputFolder};

use crate::error::CliError;

/// Creates the requested folder or, by default, the first free one of `./<deck's name><suffix>` and the same with `-2`,
/// `-3`, ...
///
/// # Errors
/// The folder exists and `force` does not allow to replace its results, or it cannot be created.
pub(crate) fn output_folder(
    out: Option<&Path>,
    force: Option<bool>,
    deck: &Path,
    suffix: &str,
) -> Result<OutputFolder, CliError> {
    let help = match force {
        Some(_) => "choose another --out, or replace the results in it with --force",
        None => "choose another --out, or move the folder",
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
