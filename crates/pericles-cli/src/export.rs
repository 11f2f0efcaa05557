//! `export`: convert the fields of a run to another format.

use pericles_run::units::count;
use pericles_run::{ExportFormat, Results};

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
    let (format, name) = match args.to {
        args::ExportFormat::Exodus => (ExportFormat::Exodus, "fields.exo"),
        args::ExportFormat::Vtkhdf => (ExportFormat::VtkHdf, "fields.vtkhdf"),
        args::ExportFormat::Csv => (ExportFormat::Csv, "fields-csv"),
        args::ExportFormat::Npz => (ExportFormat::Npz, "fields.npz"),
    };
    let path = args.out.clone().unwrap_or_else(|| args.dir.join(name));
    if path.symlink_metadata().is_ok() {
        return Err(CliError::FileExists { path });
    }
    let outputs = pericles_run::export(&results, format, &path)?;
    console::print(format_args!(
        "{}: {} output times",
        path.display(),
        count(outputs as u64)
    ))?;
    Ok(Exit::Done)
}
