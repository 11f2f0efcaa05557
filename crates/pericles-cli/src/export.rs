//! `export`: convert the fields of a run to another format.

use std::path::Path;

use pericles_run::units::count;
use pericles_run::{ExportFormat, Exported, Results};

use crate::args::{self, ExportArgs};
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

/// Converts the fields of a run.
///
/// # Errors
/// The folder has no fields, the file already exists, or files cannot be read or written.
pub(crate) fn export(args: &ExportArgs) -> Result<Exit, CliError> {
    let results = Results::open(&args.dir)?;
    if !results.has_fields() {
        return Err(CliError::NoFields {
            folder: args.dir.clone(),
        });
    }
    let format = match args.to {
        args::ExportFormat::Exodus => ExportFormat::Exodus,
        args::ExportFormat::Vtkhdf => ExportFormat::VtkHdf,
        args::ExportFormat::Csv => ExportFormat::Csv,
        args::ExportFormat::Npz => ExportFormat::Npz,
        args::ExportFormat::Html => ExportFormat::Html,
    };
    let path = args
        .out
        .clone()
        .unwrap_or_else(|| args.dir.join(format.file_name()));
    if path.symlink_metadata().is_ok() {
        return Err(CliError::FileExists { path });
    }
    let exported = pericles_run::export(&results, format, &args.selection.selection(), &path)?;
    report(&exported, &path)?;
    Ok(Exit::Done)
}

/// Prints the path, the number of output times and what was left out.
pub(crate) fn report(exported: &Exported, path: &Path) -> Result<(), CliError> {
    for note in &exported.notes {
        console::note(format_args!("{note}"));
    }
    console::print(format_args!(
        "{}: {} output times",
        path.display(),
        count(exported.outputs as u64)
    ))?;
    Ok(())
}
