//! The files that a deck or model names, with their digests, so that no run continues with other content.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use pericles_deck::Model;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::error::RunError;

/// The files that a model names, as they were when the run began. Empty for models without files, and for runs of versions that did not record them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// The folder where relative paths start; absolute.
    folder: Option<PathBuf>,
    files: Vec<Input>,
}

/// A file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Input {
    /// As the model names it.
    file: PathBuf,
    /// Its content's SHA-256 in hexadecimal digits.
    sha256: String,
}

impl Inputs {
    /// The files of a model whose relative paths start at `folder`. Those that cannot be read are left out: they are refused where they are needed.
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
            // A folder whose name is no text has no JSON; the deck's own path then serves alone.
            folder: folder_of(&folder.join("deck"))
                .filter(|folder| !inputs.is_empty() && folder.to_str().is_some()),
            files: inputs,
        }
    }

    /// Whether nothing is recorded.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// The folder where relative paths of a model start; empty for the present folder and for models without files.
    pub fn folder(&self) -> &Path {
        self.folder.as_deref().unwrap_or(Path::new(""))
    }

    /// A deck's path, by which its files are found: as it was given, or absolute if it was given from another folder than the present one.
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

    /// Refuses files that have changed since the run began; relative paths start at `folder`.
    ///
    /// # Errors
    /// The first file that no longer exists, or whose content has changed.
    pub fn check(&self, folder: &Path) -> Result<(), RunError> {
        for input in &self.files {
            let path = folder.join(&input.file);
            let reason = match digest(&path) {
                Ok(found) if found == input.sha256 => continue,
                Ok(_) => "its content has changed since the run began".to_owned(),
                Err(error) if error.kind() == io::ErrorKind::NotFound => {
                    "it does not exist any more".to_owned()
                }
                Err(error) => format!("it cannot be read ({error})"),
            };
            return Err(RunError::InputChanged { path, reason });
        }
        Ok(())
    }
}

/// The folder of a file, absolute.
fn folder_of(file: &Path) -> Option<PathBuf> {
    let path = std::path::absolute(file).ok()?;
    Some(path.parent()?.to_path_buf())
}

/// SHA-256 of a file's content, in hexadecimal digits.
fn digest(path: &Path) -> io::Result<String> {
    // What a pipe gives is gone once it is read.
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "it is no regular file",
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
