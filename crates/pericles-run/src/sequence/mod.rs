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

use std::path::{Path, PathBuf};

use pericles::PericlesError;
use pericles_io::{IoError, OutputFolder};
use serde::{Deserialize, Serialize};

use crate::assembled::{Assembled, Means};
use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::event::Tell;
use crate::json::write_json;
use crate::origin::InitialState;
use crate::processes::{agreed, on_first};
use crate::results::file_name;
use crate::run::{Ending, Run};
use crate::source::SourceRecord;

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

    /// Writes the record to a folder, in which the results of earlier steps are removed.
    fn write(&self, folder: &OutputFolder) -> Result<(), RunError> {
        folder.claim(&time_line::names(RECORD))?;
        let reading = |error| IoError::reading(folder.path(), error);
        for entry in std::fs::read_dir(folder.path()).map_err(reading)? {
            let path = entry.map_err(reading)?.path();
            if is_step(&path) && path.join("run.json").is_file() {
                OutputFolder::create(path, true)?;
            }
        }
        write_json(&folder.file(RECORD), self)
    }

    fn of(folder: &Path, text: &str) -> Result<Self, RunError> {
        serde_json::from_str(text).map_err(|error| RunError::Damaged {
            path: folder.join(RECORD),
            reason: error.to_string(),
        })
    }
}

/// The steps of a deck, before their folder is created.
pub struct Plan {
    record: Record,
    steps: Vec<(String, DeckText)>,
}

impl Plan {
    /// Plans the steps of a deck; the first one starts from the state of the run `from`, if it is given. `None` for a deck
    /// without steps.
    ///
    /// # Errors
    /// The deck has errors.
    pub fn new(deck: DeckText, from: Option<PathBuf>) -> Result<Option<Self>, RunError> {
        let steps = deck.steps()?;
        let record = Record {
            deck,
            steps: steps.iter().map(|(name, _)| name.clone()).collect(),
            // The run may be resumed in another folder.
            from: from.map(|path| std::path::absolute(&path).unwrap_or(path)),
        };
        Ok((!steps.is_empty()).then_some(Self { record, steps }))
    }

    /// Checks the steps by assembling them: the first one with its initial state, the others from the state of the deck. All
    /// processes must call it together.
    ///
    /// # Errors
    /// A step is invalid.
    pub fn check(
        &self,
        mut start: InitialState<'_>,
        means: &Means,
        tell: Tell<'_>,
    ) -> Result<(), RunError> {
        for (_, step) in &self.steps {
            let source = SourceRecord::Deck(step.clone()).read()?;
            Assembled::starting(&source, start, means, tell)?;
            start = InitialState::Pending;
        }
        Ok(())
    }

    /// Begins the steps in a folder. All processes must call it together.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn begin(self, folder: OutputFolder, means: &Means) -> Result<Sequence, RunError> {
        let written = match means.comm.rank() {
            0 => self.record.write(&folder),
            _ => Ok(()),
        };
        agreed(&*means.comm, written)?;
        let Self { record, steps } = self;
        Ok(Sequence {
            from: record.from,
            steps,
            folder,
        })
    }
}

/// A run of several steps in its locked folder.
pub struct Sequence {
    from: Option<PathBuf>,
    steps: Vec<(String, DeckText)>,
    folder: OutputFolder,
}

impl Sequence {
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
            from: record.from,
            folder: folder.map_or_else(|| OutputFolder::following(path), |(folder, _)| folder),
        })
    }

    /// Returns the folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Returns the names of the steps.
    pub fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.steps.iter().map(|(name, _)| name.as_str())
    }

    /// Returns the run of the first step that has not finished, and its number; `None` if all have. All processes must call it
    /// together.
    ///
    /// # Errors
    /// A step cannot start or be resumed, or output cannot be written.
    fn next(&self, means: &Means, tell: Tell<'_>) -> Result<Option<(usize, Run)>, RunError> {
        let mut before = self.from.clone();
        for (number, (name, deck)) in self.steps.iter().enumerate() {
            let path = self.folder.file(name);
            let run = Run::resume_or_begin(&path, deck, before.as_deref(), means, tell)?;
            if let Some(run) = run {
                return Ok(Some((number, run)));
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
                true => write_time_line(self.folder.path(), self.names()),
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
}

/// Returns whether a folder has the name of a step: a number, or a number and a name.
fn is_step(path: &Path) -> bool {
    let name = file_name(path);
    let number = name.split('-').next().unwrap_or_default();
    !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
}
