//! On-disk cache of expensive results.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use pericles::Archive;
use pericles::cache::{Cache, Key};
use serde_json::json;

use crate::{Container, IoError};

/// Cache of expensive results: one file with checksums per result, in a folder shared by all runs of a user.
///
/// Each file is a [`Container`], written atomically; its checksums and key are verified when it is read.
/// Damaged entries are recomputed and replaced. The cache may be deleted at any time.
///
/// ```
/// use pericles::{Archive, Values, cache::{Cache, Key}};
/// let folder = tempfile::tempdir().unwrap();
/// let cache = pericles_io::DiskCache::new(folder.path().join("cache"));
/// let key = Key::new("squares").u64s(&[3]);
/// assert!(cache.load(&key).is_none());
/// let mut squares = Archive::default();
/// squares.put("values", Values::U64(vec![0, 1, 4]));
/// cache.store(&key, &squares);
/// assert_eq!(cache.load(&key), Some(squares));
/// assert!(cache.notes().is_empty());
/// ```
#[derive(Debug)]
pub struct DiskCache {
    folder: PathBuf,
    memory: u64,
    notes: Mutex<Vec<String>>,
}

impl DiskCache {
    /// Creates a cache in `folder`; the folder is created when the first result is stored.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: folder.into(),
            memory: u64::MAX,
            notes: Mutex::default(),
        }
    }

    /// Returns the user's cache: `$XDG_CACHE_HOME/pericles`, else `$HOME/.cache/pericles` (on Windows
    /// `%LOCALAPPDATA%\pericles`); `None` if no such variable is set.
    pub fn of_user() -> Option<Self> {
        let variable = |name| std::env::var_os(name).filter(|value| !value.is_empty());
        let base = variable("XDG_CACHE_HOME")
            .map(PathBuf::from)
            // The XDG standard requires that relative paths are ignored.
            .filter(|path| path.is_absolute())
            .or_else(|| variable("LOCALAPPDATA").map(PathBuf::from))
            .or_else(|| variable("HOME").map(|home| Path::new(&home).join(".cache")))?;
        Some(Self::new(base.join("pericles")))
    }

    /// Sets the memory limit per entry, in bytes.
    #[must_use]
    pub fn within(self, memory: u64) -> Self {
        Self { memory, ..self }
    }

    /// Returns the folder of the cache.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns messages about damaged entries and failed writes. Neither affects results, only computing time.
    pub fn notes(&self) -> Vec<String> {
        self.notes.lock().map_or_else(
            |poisoned| poisoned.into_inner().clone(),
            |notes| notes.clone(),
        )
    }

    fn note(&self, text: String) {
        if let Ok(mut notes) = self.notes.lock() {
            notes.push(text);
        }
    }

    fn path(&self, key: &Key) -> PathBuf {
        self.folder
            .join(format!("{}-{}.cache", key.kind(), key.digest()))
    }
}

impl Cache for DiskCache {
    fn load(&self, key: &Key) -> Option<Archive> {
        let path = self.path(key);
        let stored = match Container::read(&path, self.memory) {
            Ok(container) if container.metadata == name(key) => container.into_archive(),
            Ok(_) => Err("its content does not match its key".to_owned()),
            Err(IoError::NotFound { .. }) => return None,
            Err(error) => Err(error.to_string()),
        };
        stored
            .map(|(_, archive)| archive)
            .map_err(|reason| {
                let path = path.display();
                self.note(format!(
                    "{path} in the cache cannot be used and is recomputed: {reason}"
                ));
            })
            .ok()
    }

    fn store(&self, key: &Key, arrays: &Archive) {
        let container = Container::from_archive(name(key), arrays.clone());
        let path = self.path(key);
        let written = std::fs::create_dir_all(&self.folder)
            .map_err(|source| IoError::writing(&self.folder, source))
            .and_then(|()| container.write(&path));
        if let Err(error) = written {
            self.note(format!("the result is not cached: {error}"));
        }
    }
}

fn name(key: &Key) -> serde_json::Value {
    json!({ "kind": key.kind(), "key": key.digest() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::Values;
    use std::fs;

    fn numbers() -> Archive {
        let mut archive = Archive::default();
        archive.put("x", Values::F64(vec![0.5, -0.0, f64::NAN]));
        archive.put("y", Values::U8(vec![1; 100]));
        archive
    }

    #[test]
    fn a_damaged_or_misplaced_entry_is_rejected_and_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let cache = DiskCache::new(folder.path());
        let [key, other] = [1, 2].map(|n| Key::new("test").u64s(&[n]));
        cache.store(&key, &numbers());
        let whole = fs::read(cache.path(&key)).unwrap();
        for cut in [0, 10, whole.len() / 2, whole.len() - 1] {
            fs::write(cache.path(&key), &whole[..cut]).unwrap();
            assert!(cache.load(&key).is_none(), "{cut}");
        }
        fs::write(cache.path(&other), &whole).unwrap();
        assert!(cache.load(&other).is_none());
        assert_eq!(cache.notes().len(), 5, "{:?}", cache.notes());
        cache.store(&key, &numbers());
        assert!(cache.load(&key).is_some());
    }

    #[test]
    fn a_cache_that_cannot_be_written_only_adds_a_note() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "").unwrap();
        let cache = DiskCache::new(file.join("cache"));
        let key = Key::new("test");
        cache.store(&key, &numbers());
        assert!(cache.load(&key).is_none());
        assert!(
            cache.notes()[0].starts_with("the result is not cached"),
            "{:?}",
            cache.notes()
        );
    }
}
