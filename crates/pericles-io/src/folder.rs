//! Output folder of a run: created atomically, locked against other runs, cleared only of files written by an
//! earlier run.
//!
//! ```text
//! branching/
//!   run.json  history.csv  reactions.csv  …  fields.pvd
//!   fields/fields_000000.vtu …    pictures/*.png    checkpoints/step-000000001840.chk …
//!   .lock                         locked while a run writes; remains, empty and unlocked
//!   .manifest                     the names of all files that the run may write, recorded in advance
//! ```

mod manifest;

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use self::manifest::{MANIFEST, Manifest};
use crate::IoError;
use crate::atomic::{finished_name, folder_of, remove_unfinished};

const LOCK: &str = ".lock";

/// Sub-folders of a run.
const SUBFOLDERS: [&str; 3] = ["fields", "pictures", "checkpoints"];

/// The folder of one run, locked against other runs for the lifetime of this value.
///
/// The lock belongs to the open file, so that it is released when the process ends for any reason.
///
/// ```
/// use pericles_io::{IoError, OutputFolder};
/// let place = tempfile::tempdir().unwrap();
/// let first = OutputFolder::create_numbered(place.path().join("branching")).unwrap();
/// let second = OutputFolder::create_numbered(place.path().join("branching")).unwrap();
/// assert!(second.path().ends_with("branching-2"));
/// assert!(matches!(OutputFolder::open(first.path()), Err(IoError::Locked { .. })));
/// ```
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    /// `None` if another process writes the folder.
    lock: Option<File>,
}

impl OutputFolder {
    /// Creates the folder `path` and missing parents.
    ///
    /// An existing folder is rejected unless `force` is set; with `force`, the files listed in the manifest
    /// of an earlier run are removed and all other files are kept. A folder that is neither empty nor the
    /// output of a run is always rejected. Folders of versions without a manifest are recognised by the
    /// content of `run.json`, or if they contain only a lock and files with the names of results.
    pub fn create(path: impl Into<PathBuf>, force: bool) -> Result<Self, IoError> {
        let path = path.into();
        create_parents(&path)?;
        match fs::create_dir(&path) {
            Ok(()) => Self::lock(path),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && !force => {
                Err(IoError::FolderExists { path })
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                // Before the lock file is created: a rejected folder stays unchanged.
                let manifest = owned(&path)?;
                let folder = Self::lock(path)?;
                folder.remove_results(&manifest)?;
                Ok(folder)
            }
            Err(error) => Err(IoError::writing(&path, error)),
        }
    }

    /// Creates the first free folder of `stem`, `stem-2`, `stem-3` …; runs started simultaneously get
    /// different folders.
    pub fn create_numbered(stem: impl Into<PathBuf>) -> Result<Self, IoError> {
        let stem = stem.into();
        create_parents(&stem)?;
        let mut path = stem.clone();
        let mut number = 1_u64;
        loop {
            match fs::create_dir(&path) {
                Ok(()) => return Self::lock(path),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => number += 1,
                Err(error) => return Err(IoError::writing(&path, error)),
            }
            let mut name = stem.clone().into_os_string();
            name.push(format!("-{number}"));
            path = name.into();
        }
    }

    /// Opens the folder of an earlier run to resume it, and removes unfinished files of a crash.
    pub fn open(path: impl Into<PathBuf>) -> Result<Self, IoError> {
        let path = path.into();
        let kind = fs::metadata(&path).map_err(|source| IoError::reading(&path, source))?;
        if !kind.is_dir() {
            let source = io::Error::from(io::ErrorKind::NotADirectory);
            return Err(IoError::Read { path, source });
        }
        let folder = Self::lock(path)?;
        for place in folder.places() {
            remove_unfinished(&place).map_err(|source| IoError::writing(&place, source))?;
        }
        Ok(folder)
    }

