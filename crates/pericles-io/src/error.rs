//! Errors of file input and output, classified by what the user can do about them.

use std::io;
use std::path::{Path, PathBuf};

use pericles::units::quantity;

/// Errors of reading and writing the files of a run. Every variant contains the path.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// A file or folder that cannot be written: permissions, read-only file system, or a path through a file.
    #[error("cannot write {}: {source}; choose another folder or change its permissions", path.display())]
    NotWritable {
        /// The file or folder.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },

    /// The folder of the file was removed.
    #[error("cannot write {}: its folder has been removed; run again in a folder that is kept", path.display())]
    FolderGone {
        /// The file.
        path: PathBuf,
    },

    /// No space left, or a quota or the maximum file size is exceeded.
    #[error("not enough space to write {}: {source}; free some space or choose another disk", path.display())]
    DiskFull {
        /// The file or folder.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },

    /// Another run is writing into the folder.
    #[error("{} is in use by another run; wait for it to end or choose another folder", path.display())]
    Locked {
        /// The output folder.
        path: PathBuf,
    },

    /// The output folder already exists.
    #[error("{} already exists; choose another name or allow its results to be overwritten", path.display())]
    FolderExists {
        /// The output folder.
        path: PathBuf,
    },

    /// The folder to be overwritten contains files but no Pericles results.
    #[error("{} contains files but no Pericles results, so nothing in it is overwritten; choose another folder", path.display())]
    FolderNotOurs {
        /// The folder.
        path: PathBuf,
    },

    /// A symbolic link at the place of a result.
    #[error("{} is a symbolic link; results are not written through links: remove it, or choose another folder", path.display())]
    Link {
        /// The link.
        path: PathBuf,
    },

    /// The file or folder to read does not exist.
    #[error("{} does not exist", path.display())]
    NotFound {
        /// The file or folder.
        path: PathBuf,
    },

    /// A damaged file: its content is not what Pericles wrote.
    #[error("{} is damaged: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },

    /// A file format version that this version of Pericles does not read.
    #[error("{} has format version {found}; this version of Pericles reads format version {supported}; use the version that wrote it", path.display())]
    UnsupportedVersion {
        /// The file.
        path: PathBuf,
        /// The version of the file.
        found: u32,
        /// The supported version of the format.
        supported: u32,
    },

    /// The content of a file exceeds the memory limit.
    #[error("{} needs about {} of memory, but only {} may be used; use a smaller file, free memory or raise the memory limit", path.display(), size(*needed), size(*memory))]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Memory needed, bytes.
        needed: u64,
        /// Memory limit, bytes.
        memory: u64,
    },

    /// No valid checkpoint in a folder.
    #[error("{} contains no usable checkpoint ({} rejected{})", path.display(), rejected.len(), first_reason(rejected))]
    NoValidCheckpoint {
        /// The folder of checkpoints.
        path: PathBuf,
        /// Errors of the rejected checkpoints, newest first.
        rejected: Vec<IoError>,
    },

    /// Data passed for a file have inconsistent lengths.
    #[error("data for {}: {what} has {given} values, expected {expected}", path.display())]
    Shape {
        /// The file.
        path: PathBuf,
        /// The array or row.
        what: String,
        /// Expected number of values.
        expected: usize,
        /// Given number of values.
        given: usize,
    },

    /// A value, name or setting that this kind of file cannot store.
    #[error("{} cannot be written: {reason}", path.display())]
    Unsuitable {
        /// The file.
        path: PathBuf,
        /// What is wrong and what is allowed.
        reason: String,
    },

    /// Another of the processes that share a file has failed and reports the error.
    #[error("another process cannot read or write {}", path.display())]
    OnAnotherProcess {
        /// The file.
        path: PathBuf,
    },

    /// Any other error of reading.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },

    /// Any other error of writing.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
}

/// Formats a number of bytes.
fn size(bytes: u64) -> String {
    quantity(bytes as f64, "B")
}

fn first_reason(rejected: &[IoError]) -> String {
    rejected
        .first()
        .map(|error| format!("; {error}"))
        .unwrap_or_default()
}

impl IoError {
    /// Classifies a system error that occurred while reading `path`.
    pub fn reading(path: &Path, source: io::Error) -> Self {
        let path = path.to_path_buf();
        match source.kind() {
            io::ErrorKind::NotFound => Self::NotFound { path },
            _ => Self::Read { path, source },
        }
    }

    /// Classifies a system error that occurred while writing `path`.
    pub fn writing(path: &Path, source: io::Error) -> Self {
        use io::ErrorKind as Kind;
        let path = path.to_path_buf();
        if is_full(&source) {
            return Self::DiskFull { path, source };
        }
        match source.kind() {
            // The file itself need not exist yet.
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

    /// Returns whether the output location is the cause (not writable, full, locked, already exists) rather
    /// than the data or input files.
    pub fn is_output_problem(&self) -> bool {
        matches!(
            self,
            Self::NotWritable { .. }
                | Self::FolderGone { .. }
                | Self::DiskFull { .. }
                | Self::Locked { .. }
                | Self::FolderExists { .. }
                | Self::FolderNotOurs { .. }
                | Self::Link { .. }
                | Self::Write { .. }
        )
    }

    /// Returns the file or folder concerned.
    pub fn path(&self) -> &Path {
        match self {
            Self::NotWritable { path, .. }
            | Self::FolderGone { path }
            | Self::DiskFull { path, .. }
            | Self::Locked { path }
            | Self::FolderExists { path }
            | Self::FolderNotOurs { path }
            | Self::Link { path }
            | Self::NotFound { path }
            | Self::Damaged { path, .. }
            | Self::UnsupportedVersion { path, .. }
            | Self::TooLarge { path, .. }
            | Self::NoValidCheckpoint { path, .. }
            | Self::Shape { path, .. }
            | Self::Unsuitable { path, .. }
            | Self::OnAnotherProcess { path }
            | Self::Read { path, .. }
            | Self::Write { path, .. } => path,
        }
    }
}

fn is_full(error: &io::Error) -> bool {
    use io::ErrorKind as Kind;
    // errno ENOSPC = 28 on Linux, macOS and the BSDs, for libraries that pass on the raw number
    matches!(
        error.kind(),
        Kind::StorageFull | Kind::QuotaExceeded | Kind::FileTooLarge
    ) || (cfg!(unix) && error.raw_os_error() == Some(28))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_disk_and_a_missing_permission_give_different_errors() {
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
    fn reading_a_missing_file_is_not_an_output_error() {
        let error = IoError::reading(Path::new("gone"), io::Error::from(io::ErrorKind::NotFound));
        assert!(matches!(error, IoError::NotFound { .. }));
        assert!(!error.is_output_problem());
    }
}
