//! Reading of the results of a run from its folder.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use pericles_io::{FieldData, IoError, PvdSeries, read_fields};
use serde_json::Value;

use crate::error::RunError;
use crate::machine;
use crate::source::SourceRecord;

/// The results of a run.
pub struct Results {
    folder: PathBuf,
    report: Value,
}

/// The field file of an output time.
pub struct FieldFile {
    /// The time, s.
    pub time: f64,
    /// The file.
    pub path: PathBuf,
}

impl FieldFile {
    /// Reads the fields.
    ///
    /// # Errors
    /// The file is missing or damaged.
    pub fn read(&self) -> Result<FieldData, RunError> {
        Ok(read_fields(&self.path, machine::memory())?)
    }
}

impl Results {
    /// Opens the output folder of a run.
    ///
    /// # Errors
    /// The folder has no `run.json`, or it is invalid.
    pub fn open(folder: &Path) -> Result<Self, RunError> {
        let path = folder.join("run.json");
        let reason = match (folder.is_dir(), folder.exists()) {
            (true, _) => (!path.exists()).then_some("it has no run.json"),
            (false, true) => Some("it is a file"),
            (false, false) => Some("it does not exist"),
        };
        if let Some(reason) = reason {
            return Err(RunError::NoResults {
                path: folder.into(),
                reason,
            });
        }
        let text =
            std::fs::read_to_string(&path).map_err(|error| IoError::reading(&path, error))?;
        let report: Value = serde_json::from_str(&text).map_err(|error| RunError::Damaged {
            path,
            reason: error.to_string(),
        })?;
        if report.pointer("/program/name") != Some(&Value::from("pericles")) {
            return Err(RunError::NoResults {
                path: folder.into(),
                reason: "its run.json was not written by Pericles",
            });
        }
        Ok(Self {
            folder: folder.into(),
            report,
        })
    }

    /// Returns the output folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns a value of `run.json` by its JSON pointer, such as `/model/points`.
    pub fn value(&self, pointer: &str) -> Option<&Value> {
        self.report.pointer(pointer)
    }

    /// Returns a string of `run.json`; empty if missing.
    pub fn text(&self, pointer: &str) -> &str {
        self.value(pointer)
            .and_then(Value::as_str)
            .unwrap_or_default()
    }

    /// Returns a number of `run.json`.
    pub fn number(&self, pointer: &str) -> Option<f64> {
        self.value(pointer)?.as_f64()
    }

    /// Returns the SI unit of a number of `run.json`, such as `audit.balance`; empty for ratios and counts.
    pub fn unit_of(&self, name: &str) -> String {
        let key = name.rsplit('.').next().unwrap_or(name);
        self.text(&format!("/units/{key}")).to_owned()
    }

    /// Returns a count of `run.json`; zero if missing.
    pub fn count(&self, pointer: &str) -> u64 {
        self.value(pointer)
            .and_then(Value::as_u64)
            .unwrap_or_default()
    }

    /// Returns the strings of a list of `run.json`.
    pub fn texts(&self, pointer: &str) -> impl Iterator<Item = &str> {
        let list = self.value(pointer).and_then(Value::as_array);
        list.into_iter().flatten().filter_map(Value::as_str)
    }

    /// Returns the source of the run: the deck or the model.
    ///
    /// # Errors
    /// `run.json` has neither.
    pub fn source(&self) -> Result<SourceRecord, RunError> {
        let kept = ["deck", "model_data"].into_iter().filter_map(|key| {
            let value = self.report.get(key)?;
            Some((key.to_owned(), value.clone()))
        });
        let kept = Value::Object(kept.collect());
        serde_json::from_value(kept).map_err(|error| self.damaged("run.json", error.to_string()))
    }

    /// Creates the error for an unusable file of the folder.
    pub fn damaged(&self, file: &str, reason: String) -> RunError {
        RunError::Damaged {
            path: self.folder.join(file),
            reason,
        }
    }

    /// Returns the field files in the order of time; empty if the deck requested no fields.
    ///
    /// # Errors
    /// The series cannot be read.
    pub fn fields(&self) -> Result<Vec<FieldFile>, RunError> {
        let series = self.folder.join("fields.pvd");
        if !series.exists() {
            return Ok(Vec::new());
        }
        let located = |(time, file): (f64, PathBuf)| FieldFile {
            time,
            path: self.folder.join(file),
        };
        Ok(PvdSeries::read(series)?.into_iter().map(located).collect())
    }

    /// Returns whether the run wrote fields, in any format.
    pub fn has_fields(&self) -> bool {
        let files = ["fields.pvd", "fields.exo", "fields.vtkhdf"];
        files.iter().any(|file| self.folder.join(file).exists())
    }

    /// Returns the tables, sorted by name.
    pub fn tables(&self) -> Vec<PathBuf> {
        files(&self.folder, "csv")
    }

    /// Returns the pictures, sorted by name.
    pub fn pictures(&self) -> Vec<PathBuf> {
        let folder = self.folder.join("pictures");
        if folder.is_symlink() {
            return Vec::new();
        }
        files(&folder, "png")
    }

    /// Returns the steps of the checkpoints.
    pub fn checkpoints(&self) -> Vec<u64> {
        let step = |path: PathBuf| {
            let stem = path.file_stem()?.to_str()?;
            stem.strip_prefix("step-")?.parse().ok()
        };
        let all = files(&self.folder.join("checkpoints"), "chk");
        all.into_iter().filter_map(step).collect()
    }
}

/// Returns the files of a folder with an extension, sorted; empty if the folder does not exist. Symbolic links are
/// ignored: their targets are not results of the run and must not be included in a report.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<_> = entries
        .filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_file()))
        .map(|entry| entry.path())
        .filter(|path| path.extension() == Some(OsStr::new(ending)))
        .collect();
    paths.sort();
    paths
}

/// Returns the last component of a path as text.
pub fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}
