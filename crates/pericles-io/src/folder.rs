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
const SUBFOLDERS: [&str; 5] = ["fields", "cells", "impactors", "pictures", "checkpoints"];

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
    /// of an earlier run, and subfolders without other files, are removed; all other files are kept. Symbolic links with
    /// their names are removed, not their targets. A folder that is neither empty nor the output of a run is always rejected.
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
        if path.is_symlink() {
            return Err(IoError::Link { path });
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
    /// Returns an error if the manifest cannot be written, and for a symbolic link with one of the names, or in the place of
    /// one of their folders: nothing is written through links.
    pub fn claim(&self, names: &[String]) -> Result<(), IoError> {
        if self.lock.is_none() {
            return Ok(());
        }
        let claimed = Manifest::named(names);
        if let Some(path) = self.links(&claimed)?.into_iter().next() {
            return Err(IoError::Link { path });
        }
        Manifest::add(&self.path, names)
    }

    fn lock(path: PathBuf) -> Result<Self, IoError> {
        let lock = path.join(LOCK);
        if lock.is_symlink() {
            return Err(IoError::Link { path: lock });
        }
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

    /// Returns the symbolic links in the folder that have the names of results, or of a folder of results.
    fn links(&self, manifest: &Manifest) -> Result<Vec<PathBuf>, IoError> {
        let mut links = Vec::new();
        for (prefix, place) in self.prefixed_places() {
            if place.is_symlink() && !prefix.is_empty() {
                links.extend(manifest.has_any_in(&prefix).then_some(place));
                continue;
            }
            if !is_folder(&place) {
                continue;
            }
            for entry in entries(&place)? {
                let name = finished_name(&entry.name).unwrap_or(&entry.name);
                if entry.is_link && manifest.has(&format!("{prefix}{name}")) {
                    links.push(place.join(&entry.name));
                }
            }
        }
        Ok(links)
    }

    /// Returns the folder and its sub-folders, whether they exist or not, with the beginning of the recorded names of
    /// their files.
    fn prefixed_places(&self) -> impl Iterator<Item = (String, PathBuf)> {
        let own = std::iter::once((String::new(), self.path.clone()));
        own.chain(SUBFOLDERS.map(|name| (format!("{name}/"), self.path.join(name))))
    }

    fn remove_results(&self, manifest: &Manifest) -> Result<(), IoError> {
        for link in self.links(manifest)? {
            remove(&link)?;
        }
        for (prefix, place) in self.prefixed_places() {
            if !is_folder(&place) {
                continue;
            }
            for entry in entries(&place)? {
                let name = finished_name(&entry.name).unwrap_or(&entry.name);
                if entry.is_file && manifest.has(&format!("{prefix}{name}")) {
                    remove(&place.join(&entry.name))?;
                }
            }
            if !prefix.is_empty() {
                // A folder with other files remains.
                let _ = fs::remove_dir(&place);
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
    is_link: bool,
}

fn entries(folder: &Path) -> Result<Vec<Entry>, IoError> {
    let list = || {
        fs::read_dir(folder)?
            .map(|entry| {
                let entry = entry?;
                let kind = entry.file_type()?;
                Ok(Entry {
                    // Names that are not UTF-8 are not Pericles files; the lossy form counts them among the
                    // other files.
                    name: entry.file_name().to_string_lossy().into_owned(),
                    is_file: kind.is_file(),
                    is_link: kind.is_symlink(),
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
    // A run that stopped before it recorded its files leaves the lock and files that are not complete.
    let is_begun = |entry: &Entry| entry.name == LOCK || finished_name(&entry.name).is_some();
    if all.iter().all(is_begun) {
        Ok(Manifest::default())
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
mod tests;
