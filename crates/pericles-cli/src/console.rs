//! Text on the standard output and error. A closed pipe is no error: what was to be said is dropped. Titles, names and file names come from users:
//! whatever they hold, no control character reaches a terminal.

use std::borrow::Cow;
use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};
use std::path::Path;

use pericles_io::{IoError, write_atomically};
use pericles_run::RunError;
use serde::Serialize;

/// Prints results on the standard output.
///
/// # Errors
/// Whatever but a closed pipe keeps them from being written.
pub(crate) fn print(text: Arguments<'_>) -> Result<(), IoError> {
    let mut out = io::stdout().lock();
    let text = text.to_string();
    match writeln!(out, "{}", printable(&text)).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => {
            written.map_err(|error| IoError::writing(Path::new("the standard output"), error))
        }
    }
}

/// Writes results as JSON to a file, or to the standard output for `-`.
///
/// # Errors
/// A file that cannot be written.
pub(crate) fn write_json(path: &Path, results: &impl Serialize) -> Result<(), RunError> {
    let text = serde_json::to_string_pretty(results)?;
    if path == Path::new("-") {
        return Ok(print(format_args!("{text}"))?);
    }
    Ok(write_atomically(path, |file| writeln!(file, "{text}"))?)
}

/// Says something on the standard error; nobody may be listening.
pub(crate) fn note(text: Arguments<'_>) {
    // There is no other place to report that this failed.
    let text = text.to_string();
    let _ = writeln!(io::stderr().lock(), "{}", printable(&text));
}

/// Prints a report with colours on the standard error; what it says of users' texts must have been made [`printable`].
pub(crate) fn note_in_colour(text: Arguments<'_>) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// A text with its control characters spelled out, such as `\u{1b}` for the one that terminals take commands after; line ends and tabs stay.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    let harmful = |c: char| c.is_control() && !matches!(c, '\n' | '\t');
    if !text.contains(harmful) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if harmful(character) {
            out.extend(character.escape_default());
        } else {
            out.push(character);
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_spelled_out() {
        assert_eq!(printable("ω dt\n\tµ"), "ω dt\n\tµ");
        // A command to the terminal, a carriage return over the line, a backspace, and a command of one character.
        assert_eq!(
            printable("a\u{1b}[2Jb\rc\u{8}d\u{9b}31m"),
            "a\\u{1b}[2Jb\\rc\\u{8}d\\u{9b}31m"
        );
    }
}
