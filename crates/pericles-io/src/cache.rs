//! The cache on the disk.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use pericles::Archive;
use pericles::cache::{Cache, Key};
use serde_json::json;

use crate::{Container, IoError};

/// Results that are dear to compute, one checked file each, in a folder that all runs of a user share.
///
/// A file is a [`Container`], written whole or not at all and checked by its checksums and its key when it is read. One that is damaged is
/// not trusted: the caller computes again and replaces it. The cache may be deleted at any time.
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
    /// A cache in this folder, which is made when something is stored.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: folder.into(),
            memory: u64::MAX,
            notes: Mutex::default(),
        }
    }

    /// The user's cache: `$XDG_CACHE_HOME/pericles`, else `$HOME/.cache/pericles` (on Windows `%LOCALAPPDATA%\pericles`); none if no such variable is set.
    pub fn of_user() -> Option<Self> {
        let variable = |name| std::env::var_os(name).filter(|value| !value.is_empty());
        let base = variable("XDG_CACHE_HOME")
            .map(PathBuf::from)
            // The standard says to ignore relative paths.
            .filter(|path| path.is_absolute())
            .or_else(|| variable("LOCALAPPDATA").map(PathBuf::from))
            .or_else(|| variable("HOME").map(|home| Path::new(&home).join(".cache")))?;
        Some(Self::new(base.join("pericles")))
    }

    /// The same; an entry may take so many bytes of memory.
    #[must_use]
    pub fn within(self, memory: u64) -> Self {
        Self { memory, ..self }
    }

    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// What went wrong so far, in words: entries that were damaged or could not be written. Nothing is lost by either but time.
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
            Ok(_) => Err("it holds something else than its name says".to_owned()),
            Err(IoError::NotFound { .. }) => return None,
            Err(error) => Err(error.to_string()),
        };
        stored
            .map(|(_, archive)| archive)
            .map_err(|reason| {
                let path = path.display();
                self.note(format!("the cached {path} is computed again: {reason}"));
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
            self.note(format!("not cached: {error}"));
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
    fn a_damaged_or_misplaced_entry_is_not_trusted_but_replaced() {
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
    fn a_place_that_cannot_be_written_costs_a_note_only() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "").unwrap();
        let cache = DiskCache::new(file.join("cache"));
        let key = Key::new("test");
        cache.store(&key, &numbers());
        assert!(cache.load(&key).is_none());
        assert!(
            cache.notes()[0].starts_with("not cached"),
            "{:?}",
            cache.notes()
        );
    }
}
