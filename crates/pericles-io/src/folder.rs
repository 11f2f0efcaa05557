//! The output folder of a run: created without races, locked for one run, emptied only of what Pericles writes.
//!
//! ```text
//! branching/
//!   run.json  history.csv  reactions.csv  …  fields.pvd
//!   fields/fields_000000.vtu …    pictures/*.png    checkpoints/step-000000001840.chk …
//!   .lock                         held while a run writes; stays behind, empty and unlocked
//! ```

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use crate::IoError;
use crate::atomic::{folder_of, is_unfinished, remove_unfinished};

const LOCK: &str = ".lock";

const PICTURES: &str = "pictures";

/// The sub-folders of a run and the endings of the files Pericles writes there.
const SUBFOLDERS: [(&str, &[&str]); 3] = [
    ("fields", &["vtu"]),
    (PICTURES, &["png", "apng"]),
    ("checkpoints", &["chk"]),
];

/// The folder of one run, locked against other runs while this value lives.
///
/// The lock belongs to the open file, so it vanishes with the process, however that ends.
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
    _lock: File,
}

impl OutputFolder {
    /// Creates the folder `path`, and its parents where they are missing.
    ///
    /// If it exists, `force` decides: without, it is refused; with, the files of an earlier run are removed from it (run.json,
    /// *.csv, fields.pvd, report.html, fields/*.vtu, pictures/*.png, checkpoints/*.chk) and everything else in it stays. A folder that holds
    /// other files and none of an earlier run is refused even then; tables alone do not make a folder one of Pericles.
    pub fn create(path: impl Into<PathBuf>, force: bool) -> Result<Self, IoError> {
        let path = path.into();
        create_parents(&path)?;
        match fs::create_dir(&path) {
            Ok(()) => Self::lock(path),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && !force => {
                Err(IoError::FolderExists { path })
            }
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                // Before the lock file is made: a refused folder stays untouched.
                check_ours(&path)?;
                let folder = Self::lock(path)?;
                folder.remove_results()?;
                Ok(folder)
            }
            Err(error) => Err(IoError::writing(&path, error)),
        }
    }

    /// Creates the first free one of `stem`, `stem-2`, `stem-3` …; runs started at the same time get different folders.
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

    /// Opens the folder of an earlier run to go on in it, and removes what a crash left unfinished there.
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

    /// Where the folder is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The path of a file in the folder.
    pub fn file(&self, name: impl AsRef<Path>) -> PathBuf {
        self.path.join(name)
    }

    /// A sub-folder, made if it is not there yet.
    pub fn subfolder(&self, name: &str) -> Result<PathBuf, IoError> {
        let path = self.path.join(name);
        match fs::create_dir(&path) {
            Err(error) if !path.is_dir() => Err(IoError::writing(&path, error)),
            _ => Ok(path),
        }
    }

    fn lock(path: PathBuf) -> Result<Self, IoError> {
        let lock = path.join(LOCK);
        // The lock file is never removed: a run that waits at the old file and one that makes a new one would both own the folder.
        let file = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(false)
            .open(&lock)
            .map_err(|source| IoError::writing(&lock, source))?;
        match file.try_lock() {
            Ok(()) => Ok(Self { path, _lock: file }),
            Err(TryLockError::WouldBlock) => Err(IoError::Locked { path }),
            Err(TryLockError::Error(source)) => Err(IoError::writing(&lock, source)),
        }
    }

    /// The folder itself and its sub-folders that exist.
    fn places(&self) -> Vec<PathBuf> {
        let subfolders = SUBFOLDERS.iter().map(|(name, _)| self.path.join(name));
        std::iter::once(self.path.clone())
            .chain(subfolders.filter(|place| place.is_dir()))
            .collect()
    }

    fn remove_results(&self) -> Result<(), IoError> {
        for entry in entries(&self.path)? {
            if entry.is_file && (is_result(&entry.name) || is_unfinished(&entry.name)) {
                remove(&self.path.join(&entry.name))?;
            }
        }
        for (subfolder, endings) in SUBFOLDERS {
            let place = self.path.join(subfolder);
            if !place.is_dir() {
                continue;
            }
            for entry in entries(&place)? {
                if entry.is_file && (has_one_of(&entry.name, endings) || is_unfinished(&entry.name))
                {
                    remove(&place.join(&entry.name))?;
                }
            }
        }
        Ok(())
    }
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
                    // A name that is no UTF-8 is none of ours; its lossy form keeps it in the count of other files.
                    name: entry.file_name().to_string_lossy().into_owned(),
                    is_file: entry.file_type()?.is_file(),
                })
            })
            .collect::<io::Result<_>>()
    };
    list().map_err(|source| IoError::writing(folder, source))
}

