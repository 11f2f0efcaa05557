//! Errors of reading text files.

use std::path::{Path, PathBuf};

use crate::IoError;

/// Errors of reading a list of points, an outline or a table from text.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TextError {
    /// The file cannot be read.
    #[error(transparent)]
    Io(#[from] IoError),
    /// A line with invalid content.
    #[error("{}:{line}: {reason}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// What is wrong and what is allowed.
        reason: String,
    },
    /// A file that is invalid as a whole.
    #[error("{}: {reason}", path.display())]
    Whole {
        /// The file.
        path: PathBuf,
        /// What is wrong and what is needed.
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
