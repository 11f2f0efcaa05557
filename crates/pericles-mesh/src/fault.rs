//! Errors in the content of a file, with their location.

use std::fmt;

/// A location in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// A line of text, from 1.
    Line(usize),
    /// A byte, from 0.
    Byte(usize),
    /// The file as a whole.
    File,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, ":{line}"),
            Self::Byte(byte) => write!(f, ", byte {byte}"),
            Self::File => Ok(()),
        }
    }
}

/// Error in the content of a file. The caller adds the file name: `{file}{place}: {reason}`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{place}: {reason}", included.as_deref().unwrap_or_default())]
pub struct Fault {
    /// The included file that contains the error, if any.
    pub included: Option<String>,
    /// Location.
    pub place: Place,
    /// What is wrong and what is allowed.
    pub reason: String,
    /// Memory needed for the content in bytes, if it exceeds the limit.
    pub needed: Option<u64>,
}

impl Fault {
    fn new(place: Place, reason: impl Into<String>) -> Self {
        Self {
            included: None,
            place,
            reason: reason.into(),
            needed: None,
        }
    }

    /// Error in a line, from 1.
    pub fn at_line(line: usize, reason: impl Into<String>) -> Self {
        Self::new(Place::Line(line), reason)
    }

    /// Error at a byte, from 0.
    pub fn at_byte(byte: usize, reason: impl Into<String>) -> Self {
        Self::new(Place::Byte(byte), reason)
    }

    /// Error of the file as a whole.
    pub fn of_file(reason: impl Into<String>) -> Self {
        Self::new(Place::File, reason)
    }

    /// Content that would exceed the memory limit; `needed` in bytes.
    pub fn too_large(needed: u64) -> Self {
        Self {
            needed: Some(needed),
            ..Self::of_file("too large")
        }
    }
}
