//! Why a file of text cannot be used.

use std::path::{Path, PathBuf};

use crate::IoError;

/// Why a file of text gives no points, outline or table.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TextError {
    /// The file cannot be read.
    #[error(transparent)]
    Io(#[from] IoError),
    /// A line that holds something else than it should.
    #[error("{}:{line}: {reason}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// A file that is wrong as a whole.
    #[error("{}: {reason}", path.display())]
    Whole {
        /// The file.
        path: PathBuf,
        /// What is wrong, and what is needed.
        reason: String,
    },
}

impl TextError {
    pub(crate) fn line(path: impl AsRef<Path>, line: usize, reason: impl Into<String>) -> Self {
        let (path, reason) = (path.as_ref().to_path_buf(), reason.into());
        Self::Line { path, line, reason }
    }

    pub(crate) fn whole(path: impl AsRef<Path>, reason: impl Into<String>) -> Self {
        let (path, reason) = (path.as_ref().to_path_buf(), reason.into());
        Self::Whole { path, reason }
    }
}
