//! Manifest: the files that a run may write into its folder, recorded in advance; `--force` removes only these.
//!
//! The file `.manifest` has one line per name, relative to the folder; `*` stands for one or more digits, for
//! series such as `fields/fields_*.vtu`. Folders of versions without a manifest are recognised by the content
//! of `run.json`.

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::Path;

use pericles::observe::Field;
use serde_json::Value;

use crate::{IoError, write_atomically};

/// Name of the manifest file.
pub(super) const MANIFEST: &str = ".manifest";

const HEADING: &str = "# Files of a Pericles run";

/// Files of a run other than field pictures, whose names begin with a field name.
const USUAL: [&str; 12] = [
    "run.json",
    "report.html",
    "fields.pvd",
    "history.csv",
    "reactions.csv",
    "probes.csv",
    "cracks.csv",
    "fragments.csv",
    "surface.csv",
    "fields/fields_*.vtu",
    "checkpoints/step-*.chk",
    "checkpoints/failed.chk",
];

/// Recorded names.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Manifest {
    names: Vec<String>,
    /// Whether pictures of fields are included, which versions without a manifest did not record.
    pictures: bool,
}

impl Manifest {
    /// Returns the names that versions without a manifest wrote.
    pub(super) fn usual() -> Self {
        Self {
            names: USUAL.map(String::from).to_vec(),
            pictures: true,
        }
    }

    /// Returns a manifest of these names.
    pub(super) fn named(names: &[String]) -> Self {
        Self {
            names: names.to_vec(),
            pictures: false,
        }
    }

    /// Returns whether a name begins with the name of a sub-folder, which ends with `/`.
    pub(super) fn has_any_in(&self, prefix: &str) -> bool {
        self.pictures && prefix == "pictures/"
            || self.names.iter().any(|name| name.starts_with(prefix))
    }

    /// Reads the manifest of a folder; `None` if the folder does not belong to a run.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read.
    pub(super) fn of(folder: &Path) -> Result<Option<Self>, IoError> {
        let path = folder.join(MANIFEST);
        match fs::read_to_string(&path) {
            Ok(text) => Ok(Self::parse(&text)),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                Ok(is_report(&folder.join("run.json")).then(Self::usual))
            }
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
            pictures: false,
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
        self.names.iter().any(|pattern| matches(pattern, name)) || self.pictures && is_picture(name)
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

/// Returns whether a name is that of a field picture or animation.
fn is_picture(name: &str) -> bool {
    let Some(name) = name.strip_prefix("pictures/") else {
        return false;
    };
    let stem = match name.strip_suffix(".apng") {
        Some(stem) => Some(stem),
        None => name
            .strip_suffix(".png")
            .and_then(|stem| stem.rsplit_once('-'))
            .filter(|(_, number)| number.len() >= 6 && is_number(number))
            .map(|(stem, _)| stem),
    };
    stem.is_some_and(|stem| {
        Field::ALL
            .iter()
            .any(|field| stem.starts_with(field.name()))
    })
}

/// Returns whether a file is the report of a Pericles run: other programs write a `run.json` as well.
fn is_report(path: &Path) -> bool {
    let report = || -> Option<Value> { serde_json::from_str(&fs::read_to_string(path).ok()?).ok() };
    report().is_some_and(|report| {
        report.pointer("/program/name") == Some(&Value::from("pericles"))
            && report.pointer("/deck/source").is_some()
    })
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
        for (name, ours) in [
            ("pictures/Damage-000002.png", true),
            ("pictures/Velocity_y_2-000002.png", true),
            ("pictures/Damage.apng", true),
            ("pictures/Damage-best.png", false),
            ("pictures/me-000001.png", false),
            ("Damage-000002.png", false),
        ] {
            assert_eq!(is_picture(name), ours, "{name}");
        }
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
