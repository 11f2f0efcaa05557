//! What can go wrong with a file, told apart by what the user can do about it.

use std::io;
use std::path::{Path, PathBuf};

use pericles::units::quantity;

/// Errors of reading and writing the files of a run. Every variant names the path.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// The file or folder may not be written: permission, read-only file system, or a path that leads through a file.
    #[error("cannot write {}: {source}; choose another folder or change its permissions", path.display())]
    NotWritable {
        /// What was to be written.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },

    /// The folder of the file has gone.
    #[error("cannot write {}: its folder is not there any more; run again, into a folder that stays", path.display())]
    FolderGone {
        /// What was to be written.
        path: PathBuf,
    },

    /// No space is left, or a quota or the largest allowed file size is reached.
    #[error("no room to write {}: {source}; free some space or choose another disk", path.display())]
    DiskFull {
        /// What was to be written.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },

    /// Another run is writing into the folder.
    #[error("{} is in use by another run; wait for it to end or choose another folder", path.display())]
    Locked {
        /// The output folder.
        path: PathBuf,
    },

    /// The output folder is there already.
    #[error("{} exists already; choose another name or ask to overwrite its results", path.display())]
    FolderExists {
        /// The output folder.
        path: PathBuf,
    },

    /// The folder to be overwritten holds no results of Pericles, but other files.
    #[error("{} holds other files and no results of Pericles, so nothing in it is overwritten; choose another folder", path.display())]
    FolderNotOurs {
        /// The folder.
        path: PathBuf,
    },

    /// The file or folder to be read does not exist.
    #[error("{} does not exist", path.display())]
    NotFound {
        /// What was to be read.
        path: PathBuf,
    },

    /// The content of a file is not what Pericles wrote.
    #[error("{} is damaged: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        reason: String,
    },

    /// The file is of a format that this version does not read.
    #[error("{} has format version {found}; this program reads versions up to {newest}", path.display())]
    UnsupportedVersion {
        /// The file.
        path: PathBuf,
        /// The version in the file.
        found: u32,
        /// The newest version known.
        newest: u32,
    },

    /// The content of a file would take more memory than there is.
    #[error("{} needs about {} of memory, and {} may be used; use a smaller file, or free or allow more memory", path.display(), size(*needed), size(*memory))]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// What its content would take, bytes.
        needed: u64,
        /// What may be used, bytes.
        memory: u64,
    },

    /// None of the checkpoints in a folder can be used.
    #[error("{} holds no usable checkpoint ({} refused{})", path.display(), refused.len(), first_reason(refused))]
    NoValidCheckpoint {
        /// The folder of the checkpoints.
        path: PathBuf,
        /// Why each checkpoint was refused, the newest first.
        refused: Vec<IoError>,
    },

    /// The data handed over for a file do not fit together.
    #[error("data for {}: {what} has {given} values, {expected} are needed", path.display())]
    Shape {
        /// The file.
        path: PathBuf,
        /// The array or row.
        what: String,
        /// How many values fit.
        expected: usize,
        /// How many were given.
        given: usize,
    },

    /// A value, name or setting cannot be stored in this kind of file.
    #[error("{} cannot be written: {reason}", path.display())]
    Unsuitable {
        /// The file.
        path: PathBuf,
        /// What does not fit, and what would.
        reason: String,
    },

    /// Any other trouble while reading.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },

    /// Any other trouble while writing.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

/// A number of bytes for people.
fn size(bytes: u64) -> String {
    quantity(bytes as f64, "B")
}

fn first_reason(refused: &[IoError]) -> String {
    refused
        .first()
        .map(|error| format!("; {error}"))
        .unwrap_or_default()
}

impl IoError {
    /// Sorts a system error met while reading `path`.
    pub fn reading(path: &Path, source: io::Error) -> Self {
        let path = path.to_path_buf();
        match source.kind() {
            io::ErrorKind::NotFound => Self::NotFound { path },
            _ => Self::Read { path, source },
        }
    }

    /// Sorts a system error met while writing `path`.
    pub fn writing(path: &Path, source: io::Error) -> Self {
        use io::ErrorKind as Kind;
        let path = path.to_path_buf();
        if is_full(&source) {
            return Self::DiskFull { path, source };
        }
        match source.kind() {
            // The file itself need not be there.
            Kind::NotFound => Self::FolderGone { path },
            Kind::PermissionDenied
            | Kind::ReadOnlyFilesystem
            | Kind::NotADirectory
            | Kind::IsADirectory => Self::NotWritable { path, source },
            _ => Self::Write { path, source },
        }
    }

    pub(crate) fn damaged(path: &Path, reason: impl Into<String>) -> Self {
        Self::Damaged {
            path: path.to_path_buf(),
            reason: reason.into(),
        }
    }

    /// Whether the output is to blame (not writable, full, locked, in the way) rather than the data or the input files.
    pub fn is_output_problem(&self) -> bool {
        matches!(
            self,
            Self::NotWritable { .. }
                | Self::FolderGone { .. }
                | Self::DiskFull { .. }
                | Self::Locked { .. }
                | Self::FolderExists { .. }
                | Self::FolderNotOurs { .. }
                | Self::Write { .. }
        )
    }

    /// The file or folder concerned.
    pub fn path(&self) -> &Path {
        match self {
            Self::NotWritable { path, .. }
            | Self::FolderGone { path }
            | Self::DiskFull { path, .. }
            | Self::Locked { path }
            | Self::FolderExists { path }
            | Self::FolderNotOurs { path }
            | Self::NotFound { path }
            | Self::Damaged { path, .. }
            | Self::UnsupportedVersion { path, .. }
            | Self::TooLarge { path, .. }
            | Self::NoValidCheckpoint { path, .. }
            | Self::Shape { path, .. }
            | Self::Unsuitable { path, .. }
            | Self::Read { path, .. }
            | Self::Write { path, .. } => path,
        }
    }
}

fn is_full(error: &io::Error) -> bool {
    use io::ErrorKind as Kind;
    // errno ENOSPC = 28 on Linux, macOS and the BSDs, for libraries that hand on the bare number
    matches!(
        error.kind(),
        Kind::StorageFull | Kind::QuotaExceeded | Kind::FileTooLarge
    ) || (cfg!(unix) && error.raw_os_error() == Some(28))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_is_told_from_a_missing_permission() {
        let path = Path::new("out/run.json");
        for (kind, full) in [
            (io::ErrorKind::StorageFull, true),
            (io::ErrorKind::QuotaExceeded, true),
            (io::ErrorKind::PermissionDenied, false),
        ] {
            let error = IoError::writing(path, io::Error::from(kind));
            assert_eq!(matches!(error, IoError::DiskFull { .. }), full, "{kind:?}");
            assert_eq!(
                matches!(error, IoError::NotWritable { .. }),
                !full,
                "{kind:?}"
            );
            assert!(error.is_output_problem());
            assert_eq!(error.path(), path);
            assert!(error.to_string().contains("run.json"));
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_full_device_reports_a_full_disk() {
        use std::io::Write;
        let mut full = std::fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let error = IoError::writing(Path::new("/dev/full"), full.write_all(b"x").unwrap_err());
        assert!(matches!(error, IoError::DiskFull { .. }), "{error}");
    }

    #[test]
    fn reading_a_missing_file_is_no_output_problem() {
        let error = IoError::reading(Path::new("gone"), io::Error::from(io::ErrorKind::NotFound));
        assert!(matches!(error, IoError::NotFound { .. }));
        assert!(!error.is_output_problem());
    }
}
