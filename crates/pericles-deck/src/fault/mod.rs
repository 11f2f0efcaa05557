//! Errors in decks and models.

mod advice;
mod words;

use pericles::PericlesError;

use crate::wording::{bytes, count, names, shortened};

/// Kinds of errors.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Invalid TOML.
    #[error("not valid TOML: {message}")]
    Syntax {
        /// The parser's message.
        message: String,
    },
    /// An unknown key.
    #[error("unknown key `{}` in {table}", shortened(key))]
    UnknownKey {
        /// The key.
        key: String,
        /// The table that contains it.
        table: String,
        /// The most similar allowed key.
        nearest: Option<String>,
        /// The table to which it belongs.
        home: Option<&'static str>,
        /// All allowed keys.
        allowed: Vec<String>,
    },
    /// A missing required key.
    #[error("{table} requires `{key}`")]
    MissingKey {
        /// The key.
        key: String,
        /// Other names of the key.
        synonyms: Vec<String>,
        /// The table that requires it.
        table: String,
    },
    /// Several alternative keys, none of which is given.
    #[error("{table} requires one of {}", names(allowed))]
    MissingChoice {
        /// The table.
        table: String,
        /// The keys.
        allowed: Vec<String>,
    },
    /// Several mutually exclusive keys.
    #[error("{} are given together in {table}", names(given))]
    Exclusive {
        /// The keys found.
        given: Vec<String>,
        /// The table.
        table: String,
        /// The keys of which one is allowed.
        allowed: Vec<String>,
    },
    /// A key that is not allowed in combination with other keys.
    #[error("`{key}` is not allowed in {table}")]
    Misplaced {
        /// The key.
        key: String,
        /// The table.
        table: String,
        /// When it is allowed.
        allowed: String,
    },
    /// A value of the wrong type.
    #[error("expected {expected}, found {found} (`{value}`)")]
    WrongKind {
        /// The value as written.
        value: String,
        /// Its type.
        found: &'static str,
        /// The expected type.
        expected: String,
    },
    /// A string without a number, or a number that is NaN or infinite.
    #[error("`{value}` is not a number")]
    NotANumber {
        /// The value as written.
        value: String,
        /// The expected quantity.
        expected: String,
    },
    /// A number with a comma.
    #[error("`{value}` contains a comma")]
    Comma {
        /// The value as written.
        value: String,
    },
    /// An invalid expression.
    #[error("the expression `{}` cannot be used: {reason}", shortened(text))]
    BadExpression {
        /// The expression.
        text: String,
        /// What is wrong.
        reason: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// An invalid condition.
    #[error("the condition `{}` cannot be used: {reason}", shortened(text))]
    BadCondition {
        /// The condition.
        text: String,
        /// What is wrong.
        reason: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// An invalid mesh, surface or outline.
    #[error("{reason}")]
    BadMesh {
        /// What is wrong, with the file and the place in it.
        reason: String,
    },
    /// A pressure on a set without faces, or with faces inside the body.
    #[error("{}", words::no_faces(set, *inner))]
    NoFaces {
        /// The set.
        set: String,
        /// Number of its faces that lie between two elements.
        inner: usize,
    },
    /// A file that does not fit in memory.
    #[error("{reason}")]
    LargeFile {
        /// The file and the memory that it needs.
        reason: String,
    },
    /// A time function for an expression that already depends on time.
    #[error(
        "`{}` already depends on time and takes no time function",
        shortened(text)
    )]
    TwoCourses {
        /// The expression.
        text: String,
    },
    /// An unknown unit.
    #[error("unknown unit `{}` in `{value}`", shortened(unit))]
    UnknownUnit {
        /// The value as written.
        value: String,
        /// The unit.
        unit: String,
        /// The most similar unit.
        nearest: Option<String>,
        /// The expected quantity.
        expected: String,
    },
    /// A unit of the wrong dimension.
    #[error("`{value}` is not {expected}")]
    WrongUnit {
        /// The value as written.
        value: String,
        /// The expected quantity.
        expected: String,
        /// The expected quantity with an example.
        allowed: String,
    },
    /// A value out of range.
    #[error("`{value}` is out of range")]
    OutOfRange {
        /// The value as written.
        value: String,
        /// The allowed range.
        allowed: String,
    },
    /// An unknown word.
    #[error("unknown {what} `{value}`")]
    UnknownWord {
        /// The kind of thing that the word names.
        what: &'static str,
        /// The value as written.
        value: String,
        /// The most similar allowed word.
        nearest: Option<String>,
        /// All words allowed.
        allowed: Vec<String>,
    },
    /// A list of the wrong length.
    #[error("`{value}` has {found} {}", if *found == 1 { "entry" } else { "entries" })]
    WrongLength {
        /// The value as written.
        value: String,
        /// Its length.
        found: usize,
        /// The required length.
        allowed: String,
    },
    /// An invalid name.
    #[error("the name `{}` cannot be used: {reason}", shortened(name))]
    BadName {
        /// The name.
        name: String,
        /// The reason.
        reason: &'static str,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A constraint without a prescribed component.
    #[error("all components are free: this table prescribes nothing")]
    NothingPrescribed,
    /// An invalid override.
    #[error("the override `{}` cannot be applied: {reason}", shortened(text))]
    BadOverride {
        /// The override.
        text: String,
        /// The reason.
        reason: String,
        /// What is allowed.
        allowed: String,
    },
    /// Inconsistent points, grids and sets.
    #[error("the discretisation is inconsistent: {reason}")]
    BadDiscretisation {
        /// What is inconsistent.
        reason: String,
    },
    /// A model that a single process computes.
    #[error("this model cannot be divided among several processes: {reason}")]
    Undivided {
        /// The reason.
        reason: &'static str,
    },
    /// More processes than parts of the body.
    #[error("{points} points cannot be divided among {processes} processes")]
    TooManyProcesses {
        /// Number of processes.
        processes: usize,
        /// Number of points.
        points: usize,
    },
    /// A property that differs between materials but must be shared by all bonds.
    #[error("`{key}` in {table} differs from the value of the other materials")]
    NotShared {
        /// The key.
        key: &'static str,
        /// The table.
        table: String,
    },
    /// A traction whose area cannot be determined.
    #[error("the area on which the traction acts is unknown: {reason}")]
    UnknownArea {
        /// The reason.
        reason: &'static str,
    },
    /// Fields that are not available.
    #[error("{fields} not available here: {reason}")]
    NoFields {
        /// The fields, with the verb: `the field Stress is`.
        fields: String,
        /// The reason.
        reason: &'static str,
    },
    /// An exact solution that does not apply to the deck.
    #[error("this exact solution does not apply to this deck: {reason}")]
    NoExactSolution {
        /// The reason.
        reason: &'static str,
    },
    /// A body that exceeds the memory limit.
    #[error(
        "the body has {} points and needs about {} of memory; the limit is {}",
        count(*points), bytes(*needed), bytes(*memory as f64)
    )]
    TooLarge {
        /// The number of points, or an upper bound.
        points: f64,
        /// The estimated memory, bytes.
        needed: f64,
        /// The memory limit, bytes.
        memory: u64,
    },
    /// A history of an absorbing boundary that exceeds the memory limit.
    #[error(
        "the history of {} steps needs about {} of memory; the limit is {}",
        count(*steps), bytes(*needed), bytes(*memory as f64)
    )]
    LongHistory {
        /// Steps of the run.
        steps: f64,
        /// The estimated memory, bytes.
        needed: f64,
        /// The memory limit, bytes.
        memory: u64,
    },
    /// An error that no code distinguishes from others: its message and its advice are next to its check.
    #[error("{message}")]
    Other {
        /// What is wrong.
        message: String,
        /// What is allowed or what to do.
        advice: String,
        /// What is wrong in one or two words, at the place in the text of the deck.
        label: &'static str,
    },
    /// An error of the library.
    #[error(transparent)]
    Model(#[from] PericlesError),
}

impl Fault {
    /// Creates an error from its message, advice and label.
    pub fn other(label: &'static str, message: String, advice: impl Into<String>) -> Self {
        Self::Other {
            message,
            advice: advice.into(),
            label,
        }
    }

    /// Returns whether the model is rejected because it exceeds the memory limit.
    pub fn is_too_large(&self) -> bool {
        matches!(
            self,
            Self::TooLarge { .. } | Self::LongHistory { .. } | Self::LargeFile { .. }
        )
    }
}
