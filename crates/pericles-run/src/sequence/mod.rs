//! Runs of several steps: one run after another, each in a folder of its own and from the state of the one before.
//!
//! ```text
//! impact/
//!   steps.json                  the deck and the names of its steps
//!   1-preload/  2-impact/       complete results of the steps; time starts at zero in each
//!   history.csv  fields.pvd …   all steps on one time line
//!   run.json                    that of the last step, with a list of all steps
//! ```

mod time_line;

use std::io::Write;
use std::path::{Path, PathBuf};

use pericles::PericlesError;
use pericles_io::{IoError, OutputFolder, write_atomically};
use serde::{Deserialize, Serialize};

use crate::assembled::{Assembled, Means};
use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::event::Tell;
use crate::origin::{InitialState, Origin};
use crate::processes::{agreed, on_first, shared_folder};
use crate::results::{Results, file_name};
use crate::run::{Ending, Run};
use crate::source::{Source, SourceRecord};

use self::time_line::write_time_line;

/// The record of the steps in their folder.
const RECORD: &str = "steps.json";

/// Returns the folder of the last step of a run of several steps, from whose state a further run can start; the folder
/// itself for other runs.
///
/// # Errors
/// The record of the steps cannot be read.
pub fn last_step(folder: &Path) -> Result<PathBuf, RunError> {
    if !is_sequence(folder) {
        return Ok(folder.into());
    }
    let steps = Record::of(folder, &Record::text(folder)?)?.steps;
    Ok(steps.last().map_or(folder.into(), |last| folder.join(last)))
}

/// Returns whether a folder contains a run of several steps.
pub fn is_sequence(folder: &Path) -> bool {
    folder.join(RECORD).is_file()
}

/// The content of `steps.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Record {
    deck: DeckText,
    steps: Vec<String>,
    /// The folder of another run, or its checkpoint, from which the first step starts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    from: Option<PathBuf>,
}

impl Record {
    fn text(folder: &Path) -> Result<String, RunError> {
        let file = folder.join(RECORD);
        Ok(std::fs::read_to_string(&file).map_err(|error| IoError::reading(&file, error))?)
    }

    fn of(folder: &Path, text: &str) -> Result<Self, RunError> {
        serde_json::from_str(text).map_err(|error| RunError::Damaged {
            path: folder.join(RECORD),
            reason: error.to_string(),
        })
    }
}

/// A run of several steps in its locked folder.
pub struct Sequence {
    record: Record,
    steps: Vec<DeckText>,
    folder: OutputFolder,
}

impl Sequence {
    /// Checks the steps of a deck by assembling them: the first one with its initial state, the others from the state of the
    /// deck. All processes must call it together.
    ///
    /// # Errors
    /// A step is invalid.
    pub fn check(
        deck: &DeckText,
        mut start: InitialState<'_>,
        means: &Means,
        tell: Tell<'_>,
    ) -> Result<(), RunError> {
        for step in deck.steps()? {
            Assembled::starting(&SourceRecord::Deck(step).read()?, start, means, tell)?;
            start = InitialState::Pending;
        }
        Ok(())
    }

    /// Begins the steps of a deck in a folder; the first one starts from the state of the run `from`, if it is given. All
    /// processes must call it together.
    ///
    /// # Errors
    /// The deck has errors, or the folder cannot be written.
    pub fn begin(
        deck: DeckText,
        from: Option<PathBuf>,
        folder: OutputFolder,
        means: &Means,
    ) -> Result<Self, RunError> {
        let steps = deck.steps()?;
        let record = Record {
            steps: deck.read()?.steps().to_vec(),
            deck,
            // The run may be resumed in another folder.
            from: from.map(|path| std::path::absolute(&path).unwrap_or(path)),
        };
        let sequence = Self {
            record,
            steps,
            folder,
        };
        let written = match means.comm.rank() {
            0 => sequence.write_record(),
            _ => Ok(()),
        };
        agreed(&*means.comm, written)?;
        Ok(sequence)
    }

    fn write_record(&self) -> Result<(), RunError> {
        self.folder.claim(&time_line::names(RECORD))?;
        // Results of the steps of an earlier run that is replaced.
        let reading = |error| IoError::reading(self.folder.path(), error);
        for entry in std::fs::read_dir(self.folder.path()).map_err(reading)? {
            let path = entry.map_err(reading)?.path();
            if is_step(&path) && path.join("run.json").is_file() {
                OutputFolder::create(path, true)?;
            }
        }
        let text = serde_json::to_string_pretty(&self.record)? + "\n";
        let path = self.folder.file(RECORD);
        Ok(write_atomically(&path, |file| {
            file.write_all(text.as_bytes())
        })?)
    }

