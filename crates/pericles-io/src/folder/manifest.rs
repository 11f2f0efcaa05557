//! Manifest: the files that a run may write into its folder, recorded in advance; `--force` removes only these.
//!
//! The file `.manifest` has one line per name, relative to the folder; `*` stands for one or more digits, for
//! series such as `fields/fields_*.vtu`.

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::Path;

use crate::{IoError, write_atomically};

/// Name of the manifest file.
pub(super) const MANIFEST: &str = ".manifest";

const HEADING: &str = "# Files of a Pericles run";

/// Recorded names.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Manifest {
    names: Vec<String>,
}

impl Manifest {
    /// Returns a manifest of these names.
    pub(super) fn named(names: &[String]) -> Self {
        Self {
            names: names.to_vec(),
        }
    }

    /// Returns whether a name begins with the name of a sub-folder, which ends with `/`.
    pub(super) fn has_any_in(&self, prefix: &str) -> bool {
        self.names.iter().any(|name| name.starts_with(prefix))
    }

    /// Reads the manifest of a folder; `None` if there is no manifest, or the file is not one.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read.
    pub(super) fn of(folder: &Path) -> Result<Option<Self>, IoError> {
        let path = folder.join(MANIFEST);
        match fs::read_to_string(&path) {
            Ok(text) => Ok(Self::parse(&text)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(IoError::reading(&path, error)),
        }
    }

    fn parse(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        if lines.next() != Some(HEADING) {
            return None;
        }
        Some(Self {
            names: lines.map(str::to_owned).collect(),
        })
    }

    /// Adds names to the manifest of a folder.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read or written.
    pub(super) fn add(folder: &Path, names: &[String]) -> Result<(), IoError> {
        let path = folder.join(MANIFEST);
        let mut known = match fs::read_to_string(&path) {
            Ok(text) => Self::parse(&text).unwrap_or_default(),
            Err(error) if error.kind() == ErrorKind::NotFound => Self::default(),
            Err(error) => return Err(IoError::reading(&path, error)),
        };
        for name in names {
            if !known.names.contains(name) {
                known.names.push(name.clone());
            }
        }
        write_atomically(&path, |file| {
            writeln!(file, "{HEADING}")?;
            known
                .names
                .iter()
                .try_for_each(|name| writeln!(file, "{name}"))
        })
    }

    /// Returns whether a file name, relative to the folder, is recorded; `/` separates a sub-folder.
    pub(super) fn has(&self, name: &str) -> bool {
        self.names.iter().any(|pattern| matches(pattern, name))
    }
}

/// Returns whether a name matches a pattern in which `*` stands for one or more digits.
fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((before, after)) => name
            .strip_prefix(before)
            .and_then(|rest| rest.strip_suffix(after))
            .is_some_and(is_number),
    }
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_matches_only_digits() {
        let pattern = "fields/fields_*.vtu";
        assert!(matches(pattern, "fields/fields_000012.vtu"));
        for other in [
            "fields/fields_.vtu",
            "fields/fields_best.vtu",
            "fields/mine.vtu",
            "fields_000012.vtu",
        ] {
            assert!(!matches(pattern, other), "{other}");
        }
        assert!(matches("run.json", "run.json") && !matches("run.json", "old-run.json"));
    }

    #[test]
    fn names_are_added_once_and_other_files_are_not_read_as_a_manifest() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path();
        assert_eq!(Manifest::of(folder).unwrap(), None);
        for _ in 0..2 {
            Manifest::add(folder, &["run.json".into(), "fields/fields_*.vtu".into()]).unwrap();
        }
        let manifest = Manifest::of(folder).unwrap().unwrap();
        assert_eq!(manifest.names, ["run.json", "fields/fields_*.vtu"]);
        assert!(manifest.has("fields/fields_000000.vtu") && !manifest.has("history.csv"));
        fs::write(folder.join(MANIFEST), "history.csv\n").unwrap();
        assert_eq!(Manifest::of(folder).unwrap(), None);
    }
}
