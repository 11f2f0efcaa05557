//! Folder of checkpoints: keeps the last two and finds the newest valid one.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use pericles::division::DividedArchive;
use pericles::domain::{Comm, distribute};
use serde_json::Value;

use super::divided::agreed;
use super::{Container, DividedCheckpoint, write_divided};
use crate::IoError;

/// Number of checkpoints kept.
const KEPT: usize = 2;

/// A folder of checkpoints named by step, `step-000000001840.chk`.
#[derive(Debug, Clone)]
pub struct CheckpointFolder {
    path: PathBuf,
}

/// The newest valid checkpoint.
#[derive(Debug)]
pub struct LatestCheckpoint {
    /// The step after which it was written.
    pub step: u64,
    /// Its file.
    pub path: PathBuf,
    /// Its content.
    pub container: Container,
    /// Errors of newer checkpoints that were rejected, newest first.
    pub rejected: Vec<IoError>,
}

impl CheckpointFolder {
    /// Creates a handle to the folder; the folder itself is created with the first checkpoint.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into() }
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the file name of the checkpoint of a step.
    pub fn file(&self, step: u64) -> PathBuf {
        self.path.join(format!("step-{step:012}.chk"))
    }

    /// Writes the checkpoint of a step and deletes all others except the previous one.
    ///
    /// Checkpoints of later steps are deleted as well: they remain from a run that was resumed at an earlier
    /// step.
    pub fn write(&self, step: u64, container: &Container) -> Result<PathBuf, IoError> {
        self.create()?;
        let file = self.file(step);
        container.write(&file)?;
        self.retain(step)?;
        Ok(file)
    }

    /// Writes the checkpoint of a divided body as [`CheckpointFolder::write`]; see [`write_divided`]. All processes must call
    /// it together.
    ///
    /// # Errors
    /// Those of the first process and of [`write_divided`].
    pub fn write_divided(
        &self,
        step: u64,
        metadata: &Value,
        archive: DividedArchive<'_>,
    ) -> Result<PathBuf, IoError> {
        let file = self.file(step);
        let comm = Arc::clone(archive.domain().comm());
        let on_first = |work: &dyn Fn() -> Result<(), IoError>| {
            let done = if comm.rank() == 0 { work() } else { Ok(()) };
            agreed(&*comm, &file, done)
        };
        on_first(&|| self.create())?;
        write_divided(&file, metadata, archive)?;
        on_first(&|| self.retain(step))?;
        Ok(file)
    }

    /// Creates the folder.
    fn create(&self) -> Result<(), IoError> {
        // Parent folders are not created: if the output folder was deleted, the run must not recreate it.
        match fs::create_dir(&self.path) {
            Err(source) if source.kind() != ErrorKind::AlreadyExists => {
                Err(IoError::writing(&self.path, source))
            }
            _ => Ok(()),
        }
    }

    /// Deletes all checkpoints except that of a step and the previous one.
    fn retain(&self, step: u64) -> Result<(), IoError> {
        let earlier: Vec<_> = self.steps()?.into_iter().filter(|&s| s <= step).collect();
        let kept = &earlier[earlier.len().saturating_sub(KEPT)..];
        for step in self.steps()? {
            if !kept.contains(&step) {
                let old = self.file(step);
                fs::remove_file(&old).map_err(|source| IoError::writing(&old, source))?;
            }
        }
        Ok(())
    }

    /// Returns the steps that have a checkpoint, in increasing order.
    pub fn steps(&self) -> Result<Vec<u64>, IoError> {
        let reading = |source| IoError::reading(&self.path, source);
        let mut steps = Vec::new();
        for entry in fs::read_dir(&self.path).map_err(reading)? {
            let name = entry.map_err(reading)?.file_name();
            let step = name.to_str().and_then(|name| {
                let digits = name.strip_prefix("step-")?.strip_suffix(".chk")?;
                digits.parse().ok()
            });
            // Names in another form, such as step-7.chk, are not written by Pericles.
            steps.extend(step.filter(|&step| self.file(step).file_name() == Some(&name)));
        }
        steps.sort_unstable();
        Ok(steps)
    }

    /// Reads the newest valid checkpoint and reports newer ones that were rejected. Its content may take at
    /// most `memory` bytes.
    pub fn latest_valid(&self, memory: u64) -> Result<LatestCheckpoint, IoError> {
        let mut rejected = Vec::new();
        for step in self.steps()?.into_iter().rev() {
            let path = self.file(step);
            match Container::read(&path, memory) {
                Ok(container) => {
                    return Ok(LatestCheckpoint {
                        step,
                        path,
                        container,
                        rejected,
                    });
                }
                // The previous checkpoint needs the same memory.
                Err(error @ IoError::TooLarge { .. }) => return Err(error),
                Err(error) => rejected.push(error),
            }
        }
        Err(IoError::NoValidCheckpoint {
            path: self.path.clone(),
            rejected,
        })
    }

