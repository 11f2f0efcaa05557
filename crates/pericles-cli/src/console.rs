//! Text on the standard output and error. A closed pipe is no error: what was to be said is dropped.

use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};
use std::path::Path;

use pericles_io::IoError;

use crate::error::CliError;

/// Prints results on the standard output.
///
/// # Errors
/// Whatever but a closed pipe keeps them from being written.
pub(crate) fn print(text: Arguments<'_>) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written.map_err(|error| {
            CliError::Io(IoError::writing(Path::new("the standard output"), error))
        }),
    }
}

/// Says something on the standard error; nobody may be listening.
pub(crate) fn note(text: Arguments<'_>) {
    // There is no other place to report that this failed.
    let _ = writeln!(io::stderr().lock(), "{text}");
}
