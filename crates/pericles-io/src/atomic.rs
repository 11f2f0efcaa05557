//! Files that are either whole or not there: written beside their place, forced to the disk, and renamed.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::IoError;

/// The ending of unfinished files, which a crash may leave behind.
const UNFINISHED: &str = ".part";

/// Writes a file so that its readers see the old content or the new, never a part, even after a power failure.
///
/// `write` fills a temporary file in the same folder, which is then flushed, forced to the disk and renamed to `path`.
/// If anything fails the temporary file is removed and `path` is left as it was.
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
        drop(writer); // some systems refuse to rename a file that is open
        fs::rename(&temporary, path)?;
        Ok(value)
    })();
    match outcome {
        Ok(value) => {
            sync_folder(folder_of(path)).map_err(failed)?;
            Ok(value)
        }
        Err(source) => {
            // The first error is the one to report.
            let _ = fs::remove_file(&temporary);
            Err(failed(source))
        }
    }
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

/// The name that a file was to get which [`write_atomically`] did not finish; none for other files.
pub(crate) fn finished_name(name: &str) -> Option<&str> {
    let (name, numbers) = name
        .strip_prefix('.')?
        .strip_suffix(UNFINISHED)?
        .rsplit_once('.')?;
    let (process, count) = numbers.split_once('-')?;
    let number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    (number(process) && number(count)).then_some(name)
}

/// The folder a path lies in; `.` for a bare name.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

fn create_beside(path: &Path) -> io::Result<(PathBuf, File)> {
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
            // Left by a crashed process of the same number: take the next name.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

/// Makes a rename last: on Unix a name is on the disk only once its folder is.
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
    fn a_failure_leaves_the_old_content_and_nothing_else() {
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
    fn a_missing_folder_is_an_output_problem() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("none").join("a.csv");
        let error = write_atomically(&path, |_| Ok(())).unwrap_err();
        assert!(matches!(error, IoError::FolderGone { .. }), "{error}");
        assert!(error.is_output_problem());
    }

    #[test]
    fn only_unfinished_files_are_swept() {
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
