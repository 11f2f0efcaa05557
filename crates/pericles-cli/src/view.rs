//! `view`: show the fields of a run in the browser.

use std::path::Path;
use std::process::{Command, Stdio};

use pericles_run::{ExportFormat, Results, export};

use crate::args::ViewArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::export::report;

/// Writes the page of a run and opens it in the browser.
///
/// # Errors
/// The folder has no fields, or files cannot be read or written.
pub(crate) fn view(args: &ViewArgs) -> Result<Exit, CliError> {
    let results = Results::open(&args.dir)?;
    if !results.has_fields() {
        return Err(CliError::NoFields {
            folder: args.dir.clone(),
        });
    }
    let path = args.out.clone();
    let path = path.unwrap_or_else(|| args.dir.join("fields.html"));
    let selection = args.selection.selection();
    let exported = export(&results, ExportFormat::Html, &selection, &path)?;
    report(&exported, &path)?;
    if !args.no_open && !opened(&path) {
        console::note(format_args!(
            "No browser was found. Open the file in a browser, on this or another computer; it needs no other files."
        ));
    }
    Ok(Exit::Done)
}

/// Opens a file in the browser of the system; returns whether that succeeded.
fn opened(path: &Path) -> bool {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.into());
    let mut command = match std::env::consts::OS {
        "macos" => Command::new("open"),
        "windows" => Command::new("explorer"),
        _ => {
            let has_display = |name: &str| std::env::var_os(name).is_some_and(|it| !it.is_empty());
            if !["DISPLAY", "WAYLAND_DISPLAY"].into_iter().any(has_display) {
                return false;
            }
            Command::new("xdg-open")
        }
    };
    let quiet = command.arg(path).stdin(Stdio::null());
    let quiet = quiet.stdout(Stdio::null()).stderr(Stdio::null());
    match (quiet.status(), std::env::consts::OS) {
        // Its exit status is not zero after success.
        (started, "windows") => started.is_ok(),
        (started, _) => started.is_ok_and(|status| status.success()),
    }
}
