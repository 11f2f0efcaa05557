//! Errors on a terminal, with the locations in the deck marked. Control characters in users' texts are escaped; those
//! of the report itself are its colours.

use std::fmt::{self, Display, Formatter};

use miette::{Diagnostic, LabeledSpan, MietteHandler, ReportHandler, Severity, SourceCode};

use crate::console::printable;

/// A diagnostic, formatted for a terminal.
pub(crate) struct Drawn<'a>(pub(crate) &'a dyn Diagnostic);

impl Display for Drawn<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let printable = Printable {
            inner: self.0,
            message: printable(&self.0.to_string()).into_owned(),
        };
        MietteHandler::default().debug(&printable, f)
    }
}

/// A diagnostic without control characters.
struct Printable<'a> {
    inner: &'a dyn Diagnostic,
    message: String,
}

impl fmt::Debug for Printable<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl Display for Printable<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Printable<'_> {}

impl Diagnostic for Printable<'_> {
    fn code<'b>(&'b self) -> Option<Box<dyn Display + 'b>> {
        self.inner.code()
    }

    fn severity(&self) -> Option<Severity> {
        self.inner.severity()
    }

    fn help<'b>(&'b self) -> Option<Box<dyn Display + 'b>> {
        let help = self.inner.help()?.to_string();
        Some(Box::new(printable(&help).into_owned()))
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.inner.labels()
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        // Decks show their text without control characters.
        self.inner.source_code()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles_deck::Deck;

    #[test]
    fn reported_errors_contain_no_terminal_commands() {
        // Control characters in a key, in the text and in the file name.
        let deck = "title = \"\u{9b}31m\"\n[\"bo\\u001b[2Jdy\"]\nshape = 1\n";
        let error = Deck::parse(deck, "a\u{1b}[1m.toml", &[]).unwrap_err();
        let drawn: String = error
            .problems()
            .iter()
            .map(|problem| Drawn(problem).to_string())
            .collect();
        assert!(drawn.contains("bo\\u{1b}[2Jdy"), "{drawn}");
        assert!(drawn.contains("a [1m.toml"), "{drawn}");
        assert!(
            !drawn.contains("\u{1b}[2J") && !drawn.contains('\u{9b}'),
            "{drawn}"
        );
    }
}