    /// Opens the newest valid checkpoint for the processes of a divided body, as [`CheckpointFolder::latest_valid`], and
    /// returns the errors of newer ones that were rejected. The part of a process may take at most `memory` bytes. All
    /// processes must call it together.
    ///
    /// # Errors
    /// As for [`CheckpointFolder::latest_valid`], on the first process; the others return [`IoError::OnAnotherProcess`].
    pub fn latest_divided(
        &self,
        memory: u64,
        comm: &dyn Comm,
    ) -> Result<(DividedCheckpoint, Vec<IoError>), IoError> {
        let steps = (comm.rank() == 0).then(|| self.steps()).transpose();
        let steps = agreed(comm, &self.path, steps)?;
        let words = steps.map(|steps| steps.into_iter().rev().map(f64::from_bits).collect());
        let words = words.map(|words: Vec<f64>| vec![words; comm.size()]);
        let mut rejected = Vec::new();
        for word in distribute(comm, words) {
            match DividedCheckpoint::open(&self.file(word.to_bits()), memory, comm) {
                Ok(checkpoint) => return Ok((checkpoint, rejected)),
                Err(error) => rejected.push(error),
            }
            // The previous checkpoint needs the same memory.
            let last = rejected.pop_if(|error| matches!(error, IoError::TooLarge { .. }));
            agreed(comm, &self.path, last.map_or(Ok(()), Err))?;
        }
        Err(match comm.rank() {
            0 => IoError::NoValidCheckpoint {
                path: self.path.clone(),
                rejected,
            },
            _ => IoError::OnAnotherProcess {
                path: self.path.clone(),
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Section;

    fn state(step: u64) -> Container {
        let mut container = Container::default();
        let section = Section::U64(vec![step; 9]);
        container.sections.insert("step".into(), section);
        container
    }

    fn damage(path: &Path) {
        let mut bytes = fs::read(path).unwrap();
        *bytes.last_mut().unwrap() ^= 1;
        fs::write(path, bytes).unwrap();
    }

    #[test]
    fn the_last_two_checkpoints_are_kept_and_other_files_are_untouched() {
        let place = tempfile::tempdir().unwrap();
        let folder = CheckpointFolder::new(place.path().join("checkpoints"));
        for step in [20, 40, 1840] {
            let path = folder.write(step, &state(step)).unwrap();
            fs::write(folder.path().join("step-7.chk"), "mine").unwrap();
            assert!(path.exists());
        }
        assert_eq!(folder.steps().unwrap(), [40, 1840]);
        assert!(folder.path().join("step-000000001840.chk").exists());
        assert!(folder.path().join("step-7.chk").exists());
    }

    #[test]
    fn the_previous_checkpoint_replaces_a_damaged_one() {
        let place = tempfile::tempdir().unwrap();
        let folder = CheckpointFolder::new(place.path());
        for step in [100, 200] {
            folder.write(step, &state(step)).unwrap();
        }
        assert_eq!(folder.latest_valid(u64::MAX).unwrap().step, 200);
        damage(&folder.file(200));
        let latest = folder.latest_valid(u64::MAX).unwrap();
        assert_eq!((latest.step, latest.container), (100, state(100)));
        assert_eq!(latest.rejected.len(), 1);
        assert_eq!(latest.rejected[0].path(), folder.file(200));

        // The run resumes from step 100: the damaged file must not displace valid ones.
        folder.write(150, &state(150)).unwrap();
        assert_eq!(folder.steps().unwrap(), [100, 150]);

        damage(&folder.file(100));
        damage(&folder.file(150));
        let none = folder.latest_valid(u64::MAX).unwrap_err();
        assert!(
            matches!(&none, IoError::NoValidCheckpoint { rejected, .. } if rejected.len() == 2)
        );
        assert!(none.to_string().contains("CRC-32"), "{none}");
    }

    #[test]
    fn an_empty_folder_and_a_missing_folder_give_different_errors() {
        let place = tempfile::tempdir().unwrap();
        let empty = CheckpointFolder::new(place.path()).latest_valid(u64::MAX);
        assert!(matches!(empty, Err(IoError::NoValidCheckpoint { .. })));
        let gone = CheckpointFolder::new(place.path().join("gone")).latest_valid(u64::MAX);
        assert!(matches!(gone, Err(IoError::NotFound { .. })));
    }
}