    /// The folder of a run that another process writes.
    pub fn following(path: impl Into<PathBuf>) -> Self {
        Self {
            path: path.into(),
            lock: None,
        }
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the path of a file in the folder.
    pub fn file(&self, name: impl AsRef<Path>) -> PathBuf {
        self.path.join(name)
    }

    /// Returns a sub-folder, created if it does not exist, unless another process writes the folder.
    pub fn subfolder(&self, name: &str) -> Result<PathBuf, IoError> {
        let path = self.path.join(name);
        if self.lock.is_none() {
            return Ok(path);
        }
        match fs::create_dir(&path) {
            Err(error) if !path.is_dir() => Err(IoError::writing(&path, error)),
            _ => Ok(path),
        }
    }

    /// Records file names in the manifest before the files are written: a later run that overwrites this one
    /// may remove them. `*` stands for one or more digits, as in `fields/fields_*.vtu`.
    ///
    /// # Errors
    /// Returns an error if the manifest cannot be written.
    pub fn claim(&self, names: &[String]) -> Result<(), IoError> {
        if self.lock.is_none() {
            return Ok(());
        }
        Manifest::add(&self.path, names)
    }

    fn lock(path: PathBuf) -> Result<Self, IoError> {
        let lock = path.join(LOCK);
        // The lock file is never removed: otherwise a run that waits for the old file and one that creates a
        // new file would both own the folder.
        let file = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(false)
            .open(&lock)
            .map_err(|source| IoError::writing(&lock, source))?;
        match file.try_lock() {
            Ok(()) => Ok(Self {
                path,
                lock: Some(file),
            }),
            Err(TryLockError::WouldBlock) => Err(IoError::Locked { path }),
            Err(TryLockError::Error(source)) => Err(IoError::writing(&lock, source)),
        }
    }

    /// Returns the folder and its existing sub-folders.
    fn places(&self) -> Vec<PathBuf> {
        let within = fs::read_dir(&self.path).into_iter().flatten().flatten();
        let subfolders = within.map(|entry| entry.path());
        std::iter::once(self.path.clone())
            .chain(subfolders.filter(|place| is_folder(place)))
            .collect()
    }

    fn remove_results(&self, manifest: &Manifest) -> Result<(), IoError> {
        for (prefix, place) in std::iter::once((String::new(), self.path.clone()))
            .chain(SUBFOLDERS.map(|name| (format!("{name}/"), self.path.join(name))))
        {
            if !is_folder(&place) {
                continue;
            }
            for entry in entries(&place)? {
                let name = finished_name(&entry.name).unwrap_or(&entry.name);
                if entry.is_file && manifest.has(&format!("{prefix}{name}")) {
                    remove(&place.join(&entry.name))?;
                }
            }
        }
        // The manifest goes last: if the process is killed before, the remaining files are still recorded.
        match fs::remove_file(self.path.join(MANIFEST)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(IoError::writing(&self.path.join(MANIFEST), error))
            }
            _ => Ok(()),
        }
    }
}

/// Returns whether a path is a folder and not a link to one.
fn is_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_dir())
}

struct Entry {
    name: String,
    is_file: bool,
}

fn entries(folder: &Path) -> Result<Vec<Entry>, IoError> {
    let list = || {
        fs::read_dir(folder)?
            .map(|entry| {
                let entry = entry?;
                Ok(Entry {
                    // Names that are not UTF-8 are not Pericles files; the lossy form counts them among the
                    // other files.
                    name: entry.file_name().to_string_lossy().into_owned(),
                    is_file: entry.file_type()?.is_file(),
                })
            })
            .collect::<io::Result<_>>()
    };
    list().map_err(|source| IoError::writing(folder, source))
}

