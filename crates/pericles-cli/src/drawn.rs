//! Errors as they look on a terminal, with the places in the deck marked. What comes from users holds no control characters: those of the report itself are
//! its colours.

use std::fmt::{self, Display, Formatter};

use miette::{Diagnostic, LabeledSpan, MietteHandler, ReportHandler, Severity, SourceCode};

use crate::console::printable;

/// A diagnostic as it looks on a terminal.
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
    fn a_drawn_error_holds_no_commands_to_the_terminal() {
        // One in a key that is read, one in the text, one in the name of the file.
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
