//! Input files of a deck or model with their digests, so that a run is not resumed with changed files.
//!
//! Checkpoints and `run.json` contain the SHA-256 digest of every file named by the deck; a run with changed inputs
//! is not resumed.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use pericles_deck::Model;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::error::RunError;

/// The input files of a model at the start of the run. Empty for models without files.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// The base folder of relative paths; absolute.
    folder: Option<PathBuf>,
    files: Vec<Input>,
}

/// An input file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Input {
    /// The path as given in the model.
    file: PathBuf,
    /// SHA-256 of the content in hexadecimal digits.
    sha256: String,
}

impl Inputs {
    /// Records the files of a model with paths relative to `folder`. Unreadable files are omitted; they lead to an
    /// error when they are read.
    pub fn of(model: &Model, folder: &Path) -> Self {
        let inputs: Vec<Input> = model
            .files()
            .into_iter()
            .filter_map(|named| {
                Some(Input {
                    file: named.to_path_buf(),
                    sha256: digest(&folder.join(named)).ok()?,
                })
            })
            .collect();
        Self {
            // A folder name that is not UTF-8 has no JSON; then the path of the deck is used alone.
            folder: folder_of(&folder.join("deck"))
                .filter(|folder| !inputs.is_empty() && folder.to_str().is_some()),
            files: inputs,
        }
    }

    /// Returns whether no file is recorded.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Returns the base folder of relative paths; empty for the current folder and for models without files.
    pub fn folder(&self) -> &Path {
        self.folder.as_deref().unwrap_or(Path::new(""))
    }

    /// Returns the path of a deck from which its files are found: as given, or absolute if it was given relative to a
    /// folder other than the current one.
    pub fn located(&self, file: &str) -> String {
        let name = Path::new(file).file_name();
        match (&self.folder, name) {
            (Some(folder), Some(name))
                if folder.is_dir() && folder_of(Path::new(file)).as_ref() != Some(folder) =>
            {
                folder.join(name).display().to_string()
            }
            _ => file.to_owned(),
        }
    }

    /// Checks that the files have not changed since the start of the run; paths are relative to `folder`.
    ///
    /// # Errors
    /// A file is missing, or its content has changed.
    pub fn check(&self, folder: &Path) -> Result<(), RunError> {
        for input in &self.files {
            let path = folder.join(&input.file);
            let reason = match digest(&path) {
                Ok(found) if found == input.sha256 => continue,
                Ok(_) => "its content has changed since the run started".to_owned(),
                Err(error) if error.kind() == io::ErrorKind::NotFound => {
                    "it no longer exists".to_owned()
                }
                Err(error) => format!("it cannot be read ({error})"),
            };
            return Err(RunError::InputChanged { path, reason });
        }
        Ok(())
    }
}

/// Returns the absolute folder of a file.
fn folder_of(file: &Path) -> Option<PathBuf> {
    let path = std::path::absolute(file).ok()?;
    Some(path.parent()?.to_path_buf())
}

/// Returns the SHA-256 of the content of a file in hexadecimal digits.
fn digest(path: &Path) -> io::Result<String> {
    // A pipe can be read only once.
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "not a regular file",
        ));
    }
    let mut file = File::open(path)?;
    let mut hash = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(format!("{:x}", hash.finalize())),
            count => hash.update(&buffer[..count]),
        }
    }
}
