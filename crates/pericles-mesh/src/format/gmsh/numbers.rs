//! Numbers in Gmsh files, as text or binary.

use crate::fault::Fault;
use crate::scan::{Bytes, Scalar, Words};

/// Numbers in text or binary form; both have the same order, except for elements of version 2.
pub(super) enum Numbers<'a> {
    Text(Words<'a>),
    Binary(Bytes<'a>),
}

impl Numbers<'_> {
    pub(super) fn int(&mut self) -> Result<i64, Fault> {
        match self {
            Self::Text(words) => words.number("a whole number"),
            Self::Binary(bytes) => bytes.integer(Scalar::I32),
        }
    }

    pub(super) fn tag(&mut self, version: Version) -> Result<i64, Fault> {
        match (self, version) {
            (Self::Binary(bytes), Version::Four) => bytes.integer(Scalar::U64),
            (numbers, _) => numbers.int(),
        }
    }

    /// Reads the length of a list, which has eight bytes in binary files.
    pub(super) fn length(&mut self, what: &str) -> Result<usize, Fault> {
        self.count(Version::Four, what, 1)
    }

    pub(super) fn real(&mut self) -> Result<f64, Fault> {
        match self {
            Self::Text(words) => words.number("a coordinate"),
            Self::Binary(bytes) => bytes.real(Scalar::F64),
        }
    }

    pub(super) fn point(&mut self) -> Result<[f64; 3], Fault> {
        Ok([self.real()?, self.real()?, self.real()?])
    }

    /// Reads the number of items that take `numbers_each` numbers each.
    pub(super) fn count(
        &mut self,
        version: Version,
        what: &str,
        numbers_each: usize,
    ) -> Result<usize, Fault> {
        match self {
            Self::Text(words) => words.count(what, numbers_each),
            Self::Binary(bytes) => {
                let count = match version {
                    Version::Two => bytes.integer(Scalar::I32)?,
                    Version::Four => bytes.integer(Scalar::U64)?,
                };
                let count = u64::try_from(count)
                    .map_err(|_| bytes.fault(format!("{count} {what} are declared")))?;
                // The smallest numbers have four bytes.
                bytes.room(count, 4 * numbers_each, what)
            }
        }
    }

    pub(super) fn fault(&self, reason: String) -> Fault {
        match self {
            Self::Text(words) => words.fault(reason),
            Self::Binary(bytes) => bytes.fault(reason),
        }
    }

    pub(super) fn position(&self) -> usize {
        match self {
            Self::Text(words) => words.position(),
            Self::Binary(bytes) => bytes.position(),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Version {
    Two,
    Four,
}
