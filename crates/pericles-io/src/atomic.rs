//! Atomic file writes: a temporary file in the same folder, flushed to disk and renamed.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::IoError;

/// Extension of unfinished files, which may remain after a crash.
const UNFINISHED: &str = ".part";

/// Writes a file atomically: readers see either the old or the new content, even after a power failure.
///
/// `write` fills a temporary file in the same folder, which is flushed to disk and then renamed to `path`. On
/// failure the temporary file is removed and `path` is unchanged.
///
/// ```
/// use std::io::Write;
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("run.json");
/// pericles_io::write_atomically(&path, |file| file.write_all(b"{}")).unwrap();
/// assert_eq!(std::fs::read(&path).unwrap(), b"{}");
/// ```
pub fn write_atomically<T>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<T>,
) -> Result<T, IoError> {
    let failed = |source| IoError::writing(path, source);
    let (temporary, file) = create_beside(path).map_err(failed)?;
    let outcome = (|| {
        let mut writer = BufWriter::with_capacity(1 << 16, file);
        let value = write(&mut writer)?;
        writer.flush()?;
        writer.get_ref().sync_all()?;
        drop(writer); // some systems cannot rename an open file
        fs::rename(&temporary, path)?;
        Ok(value)
    })();
    match outcome {
        Ok(value) => {
            sync_folder(folder_of(path)).map_err(failed)?;
            Ok(value)
        }
        Err(source) => {
            // Report the first error.
            let _ = fs::remove_file(&temporary);
            Err(failed(source))
        }
    }
}

/// Renames a temporary file that has been flushed to disk and closed, and makes this durable.
pub(crate) fn finish(temporary: &Path, path: &Path) -> io::Result<()> {
    fs::rename(temporary, path)?;
    sync_folder(folder_of(path))
}

/// Removes the unfinished files that a crashed run left in `folder`.
pub(crate) fn remove_unfinished(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_name().to_str().and_then(finished_name).is_some() {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// Returns the final name of a file that [`write_atomically`] left unfinished; `None` for other files.
pub(crate) fn finished_name(name: &str) -> Option<&str> {
    let (name, numbers) = name
        .strip_prefix('.')?
        .strip_suffix(UNFINISHED)?
        .rsplit_once('.')?;
    let (process, count) = numbers.split_once('-')?;
    let number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    (number(process) && number(count)).then_some(name)
}

/// Returns the parent folder of a path; `.` for a bare file name.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Creates a temporary file in the folder of `path`.
pub(crate) fn create_beside(path: &Path) -> io::Result<(PathBuf, File)> {
    static COUNTER: AtomicU64 = AtomicU64::new(0);
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::from(io::ErrorKind::IsADirectory))?
        .to_string_lossy();
    loop {
        let count = COUNTER.fetch_add(1, Ordering::Relaxed);
        let process = std::process::id();
        let temporary = path.with_file_name(format!(".{name}.{process}-{count}{UNFINISHED}"));
        match OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&temporary)
        {
            Ok(file) => return Ok((temporary, file)),
            // Left over from a crashed process with the same id: use the next name.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

/// Makes a rename durable: on Unix, the folder must be synced as well.
#[cfg(unix)]
pub(crate) fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

#[cfg(not(unix))]
pub(crate) fn sync_folder(_folder: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_keeps_the_old_content_and_leaves_no_other_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        write_atomically(&path, |file| file.write_all(b"old")).unwrap();
        let error = write_atomically(&path, |file| {
            file.write_all(b"new")?;
            Err::<(), _>(io::Error::from(io::ErrorKind::StorageFull))
        })
        .unwrap_err();
        assert!(matches!(error, IoError::DiskFull { .. }));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_missing_folder_is_an_output_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("none").join("a.csv");
        let error = write_atomically(&path, |_| Ok(())).unwrap_err();
        assert!(matches!(error, IoError::FolderGone { .. }), "{error}");
        assert!(error.is_output_problem());
    }

    #[test]
    fn only_unfinished_files_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.csv", ".hidden", "b.part", ".a.csv.1-0.part"] {
            fs::write(folder.path().join(name), "x").unwrap();
        }
        remove_unfinished(folder.path()).unwrap();
        let mut left: Vec<_> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        assert_eq!(left, [".hidden", "a.csv", "b.part"]);
    }
}