/// Returns the files that an earlier run may have written into a folder.
///
/// # Errors
/// Returns an error if the folder contains anything other than the results of a run.
fn owned(path: &Path) -> Result<Manifest, IoError> {
    if let Some(manifest) = Manifest::of(path)? {
        return Ok(manifest);
    }
    let all = entries(path)?;
    let usual = Manifest::usual();
    let locked = all.iter().any(|entry| entry.name == LOCK);
    // A run of a version without a manifest that stopped before its first report leaves the lock, sub-folders
    // and tables.
    let begun = all.iter().all(|entry| {
        let name = finished_name(&entry.name);
        entry.name == LOCK
            || name.is_some()
            || locked && entry.is_file && entry.name != "run.json" && usual.has(&entry.name)
            || locked && !entry.is_file && SUBFOLDERS.contains(&entry.name.as_str())
    });
    if begun {
        Ok(usual)
    } else {
        Err(IoError::FolderNotOurs {
            path: path.to_path_buf(),
        })
    }
}

fn remove(path: &Path) -> Result<(), IoError> {
    fs::remove_file(path).map_err(|source| IoError::writing(path, source))
}

fn create_parents(path: &Path) -> Result<(), IoError> {
    fs::create_dir_all(folder_of(path)).map_err(|source| IoError::writing(path, source))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::thread;

    fn populate(folder: &Path, files: &[&str]) {
        for file in files {
            let path = folder.join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "x").unwrap();
        }
    }

    #[test]
    fn an_existing_folder_is_rejected() {
        let place = tempfile::tempdir().unwrap();
        let error = OutputFolder::create(place.path(), false).unwrap_err();
        assert!(matches!(error, IoError::FolderExists { .. }), "{error}");
        assert!(error.is_output_problem());
    }

    #[test]
    fn missing_parents_are_created() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a/b/c");
        let folder = OutputFolder::create(&path, false).unwrap();
        assert!(folder.path().is_dir());
        assert!(folder.subfolder("fields").unwrap().is_dir());
        assert!(folder.subfolder("fields").unwrap().is_dir());
    }

    const STRAYS: [&str; 10] = [
        "notes.txt",
        "measured.csv",
        "fields/mine.vtu",
        "fields/fields_best.vtu",
        "pictures/me.png",
        "pictures/a.svg",
        "more/run.json",
        "checkpoints/README",
        "checkpoints/kept.chk",
        ".notes.part",
    ];

    fn assert_removed(path: &Path, results: &[&str]) {
        for file in results {
            assert!(!path.join(file).exists(), "{file}");
        }
        for file in STRAYS {
            assert!(path.join(file).exists(), "{file}");
        }
    }

    #[test]
    fn force_removes_only_recorded_files() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("out");
        let names = [
            "run.json",
            "own.csv",
            "fields/fields_*.vtu",
            "pictures/a.apng",
        ];
        let folder = OutputFolder::create(&path, false).unwrap();
        folder.claim(&names.map(String::from)).unwrap();
        drop(folder);
        let results = [
            "run.json",
            "own.csv",
            "fields/fields_000000.vtu",
            "pictures/a.apng",
            "fields/.fields_000001.vtu.7-0.part",
        ];
        populate(&path, &results);
        populate(&path, &STRAYS);
        // A table that this run does not write.
        populate(&path, &["history.csv"]);
        let _folder = OutputFolder::create(&path, true).unwrap();
        assert_removed(&path, &results);
        assert!(path.join("history.csv").exists());
        assert!(!path.join(MANIFEST).exists());
    }

    #[test]
    fn results_without_a_manifest_are_recognised_by_their_report() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("out");
        let results = [
            "run.json",
            "history.csv",
            "fields.pvd",
            "fields/fields_000000.vtu",
            "pictures/Damage-000001.png",
            "pictures/Velocity_y_2.apng",
            "checkpoints/step-000000000001.chk",
            "fields/.fields_000001.vtu.7-0.part",
        ];
        populate(&path, &results);
        populate(&path, &STRAYS);
        // The report of another program does not permit removal.
        for foreign in [
            "x",
            "{}",
            r#"{"program": {"name": "other"}, "deck": {"source": ""}}"#,
        ] {
            fs::write(path.join("run.json"), foreign).unwrap();
            let error = OutputFolder::create(&path, true).unwrap_err();
            assert!(matches!(error, IoError::FolderNotOurs { .. }), "{error}");
            assert!(path.join("history.csv").exists());
        }
        let ours = r#"{"program": {"name": "pericles"}, "deck": {"source": ""}}"#;
        fs::write(path.join("run.json"), ours).unwrap();
        let _folder = OutputFolder::create(&path, true).unwrap();
        assert_removed(&path, &results);
    }

    #[cfg(unix)]
    #[test]
    fn force_does_not_follow_links() {
        let place = tempfile::tempdir().unwrap();
        let (path, other) = (place.path().join("out"), place.path().join("other"));
        populate(&other, &["fields_000000.vtu"]);
        let folder = OutputFolder::create(&path, false).unwrap();
        folder.claim(&["fields/fields_*.vtu".into()]).unwrap();
        drop(folder);
        std::os::unix::fs::symlink(&other, path.join("fields")).unwrap();
        OutputFolder::create(&path, true).unwrap();
        assert!(other.join("fields_000000.vtu").exists());
    }

    #[test]
    fn force_rejects_a_folder_of_other_files() {
        let place = tempfile::tempdir().unwrap();
        populate(place.path(), &["thesis.tex", "data.csv", "pictures/me.png"]);
        let error = OutputFolder::create(place.path(), true).unwrap_err();
        assert!(matches!(error, IoError::FolderNotOurs { .. }), "{error}");
        assert!(place.path().join("data.csv").exists());
        assert!(!place.path().join(LOCK).exists());
    }

    #[test]
    fn force_accepts_an_empty_folder_and_one_of_a_run_that_stopped_early() {
        let place = tempfile::tempdir().unwrap();
        drop(OutputFolder::create(place.path(), true).unwrap());
        assert!(place.path().join(LOCK).exists());
        OutputFolder::create(place.path(), true).unwrap();
        populate(place.path(), &["history.csv"]);
        fs::create_dir(place.path().join("pictures")).unwrap();
        OutputFolder::create(place.path(), true).unwrap();
        assert!(!place.path().join("history.csv").exists());
        fs::write(place.path().join("notes.txt"), "mine").unwrap();
        assert!(OutputFolder::create(place.path(), true).is_err());
    }

    #[test]
    fn a_second_run_is_locked_out_until_the_first_ends() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("out");
        let first = OutputFolder::create(&path, false).unwrap();
        first.claim(&["run.json".into()]).unwrap();
        populate(&path, &["run.json"]);
        for second in [OutputFolder::open(&path), OutputFolder::create(&path, true)] {
            assert!(matches!(second, Err(IoError::Locked { .. })), "{second:?}");
        }
        assert!(path.join("run.json").exists());
        drop(first);
        OutputFolder::open(&path).unwrap();
    }

    #[test]
    fn runs_started_simultaneously_get_different_folders() {
        let place = tempfile::tempdir().unwrap();
        let stem = place.path().join("bar.v2");
        let folders: Vec<_> = thread::scope(|scope| {
            let start = || OutputFolder::create_numbered(&stem).unwrap();
            let handles: Vec<_> = (0..8).map(|_| scope.spawn(start)).collect();
            handles.into_iter().map(|run| run.join().unwrap()).collect()
        });
        let names: BTreeSet<_> = folders
            .iter()
            .map(|folder| folder.path().file_name().unwrap().to_str().unwrap())
            .collect();
        let expected = [
            "bar.v2", "bar.v2-2", "bar.v2-3", "bar.v2-4", "bar.v2-5", "bar.v2-6", "bar.v2-7",
            "bar.v2-8",
        ];
        assert_eq!(names, BTreeSet::from(expected));
    }

    #[test]
    fn opening_a_missing_path_or_a_file_fails() {
        let place = tempfile::tempdir().unwrap();
        let gone = OutputFolder::open(place.path().join("gone"));
        assert!(matches!(gone, Err(IoError::NotFound { .. })));
        populate(place.path(), &["file"]);
        let file = OutputFolder::open(place.path().join("file"));
        assert!(matches!(file, Err(IoError::Read { .. })), "{file:?}");
    }
}
