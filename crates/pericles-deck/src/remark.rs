//! Remarks: problems and warnings about a model, with the key that they concern.

use std::error::Error;
use std::fmt::{self, Display};

use crate::caution::Caution;
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::subject::Subject;

/// An error in a model.
pub type ModelProblem = Remark<Fault>;

/// A warning about a model.
pub type ModelWarning = Remark<Caution>;

/// A problem or warning about a model, with the key that it concerns. [`Deck::located`](crate::Deck::located)
/// adds its location in the text of the deck.
#[derive(Debug, Clone)]
pub struct Remark<S> {
    keys: Vec<KeyPath>,
    subject: S,
}

/// The keys under which a deck may give a value, at least one. If a deck gives none of them, the last one
/// counts as missing.
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
    /// Parses keys joined by dots.
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
    /// Creates a remark about a value.
    pub fn new(keys: impl Into<Keys>, subject: S) -> Self {
        let Keys(keys) = keys.into();
        Self { keys, subject }
    }

    /// Returns the keys under which a deck may give the value, at least one.
    pub fn keys(&self) -> &[KeyPath] {
        &self.keys
    }

    /// Returns the remark with the start `from` of its keys replaced by `to`.
    #[must_use]
    pub fn moved(self, from: &KeyPath, to: &KeyPath) -> Self {
        let keys = self.keys.into_iter();
        let keys = keys.map(|key| key.moved(from, to).unwrap_or(key));
        Self {
            keys: keys.collect(),
            subject: self.subject,
        }
    }

    /// Returns what was found.
    pub fn subject(&self) -> &S {
        &self.subject
    }

    /// Returns keys and subject.
    pub(crate) fn into_parts(self) -> (Vec<KeyPath>, S) {
        (self.keys, self.subject)
    }

    /// Returns the remark in one line: `key: what was found; what is allowed`.
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

/// Errors of discretising or assembling a model, at least one. The message has one line per problem:
/// `key: what is wrong; what is allowed`.
#[derive(Debug, thiserror::Error)]
#[error("{}", listed(problems))]
pub struct BuildError {
    problems: Vec<ModelProblem>,
}

impl BuildError {
    /// Creates an error from several problems.
    pub fn of(problems: Vec<ModelProblem>) -> Self {
        Self { problems }
    }

    /// Returns the error with the start `from` of all keys replaced by `to`.
    #[must_use]
    pub fn moved(self, from: &KeyPath, to: &KeyPath) -> Self {
        let problems = self.problems.into_iter();
        Self::of(problems.map(|problem| problem.moved(from, to)).collect())
    }

    /// Returns the problems.
    pub fn problems(&self) -> &[ModelProblem] {
        &self.problems
    }

    /// Returns whether exceeding the memory limit is the only problem.
    pub fn is_too_large(&self) -> bool {
        let mut problems = self.problems.iter();
        problems.all(|problem| problem.subject.is_too_large())
    }

    /// Returns the problems by value.
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
