//! What was found at one place of a deck: a problem or a warning.

use std::error::Error;
use std::fmt::{self, Display};

use miette::{Diagnostic, LabeledSpan, Severity, SourceCode};

use crate::caution::Caution;
use crate::fault::Fault;
use crate::source::Location;
use crate::subject::Subject;

/// Something wrong, for which the deck is refused.
pub type Problem = Finding<Fault>;

/// Something odd, with which a run may still be meant.
pub type Warning = Finding<Caution>;

/// Something found at one place of a deck. Its text says what; its help says what is allowed.
#[derive(Debug)]
pub struct Finding<S> {
    subject: S,
    at: Location,
}

impl<S: Subject> Finding<S> {
    pub(crate) fn new(subject: S, at: Location) -> Self {
        Self { subject, at }
    }

    /// What was found.
    pub fn subject(&self) -> &S {
        &self.subject
    }

    /// Where.
    pub fn location(&self) -> &Location {
        &self.at
    }

    /// All in one line, for terminals without a graphical reporter: `file:line:column: what; what is allowed`.
    pub fn line(&self) -> String {
        match self.subject.advice() {
            Some(advice) => format!("{}: {self}; {advice}", self.at),
            None => format!("{}: {self}", self.at),
        }
    }
}

impl<S: Subject> Display for Finding<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Display::fmt(&self.subject, f)
    }
}

impl<S: Subject> Error for Finding<S> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        // The finding's own text is the subject's: hand on what lies behind it.
        self.subject.source()
    }
}

impl<S: Subject> Diagnostic for Finding<S> {
    fn severity(&self) -> Option<Severity> {
        Some(S::SEVERITY)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        Some(Box::new(self.subject.advice()?))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(self.at.text())
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let label = self.at.label(self.subject.label());
        Some(Box::new(std::iter::once(label)))
    }
}
