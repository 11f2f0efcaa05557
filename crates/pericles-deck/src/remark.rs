//! What was found in a model: a problem or a warning, with the key it concerns.

use std::error::Error;
use std::fmt::{self, Display};

use crate::caution::Caution;
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::subject::Subject;

/// Something wrong in a model, for which it is refused.
pub type ModelProblem = Remark<Fault>;

/// Something odd in a model, with which a run may still be meant.
pub type ModelWarning = Remark<Caution>;

/// Something found in a model. It names the key it concerns; [`Deck::located`](crate::Deck::located) turns it into a finding that points into the text of
/// the deck.
#[derive(Debug, Clone)]
pub struct Remark<S> {
    keys: Vec<KeyPath>,
    subject: S,
}

/// The keys under which a deck may give one value, at least one: a deck that gives none of them is taken to leave out the last.
#[derive(Debug, Clone)]
pub struct Keys(Vec<KeyPath>);

impl From<KeyPath> for Keys {
    fn from(key: KeyPath) -> Self {
        Self(vec![key])
    }
}

impl From<&KeyPath> for Keys {
    fn from(key: &KeyPath) -> Self {
        key.clone().into()
    }
}

impl From<&str> for Keys {
    /// From keys joined by dots.
    fn from(dotted: &str) -> Self {
        KeyPath::from(dotted).into()
    }
}

impl<K: Into<KeyPath>> From<[K; 2]> for Keys {
    fn from(keys: [K; 2]) -> Self {
        Self(keys.map(Into::into).into())
    }
}

impl<S: Subject> Remark<S> {
    /// A remark about a value.
    pub fn new(keys: impl Into<Keys>, subject: S) -> Self {
        let Keys(keys) = keys.into();
        Self { keys, subject }
    }

    /// The keys under which a deck may give the value, at least one.
    pub fn keys(&self) -> &[KeyPath] {
        &self.keys
    }

    /// What was found.
    pub fn subject(&self) -> &S {
        &self.subject
    }

    /// The parts: keys and subject.
    pub(crate) fn into_parts(self) -> (Vec<KeyPath>, S) {
        (self.keys, self.subject)
    }

    /// All in one line: `key: what was found; what is allowed`.
    pub fn line(&self) -> String {
        let keys: Vec<String> = self.keys.iter().map(KeyPath::dotted).collect();
        let keys = keys.join(" or ");
        match self.subject.advice() {
            Some(advice) => format!("{keys}: {self}; {advice}"),
            None => format!("{keys}: {self}"),
        }
    }
}

impl<S: Subject> Display for Remark<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Display::fmt(&self.subject, f)
    }
}

impl<S: Subject> Error for Remark<S> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.subject.source()
    }
}

/// Why a model cannot be discretised or assembled: at least one problem. The text of the error names every problem in a line of its own, as
/// `key: what is wrong; what is allowed`.
#[derive(Debug, thiserror::Error)]
#[error("{}", listed(problems))]
pub struct BuildError {
    problems: Vec<ModelProblem>,
}

impl BuildError {
    /// Of several problems.
    pub fn of(problems: Vec<ModelProblem>) -> Self {
        Self { problems }
    }

    /// What is wrong, key by key.
    pub fn problems(&self) -> &[ModelProblem] {
        &self.problems
    }

    /// Whether nothing is wrong with the model but that it needs more memory than it may have.
    pub fn is_too_large(&self) -> bool {
        let mut problems = self.problems.iter();
        problems.all(|problem| problem.subject.is_too_large())
    }

    /// The problems, by value.
    pub fn into_problems(self) -> Vec<ModelProblem> {
        self.problems
    }
}

impl From<ModelProblem> for BuildError {
    fn from(problem: ModelProblem) -> Self {
        Self::of(vec![problem])
    }
}

fn listed(problems: &[ModelProblem]) -> String {
    let lines: Vec<String> = problems.iter().map(Remark::line).collect();
    lines.join("\n")
}
