//! What is wrong with the content of a file, and where.

use std::fmt;

/// A place in a file.
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

/// Why the content of a file cannot be used. The name of the file is added by whoever knows it: `{file}{place}: {reason}`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{place}: {reason}", included.as_deref().unwrap_or_default())]
pub struct Fault {
    /// The included file in which the fault is, if it is in one.
    pub included: Option<String>,
    /// Where.
    pub place: Place,
    /// What is wrong, and what is allowed.
    pub reason: String,
    /// Bytes that the content would take, where these are more than may be used.
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

    /// A fault in a line, from 1.
    pub fn at_line(line: usize, reason: impl Into<String>) -> Self {
        Self::new(Place::Line(line), reason)
    }

    /// A fault at a byte, from 0.
    pub fn at_byte(byte: usize, reason: impl Into<String>) -> Self {
        Self::new(Place::Byte(byte), reason)
    }

    /// A fault of the file as a whole.
    pub fn of_file(reason: impl Into<String>) -> Self {
        Self::new(Place::File, reason)
    }

    /// Content that would take so many bytes, more than may be used.
    pub fn too_large(needed: u64) -> Self {
        Self {
            needed: Some(needed),
            ..Self::of_file("too large")
        }
    }
}
