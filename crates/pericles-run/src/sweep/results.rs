//! Results of a sweep, read from its folder whether or not it is running.

use std::path::{Path, PathBuf};

use super::record::{Member, Record};
use crate::error::RunError;
use crate::json::read_json;
use crate::results::Results;

/// The record of a sweep in its folder.
const RECORD: &str = "sweep.json";

/// Returns whether a folder contains a sweep.
pub fn is_sweep(folder: &Path) -> bool {
    folder.join(RECORD).is_file()
}

/// The deck, the values and the results of a sweep.
pub struct SweepResults {
    pub(super) record: Record,
    pub(super) members: Vec<Member>,
    folder: PathBuf,
}

impl SweepResults {
    /// Reads the record of a sweep.
    ///
    /// # Errors
    /// The folder does not contain a sweep.
    pub fn open(folder: &Path) -> Result<Self, RunError> {
        let record: Record = read_json(&folder.join(RECORD))?;
        Ok(Self::of(record, folder))
    }

    pub(super) fn of(record: Record, folder: &Path) -> Self {
        Self {
            members: record.members(),
            record,
            folder: folder.to_owned(),
        }
    }

    /// Returns the path of the record in a folder.
    pub(super) fn record_file(folder: &Path) -> PathBuf {
        folder.join(RECORD)
    }

    /// Returns the folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the file of the deck as given on the command line.
    pub fn deck_file(&self) -> &str {
        &self.record.deck.file
    }

    /// Returns the keys with their values, in the order of the command line.
    pub fn keys(&self) -> impl Iterator<Item = (&str, &[String])> {
        let axes = self.record.axes.iter();
        axes.map(|axis| (axis.key.as_str(), axis.values.as_slice()))
    }

    /// Returns the values of the keys of each run as written in decks.
    pub fn values(&self) -> impl Iterator<Item = &[String]> {
        self.members.iter().map(|member| member.values.as_slice())
    }

    /// Returns the name of each run, also the name of its folder, and its results if there are any.
    pub fn runs(&self) -> impl Iterator<Item = (&str, Option<Results>)> {
        self.members.iter().map(|member| {
            let results = Results::open(&self.folder.join(&member.name));
            (member.name.as_str(), results.ok())
        })
    }
}
