//! The state of another run, from which a run starts.
//!
//! A run hands over the displacement and velocity of its points, broken bonds and dissipated energy, stored variables of
//! materials, and the temperature. Time starts at zero again; loads, constraints, boundaries, contact and output are
//! those of the new run. The state is a checkpoint of the other run, usually its last; the new run keeps a copy in its
//! folder and can therefore be resumed without the other.

use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use pericles::domain::Comm;
use pericles::time::State;
use pericles::{Archive, Checkpointed, PericlesError, System};
use pericles_io::{DividedCheckpoint, IoError, OutputFolder};

use crate::body_record::BodyRecord;
use crate::checkpoint::{Content, Metadata, Stored};
use crate::error::RunError;
use crate::processes::on_first;

/// The copy of the state in the folder of checkpoints of the run that starts from it.
pub(crate) const START: &str = "start.chk";

/// Where the initial state of a run comes from.
#[derive(Clone, Copy, Default)]
pub enum InitialState<'a> {
    /// The deck or model.
    #[default]
    Model,
    /// The state of another run.
    Of(&'a Origin),
    /// A run that has not been made yet: a step is checked from the state of its deck, without warnings about that state.
    Pending,
}

impl<'a> InitialState<'a> {
    /// Returns the other run, if it has been made.
    pub(crate) fn origin(self) -> Option<&'a Origin> {
        match self {
            Self::Of(origin) => Some(origin),
            Self::Model | Self::Pending => None,
        }
    }

    /// Returns whether the run continues another one.
    pub(crate) fn continues(self) -> bool {
        !matches!(self, Self::Model)
    }
}

impl<'a> From<Option<&'a Origin>> for InitialState<'a> {
    fn from(origin: Option<&'a Origin>) -> Self {
        origin.map_or(Self::Model, Self::Of)
    }
}

/// The state of another run.
pub struct Origin {
    path: PathBuf,
    metadata: Metadata,
    content: Mutex<Content>,
}

impl Origin {
    /// Opens the last checkpoint in the folder of a run, or a given checkpoint; the part of a process may need at most
    /// `memory` bytes. All processes must call it together.
    ///
    /// # Errors
    /// There is no usable checkpoint.
    pub fn open(path: &Path, memory: u64, comm: &dyn Comm) -> Result<Self, RunError> {
        // Other processes may not see the folder.
        let is_folder = || match path.is_dir() {
            true if !path.join("checkpoints").is_dir() => {
                Err(RunError::NoRun { path: path.into() })
            }
            is_folder => Ok(is_folder),
        };
        let (_, word) = on_first(comm, is_folder, bool::to_string)?;
        let Stored {
            path,
            metadata,
            content,
            ..
        } = match word == "true" {
            true => Stored::latest(&OutputFolder::following(path), memory, comm)?,
            false => Stored::open(path, memory, comm)?,
        };
        Ok(Self {
            path,
            metadata,
            content: Mutex::new(content),
        })
    }

    /// Opens the state from which the run in a folder has started; `None` if it started from the state of its deck.
    ///
    /// # Errors
    /// The state cannot be used.
    pub(crate) fn of_run(
        folder: &OutputFolder,
        memory: u64,
        comm: &dyn Comm,
    ) -> Result<Option<Self>, RunError> {
        let path = folder.file("checkpoints").join(START);
        match pericles::domain::all(comm, comm.rank() != 0 || path.exists()) {
            true => Self::open(&path, memory, comm).map(Some),
            false => Ok(None),
        }
    }

    /// Returns the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the time of the state in the other run, s.
    pub fn time(&self) -> f64 {
        self.metadata.t
    }

    /// Copies the state to the folder of the run that starts from it, on the first process.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn keep(path: &Path, folder: &OutputFolder) -> Result<(), RunError> {
        let place = folder.subfolder("checkpoints")?;
        let copy = place.join(START);
        fs::copy(path, &copy).map_err(|source| IoError::writing(&copy, source))?;
        Ok(())
    }

    /// Sets the state of a body at rest to this state. `holds_still` states that the new scheme is static: points
    /// then have no velocity. All processes must call it together.
    ///
    /// # Errors
    /// [`PericlesError::BadArchive`] if the state belongs to another body.
    pub(crate) fn hand_over(
        &self,
        (system, precut_bonds): (&mut System, u64),
        state: &mut State,
        holds_still: bool,
    ) -> Result<(), PericlesError> {
        let own = BodyRecord::of(system, precut_bonds);
        if let Some(reason) = self.metadata.body.misfit(&own) {
            return Err(self.unusable(&reason));
        }
        let mut content = self.content.lock().unwrap_or_else(PoisonError::into_inner);
        let stored = match &mut *content {
            Content::Whole(archive) => Cow::Borrowed(&*archive),
            Content::Divided(checkpoint) => Cow::Owned(own_part(checkpoint, system, state)?),
        };
        system.take_over(&stored, self.time())?;
        stored.f64_into("state/u", &mut state.u)?;
        if !holds_still {
            stored.f64_into("state/v", &mut state.v)?;
        }
        Ok(())
    }

    fn unusable(&self, reason: &str) -> PericlesError {
        PericlesError::BadArchive {
            reason: format!("{}: {reason}", self.path.display()),
        }
    }
}

/// Returns the arrays of this process. All processes must call it together.
fn own_part(
    checkpoint: &mut DividedCheckpoint,
    system: &System,
    state: &State,
) -> Result<Archive, PericlesError> {
    let mut template = Archive::default();
    system.save_body(&mut template);
    state.save(&mut template);
    Archive::available_part_of(template, checkpoint, system.domain())
}
