//! Why a deck cannot be used.

use std::path::PathBuf;

use miette::{Diagnostic, LabeledSpan, SourceCode};

use crate::fault::Fault;
use crate::finding::Problem;

/// Why a deck cannot be used.
///
/// The text of the error names every problem as `file:line:column: what is wrong; what is allowed`. A program with a graphical reporter
/// hands it the [`problems`](Self::problems) one by one: each carries the text it points into.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DeckError {
    /// The file cannot be read.
    #[error("cannot read the deck {}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: std::io::Error,
    },
    /// The deck is refused.
    #[error("{}", listed(problems))]
    Refused {
        /// At least one problem, in the order of the text.
        problems: Vec<Problem>,
    },
}

impl DeckError {
    /// A refusal; problems are put into the order of the text.
    pub(crate) fn refused(mut problems: Vec<Problem>) -> Self {
        problems.sort_by_key(|problem| problem.location().order());
        Self::Refused { problems }
    }

    /// What is wrong, place by place; empty if the file cannot be read.
    pub fn problems(&self) -> &[Problem] {
        match self {
            Self::Refused { problems } => problems,
            Self::Unreadable { .. } => &[],
        }
    }

    /// Whether nothing is wrong with the deck but that it needs more memory than it may have.
    pub fn is_too_large(&self) -> bool {
        let too_large = |problem: &Problem| {
            matches!(
                problem.subject(),
                Fault::TooLarge { .. } | Fault::LongHistory { .. } | Fault::LargeFile { .. }
            )
        };
        !self.problems().is_empty() && self.problems().iter().all(too_large)
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
            let lines: Vec<String> = several
                .iter()
                .map(|problem| format!("\n  {}", problem.line()))
                .collect();
            format!("{} problems{}", several.len(), lines.concat())
        }
    }
}