    /// Opens the steps in a folder to resume them. All processes must call it together.
    ///
    /// # Errors
    /// The folder has no record of steps, or it cannot be used.
    pub fn open(path: &Path, means: &Means) -> Result<Self, RunError> {
        let read = || Ok::<_, RunError>((OutputFolder::open(path)?, Record::text(path)?));
        let (folder, text) = on_first(&*means.comm, read, |(_, text)| text.clone())?;
        let record = Record::of(path, &text)?;
        Ok(Self {
            steps: record.deck.steps()?,
            record,
            folder: folder.map_or_else(|| OutputFolder::following(path), |(folder, _)| folder),
        })
    }

    /// Returns the folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Returns the names of the steps.
    pub fn names(&self) -> &[String] {
        &self.record.steps
    }

    /// Writes the results so far on one time line. Only the first process writes.
    ///
    /// # Errors
    /// Results cannot be read or written.
    fn write_time_line(&self) -> Result<(), RunError> {
        write_time_line(self.folder.path(), &self.record.steps)
    }

    /// Returns the run of the first step that has not finished, and its number; `None` if all have. All processes must call it
    /// together.
    ///
    /// # Errors
    /// A step cannot start or be resumed, or output cannot be written.
    fn next(&self, means: &Means, tell: Tell<'_>) -> Result<Option<(usize, Run)>, RunError> {
        let mut before = self.record.from.clone();
        for (k, (name, deck)) in self.record.steps.iter().zip(&self.steps).enumerate() {
            let path = self.folder.file(name);
            if self.has_checkpoint(&path, means)? {
                if let Some(run) = Run::resume(&path, means, tell)? {
                    return Ok(Some((k, run)));
                }
            } else {
                let run = begun(deck, before.as_deref(), &path, means, tell)?;
                return Ok(Some((k, run)));
            }
            before = Some(path);
        }
        Ok(None)
    }

    /// Runs the steps that have not finished by `drive`, which is given the number of the step, and returns how the last
    /// one ended. The results are written on one time line after each. All processes must call it together.
    ///
    /// # Errors
    /// A step cannot start or be resumed, output cannot be written, and those of `drive`.
    pub fn drive<E: From<RunError> + From<PericlesError>>(
        &self,
        means: &Means,
        tell: Tell<'_>,
        mut drive: impl FnMut(usize, Run) -> Result<Ending, E>,
    ) -> Result<Ending, E> {
        let is_first = means.comm.rank() == 0;
        while let Some((number, run)) = self.next(means, tell)? {
            let ending = drive(number, run);
            let written = match is_first {
                true => self.write_time_line(),
                false => Ok(()),
            };
            // The first error is reported; on a full disk this write fails for the same reason.
            let ending = ending?;
            agreed(&*means.comm, written)?;
            if ending != Ending::Finished {
                return Ok(ending);
            }
        }
        Ok(Ending::Finished)
    }

    /// Returns whether a step has begun. A run that was killed before its first checkpoint starts again.
    fn has_checkpoint(&self, path: &Path, means: &Means) -> Result<bool, RunError> {
        let has = || {
            Ok::<_, RunError>(Results::open(path).is_ok_and(|run| !run.checkpoints().is_empty()))
        };
        let (_, word) = on_first(&*means.comm, has, bool::to_string)?;
        Ok(word == "true")
    }
}

/// Returns whether a folder has the name of a step: a number, or a number and a name.
fn is_step(path: &Path) -> bool {
    let name = file_name(path);
    let number = name.split('-').next().unwrap_or_default();
    !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
}

/// Begins the run of a step from the state of the one before.
fn begun(
    deck: &DeckText,
    from: Option<&Path>,
    path: &Path,
    means: &Means,
    tell: Tell<'_>,
) -> Result<Run, RunError> {
    let source: Source = SourceRecord::Deck(deck.clone()).read()?;
    let open = |from: &Path| Origin::open(from, means.memory, &*means.comm);
    let origin = from.map(open).transpose()?;
    let assembled = Assembled::starting(&source, origin.as_ref().into(), means, tell)?;
    let create = || Ok::<_, RunError>(OutputFolder::create(path, path.exists())?);
    let folder = shared_folder(&*means.comm, create)?;
    Run::begin(&source, assembled, folder)
}
