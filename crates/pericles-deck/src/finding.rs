//! Findings: problems and warnings with their location in a deck.

use std::error::Error;
use std::fmt::{self, Display};

use miette::{Diagnostic, LabeledSpan, Severity, SourceCode};

use crate::caution::Caution;
use crate::fault::Fault;
use crate::source::Location;
use crate::subject::Subject;

/// An error in a deck.
pub type Problem = Finding<Fault>;

/// A warning about a deck.
pub type Warning = Finding<Caution>;

/// A finding at a location in a deck. The message says what was found; the help says what is allowed or what to do.
#[derive(Debug)]
pub struct Finding<S> {
    subject: S,
    at: Location,
}

impl<S: Subject> Finding<S> {
    pub(crate) fn new(subject: S, at: Location) -> Self {
        Self { subject, at }
    }

    /// Returns what was found.
    pub fn subject(&self) -> &S {
        &self.subject
    }

    /// Returns the location.
    pub fn location(&self) -> &Location {
        &self.at
    }

    /// Returns the finding in one line, for terminals without a graphical reporter: `file:line:column: what;
    /// what is allowed`.
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
        // The message is the subject's own, so that the next source is the subject's source.
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
