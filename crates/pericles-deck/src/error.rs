//! Errors of reading a deck.

use std::path::PathBuf;

use miette::{Diagnostic, LabeledSpan, SourceCode};

use crate::finding::Problem;

/// Errors of reading a deck.
///
/// The message lists every problem as `file:line:column: what is wrong; what is allowed`. For graphical
/// reporters, each of the [`problems`](Self::problems) carries its source text.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DeckError {
    /// The file cannot be read.
    #[error("cannot read the deck {}: {reason}", path.display())]
    Unreadable {
        /// Path of the file.
        path: PathBuf,
        /// The reason.
        reason: std::io::Error,
    },
    /// The deck has errors.
    #[error("{}", listed(problems))]
    Rejected {
        /// At least one problem, in the order of the text.
        problems: Vec<Problem>,
    },
}

impl DeckError {
    /// Largest number of problems that a message lists.
    pub const SHOWN: usize = 50;

    /// Sorts the problems into the order of the text.
    pub(crate) fn rejected(mut problems: Vec<Problem>) -> Self {
        problems.sort_by_key(|problem| problem.location().order());
        Self::Rejected { problems }
    }

    /// Returns the problems in the order of the text; empty if the file cannot be read.
    pub fn problems(&self) -> &[Problem] {
        match self {
            Self::Rejected { problems } => problems,
            Self::Unreadable { .. } => &[],
        }
    }

    /// Returns whether exceeding the memory limit is the only problem.
    pub fn is_too_large(&self) -> bool {
        let mut problems = self.problems().iter();
        !self.problems().is_empty() && problems.all(|problem| problem.subject().is_too_large())
    }
}

impl Diagnostic for DeckError {
    fn source_code(&self) -> Option<&dyn SourceCode> {
        match self.problems() {
            [problem] => problem.source_code(),
            _ => None,
        }
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        match self.problems() {
            [problem] => problem.labels(),
            _ => None,
        }
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn Diagnostic> + 'a>> {
        match self.problems() {
            [] | [_] => None,
            several => Some(Box::new(several.iter().map(|p| p as &dyn Diagnostic))),
        }
    }
}

fn listed(problems: &[Problem]) -> String {
    match problems {
        [problem] => problem.line(),
        several => {
            let shown = several.iter().take(DeckError::SHOWN);
            let mut text = format!("{} problems", several.len());
            text.extend(shown.map(|problem| format!("\n  {}", problem.line())));
            let left = several.len().saturating_sub(DeckError::SHOWN);
            if left > 0 {
                text += &format!("\n  and {left} more");
            }
            text
        }
    }
}
