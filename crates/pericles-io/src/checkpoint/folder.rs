//! The checkpoints of a run: the last two are kept, and the newest good one is found again.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::Container;
use crate::IoError;

/// How many checkpoints are kept.
const KEPT: usize = 2;

/// A folder of checkpoints named after their step, `step-000000001840.chk`.
#[derive(Debug, Clone)]
pub struct CheckpointFolder {
    path: PathBuf,
}

/// The newest checkpoint that can be used.
#[derive(Debug)]
pub struct LatestCheckpoint {
    /// The step after which it was written.
    pub step: u64,
    /// The file.
    pub path: PathBuf,
    /// Its content.
    pub container: Container,
    /// Why newer ones were refused, the newest first.
    pub refused: Vec<IoError>,
}

impl CheckpointFolder {
    /// Names the folder; it is made when the first checkpoint is written.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into() }
    }

    /// Where the folder is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file of a step's checkpoint.
    pub fn file(&self, step: u64) -> PathBuf {
        self.path.join(format!("step-{step:012}.chk"))
    }

    /// Writes the checkpoint of a step and removes all but it and the one before.
    ///
    /// Checkpoints of later steps go too: they are left from a run that was resumed at an earlier one.
    pub fn write(&self, step: u64, container: &Container) -> Result<PathBuf, IoError> {
        // Not those above it: where the output folder has gone, nothing more belongs there.
        match fs::create_dir(&self.path) {
            Err(source) if source.kind() != ErrorKind::AlreadyExists => {
                return Err(IoError::writing(&self.path, source));
            }
            _ => {}
        }
        let file = self.file(step);
        container.write(&file)?;
        let earlier: Vec<_> = self.steps()?.into_iter().filter(|&s| s <= step).collect();
        let kept = &earlier[earlier.len().saturating_sub(KEPT)..];
        for step in self.steps()? {
            if !kept.contains(&step) {
                let old = self.file(step);
                fs::remove_file(&old).map_err(|source| IoError::writing(&old, source))?;
            }
        }
        Ok(file)
    }

    /// The steps that have a checkpoint, in increasing order.
    pub fn steps(&self) -> Result<Vec<u64>, IoError> {
        let reading = |source| IoError::reading(&self.path, source);
        let mut steps = Vec::new();
        for entry in fs::read_dir(&self.path).map_err(reading)? {
            let name = entry.map_err(reading)?.file_name();
            let step = name.to_str().and_then(|name| {
                let digits = name.strip_prefix("step-")?.strip_suffix(".chk")?;
                digits.parse().ok()
            });
            // A name such as step-7.chk is not one of ours and would not be found again.
            steps.extend(step.filter(|&step| self.file(step).file_name() == Some(&name)));
        }
        steps.sort_unstable();
        Ok(steps)
    }

    /// Reads the newest checkpoint that is whole, and tells which newer ones were refused and why. Its content may take so many bytes of memory.
    pub fn latest_valid(&self, memory: u64) -> Result<LatestCheckpoint, IoError> {
        let mut refused = Vec::new();
        for step in self.steps()?.into_iter().rev() {
            let path = self.file(step);
            match Container::read(&path, memory) {
                Ok(container) => {
                    return Ok(LatestCheckpoint {
                        step,
                        path,
                        container,
                        refused,
                    });
                }
                // The one before it needs as much.
                Err(error @ IoError::TooLarge { .. }) => return Err(error),
                Err(error) => refused.push(error),
            }
        }
        Err(IoError::NoValidCheckpoint {
            path: self.path.clone(),
            refused,
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
    fn the_last_two_are_kept_and_other_files_stay() {
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
    fn a_damaged_checkpoint_gives_way_to_the_one_before() {
        let place = tempfile::tempdir().unwrap();
        let folder = CheckpointFolder::new(place.path());
        for step in [100, 200] {
            folder.write(step, &state(step)).unwrap();
        }
        assert_eq!(folder.latest_valid(u64::MAX).unwrap().step, 200);
        damage(&folder.file(200));
        let latest = folder.latest_valid(u64::MAX).unwrap();
        assert_eq!((latest.step, latest.container), (100, state(100)));
        assert_eq!(latest.refused.len(), 1);
        assert_eq!(latest.refused[0].path(), folder.file(200));

        // The run goes on from step 100: the damaged file must not push the good ones out.
        folder.write(150, &state(150)).unwrap();
        assert_eq!(folder.steps().unwrap(), [100, 150]);

        damage(&folder.file(100));
        damage(&folder.file(150));
        let none = folder.latest_valid(u64::MAX).unwrap_err();
        assert!(matches!(&none, IoError::NoValidCheckpoint { refused, .. } if refused.len() == 2));
        assert!(none.to_string().contains("CRC-32"), "{none}");
    }

    #[test]
    fn a_folder_without_checkpoints_is_told_from_no_folder() {
        let place = tempfile::tempdir().unwrap();
        let empty = CheckpointFolder::new(place.path()).latest_valid(u64::MAX);
        assert!(matches!(empty, Err(IoError::NoValidCheckpoint { .. })));
        let gone = CheckpointFolder::new(place.path().join("gone")).latest_valid(u64::MAX);
        assert!(matches!(gone, Err(IoError::NotFound { .. })));
    }
}
