//! Text output. A closed pipe is not an error: further output is dropped. Titles, names and file names come from
//! users, so control characters are escaped before they reach a terminal.

use std::borrow::Cow;
use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};
use std::path::Path;

use pericles_deck::is_invisible;
use pericles_io::IoError;
use pericles_run::RunError;
use serde::Serialize;

/// Prints a line on standard output.
///
/// # Errors
/// Standard output cannot be written, except for a closed pipe.
pub(crate) fn print(text: Arguments<'_>) -> Result<(), IoError> {
    let mut out = io::stdout().lock();
    let text = text.to_string();
    match writeln!(out, "{}", printable(&text)).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written.map_err(|error| IoError::writing(Path::new("standard output"), error)),
    }
}

/// Writes results as JSON to a file, or to standard output for `-`.
///
/// # Errors
/// The file cannot be written.
pub(crate) fn write_json(path: &Path, results: &impl Serialize) -> Result<(), RunError> {
    if path == Path::new("-") {
        let text = serde_json::to_string_pretty(results)?;
        return Ok(print(format_args!("{text}"))?);
    }
    pericles_run::write_json(path, results)
}

/// Prints a line on standard error.
pub(crate) fn note(text: Arguments<'_>) {
    // A failed write to standard error cannot be reported.
    let text = text.to_string();
    let _ = writeln!(io::stderr().lock(), "{}", printable(&text));
}

/// Prints a coloured report on standard error; users' texts in it must have been made [`printable`].
pub(crate) fn note_in_colour(text: Arguments<'_>) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Returns the text with control and format characters escaped, such as `\u{1b}` for ESC; line ends and tabs are kept.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    let harmful = |c: char| is_invisible(c) && !matches!(c, '\n' | '\t');
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
    fn control_characters_are_escaped() {
        assert_eq!(printable("ω dt\n\tµ"), "ω dt\n\tµ");
        // An escape sequence, a carriage return, a backspace, and a single-character control sequence introducer.
        assert_eq!(
            printable("a\u{1b}[2Jb\rc\u{8}d\u{9b}31m"),
            "a\\u{1b}[2Jb\\rc\\u{8}d\\u{9b}31m"
        );
        // Reversed text, a zero-width blank and a byte order mark.
        assert_eq!(
            printable("a\u{202e}txt\u{200b}\u{feff}"),
            "a\\u{202e}txt\\u{200b}\\u{feff}"
        );
    }
}