fn check_ours(path: &Path) -> Result<(), IoError> {
    let all = entries(path)?;
    let mut ours = all
        .iter()
        .any(|entry| entry.is_file && (entry.name == "run.json" || entry.name == "fields.pvd"));
    for (subfolder, endings) in SUBFOLDERS {
        let place = path.join(subfolder);
        if !ours && subfolder != PICTURES && place.is_dir() {
            ours = entries(&place)?
                .iter()
                .any(|entry| entry.is_file && has_one_of(&entry.name, endings));
        }
    }
    let empty = all
        .iter()
        .all(|entry| entry.name == LOCK || is_unfinished(&entry.name));
    // A run that died before its first report leaves the lock, sub-folders and tables behind.
    let begun = all.iter().any(|entry| entry.name == LOCK)
        && all.iter().all(|entry| {
            let name = &entry.name;
            let subfolder = SUBFOLDERS.iter().any(|(folder, _)| name == folder);
            name == LOCK
                || is_unfinished(name)
                || if entry.is_file {
                    is_result(name)
                } else {
                    subfolder
                }
        });
    if ours || empty || begun {
        Ok(())
    } else {
        Err(IoError::FolderNotOurs {
            path: path.to_path_buf(),
        })
    }
}

fn is_result(name: &str) -> bool {
    ["run.json", "fields.pvd", "report.html"].contains(&name) || has_one_of(name, &["csv"])
}

fn has_one_of(name: &str, endings: &[&str]) -> bool {
    let found = Path::new(name).extension();
    found.is_some_and(|found| endings.iter().any(|ending| found == *ending))
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
    fn an_existing_folder_is_refused() {
        let place = tempfile::tempdir().unwrap();
        let error = OutputFolder::create(place.path(), false).unwrap_err();
        assert!(matches!(error, IoError::FolderExists { .. }), "{error}");
        assert!(error.is_output_problem());
    }

    #[test]
    fn missing_parents_are_made() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a/b/c");
        let folder = OutputFolder::create(&path, false).unwrap();
        assert!(folder.path().is_dir());
        assert!(folder.subfolder("fields").unwrap().is_dir());
        assert!(folder.subfolder("fields").unwrap().is_dir());
    }

    #[test]
    fn force_removes_results_and_nothing_else() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("out");
        let results = [
            "run.json",
            "history.csv",
            "fields.pvd",
            "fields/fields_000000.vtu",
            "pictures/a.png",
            "pictures/a.apng",
            "checkpoints/step-000000000001.chk",
            "fields/.fields_000001.vtu.7-0.part",
        ];
        let strays = [
            "notes.txt",
            "fields/mine.vtp",
            "pictures/a.svg",
            "more/run.json",
            "checkpoints/README",
        ];
        populate(&path, &results);
        populate(&path, &strays);
        let _folder = OutputFolder::create(&path, true).unwrap();
        for file in results {
            assert!(!path.join(file).exists(), "{file}");
        }
        for file in strays {
            assert!(path.join(file).exists(), "{file}");
        }
    }

    #[test]
    fn force_refuses_a_folder_of_other_files() {
        let place = tempfile::tempdir().unwrap();
        populate(place.path(), &["thesis.tex", "data.csv", "pictures/me.png"]);
        let error = OutputFolder::create(place.path(), true).unwrap_err();
        assert!(matches!(error, IoError::FolderNotOurs { .. }), "{error}");
        assert!(place.path().join("data.csv").exists());
        assert!(!place.path().join(LOCK).exists());
    }

    #[test]
    fn force_takes_an_empty_folder_and_one_where_a_run_died_early() {
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
        populate(&path, &["run.json"]);
        for second in [OutputFolder::open(&path), OutputFolder::create(&path, true)] {
            assert!(matches!(second, Err(IoError::Locked { .. })), "{second:?}");
        }
        assert!(path.join("run.json").exists());
        drop(first);
        OutputFolder::open(&path).unwrap();
    }

    #[test]
    fn runs_started_together_get_different_folders() {
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
    fn opening_what_is_not_there_or_no_folder_fails() {
        let place = tempfile::tempdir().unwrap();
        let gone = OutputFolder::open(place.path().join("gone"));
        assert!(matches!(gone, Err(IoError::NotFound { .. })));
        populate(place.path(), &["file"]);
        let file = OutputFolder::open(place.path().join("file"));
        assert!(matches!(file, Err(IoError::Read { .. })), "{file:?}");
    }
}
