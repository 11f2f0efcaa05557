//! Element types of sections.

use pericles::Values;
use serde::{Deserialize, Serialize};

/// Element type of a section, as named in the header.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    F64,
    U64,
    U32,
    U8,
}

impl Kind {
    /// Returns the type of an array of an archive.
    pub(super) fn of(values: &Values) -> Self {
        match values {
            Values::F64(_) => Self::F64,
            Values::U64(_) => Self::U64,
            Values::U8(_) => Self::U8,
        }
    }

    /// Returns the size of one element in bytes.
    pub(super) fn bytes(self) -> u64 {
        match self {
            Self::F64 | Self::U64 => 8,
            Self::U32 => 4,
            Self::U8 => 1,
        }
    }
}
