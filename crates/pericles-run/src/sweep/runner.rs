//! How the runs of a sweep are planned, begun and done.

use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{panic, thread};

use pericles_io::{IoError, OutputFolder, write_atomically};

use super::axis::Axis;
use super::record::{Member, Record};
use super::table::Table;
use crate::assembled::{Assembled, Means};
use crate::cancel::Cancel;
use crate::deadline::Deadline;
use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::event::Event;
use crate::results::Results;
use crate::run::{Ending, Run};
use crate::source::SourceRecord;

const RECORD: &str = "sweep.json";

/// Whether a folder is that of a sweep.
pub fn is_sweep(folder: &Path) -> bool {
    folder.join(RECORD).is_file()
}

/// A sweep whose decks can all be read, without a folder yet.
pub struct Plan {
    record: Record,
    members: Vec<Member>,
}

impl Plan {
    /// All combinations of the values of some keys.
    ///
    /// # Errors
    /// Values that the deck refuses: nobody wants half a sweep because of a slip in its last value.
    pub fn new(deck: DeckText, axes: Vec<Axis>) -> Result<Self, RunError> {
        let record = Record { deck, axes };
        let members = record.members();
        for member in &members {
            member.deck.read()?;
        }
        Ok(Self { record, members })
    }

    /// Puts it on record in its folder.
    ///
    /// # Errors
    /// A record that cannot be written.
    pub fn begin(self, folder: OutputFolder) -> Result<Sweep, RunError> {
        let Self { record, members } = self;
        let text = serde_json::to_string_pretty(&record)?;
        write_atomically(&folder.file(RECORD), |file| writeln!(file, "{text}"))?;
        Ok(Sweep {
            record,
            members,
            folder,
        })
    }
}

/// A sweep in its folder.
pub struct Sweep {
    record: Record,
    members: Vec<Member>,
    folder: OutputFolder,
}

/// How the runs of a sweep are done.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Threads of one run.
    pub threads: usize,
    /// What the models may be made with; the memory is that of all runs together.
    pub means: Means,
    /// When all runs must have stopped.
    pub deadline: Option<Deadline>,
}

/// News of a sweep; those of runs come from several threads.
#[derive(Debug)]
#[non_exhaustive]
pub enum SweepEvent<'a> {
    /// The runs begin.
    Begins {
        /// How many there are.
        runs: usize,
        /// How many share the machine.
        at_once: usize,
        /// The folder of the sweep.
        folder: &'a Path,
    },
    /// Something about the cache, from one of the runs.
    CacheNote(&'a str),
    /// A run has come to rest or failed.
    Ended {
        /// The name of its folder.
        run: &'a str,
        /// How.
        how: &'a Result<Ending, RunError>,
    },
}

/// How a sweep came to rest.
pub struct SweepEnd {
    /// The table of the runs, which `summary.csv` holds.
    pub table: Table,
    /// How the first run in trouble ended; finished if all runs did.
    pub worst: Result<Ending, RunError>,
}

type TellSweep<'a> = &'a (dyn Fn(SweepEvent<'_>) + Sync);

impl Sweep {
    /// The sweep of a folder. Runs that have finished stay, others go on from their checkpoint or begin.
    ///
    /// # Errors
    /// A folder that is none of a sweep.
    pub fn open(path: &Path) -> Result<Self, RunError> {
        let folder = OutputFolder::open(path)?;
        let path = folder.file(RECORD);
        let text =
            std::fs::read_to_string(&path).map_err(|error| IoError::reading(&path, error))?;
        let record: Record = serde_json::from_str(&text).map_err(|error| RunError::Damaged {
            path,
            reason: error.to_string(),
        })?;
        Ok(Self {
            members: record.members(),
            record,
            folder,
        })
    }

    /// Runs what has not finished.
    ///
    /// # Errors
    /// A table that cannot be written. A run that fails is reported and does not stop the others.
    pub fn drive(
        &self,
        settings: &Settings,
        cancel: &Cancel,
        tell: TellSweep<'_>,
    ) -> Result<SweepEnd, RunError> {
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let at_once = (cores / settings.threads).clamp(1, self.members.len().max(1));
        let means = Means {
            caching: settings.means.caching.clone(),
            memory: settings.means.memory / at_once as u64,
        };
        tell(SweepEvent::Begins {
            runs: self.members.len(),
            at_once,
            folder: self.folder.path(),
        });
        let next = AtomicUsize::new(0);
        let worker = || {
            let mut worst = Ok(Ending::Finished);
            while let Some(member) = self.members.get(next.fetch_add(1, Ordering::Relaxed)) {
                if cancel.is_cancelled() {
                    return Ok(Ending::Cancelled);
                }
                let path = self.folder.file(&member.name);
                let how = run_member(member, &path, settings, &means, cancel, tell);
                tell(SweepEvent::Ended {
                    run: &member.name,
                    how: &how,
                });
                // The first trouble decides.
                if is_fine(&worst) {
                    worst = how;
                }
            }
            worst
        };
        let ends: Vec<Result<Ending, RunError>> = thread::scope(|scope| {
            let workers: Vec<_> = (0..at_once).map(|_| scope.spawn(worker)).collect();
            let joined = workers.into_iter().map(|worker| worker.join());
            joined
                .map(|end| end.unwrap_or_else(|panic| panic::resume_unwind(panic)))
                .collect()
        });
        let table = Table::write(&self.record.axes, &self.members, &self.folder)?;
        let trouble = ends.into_iter().find(|end| !is_fine(end));
        Ok(SweepEnd {
            table,
            worst: trouble.unwrap_or(Ok(Ending::Finished)),
        })
    }

    /// Its folder.
    pub fn folder(&self) -> &OutputFolder {
        &self.folder
    }

    /// The results of all runs that left some.
    pub fn results(&self) -> impl Iterator<Item = Results> {
        let folders = self
            .members
            .iter()
            .map(|member| self.folder.file(&member.name));
        folders.filter_map(|folder| Results::open(&folder).ok())
    }
}

fn is_fine(end: &Result<Ending, RunError>) -> bool {
    matches!(end, Ok(Ending::Finished))
}

/// Runs a member as far as it goes, on threads of its own.
fn run_member(
    member: &Member,
    path: &Path,
    settings: &Settings,
    means: &Means,
    cancel: &Cancel,
    tell: TellSweep<'_>,
) -> Result<Ending, RunError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(settings.threads)
        .build()?;
    let deadline = settings.deadline.clone();
    // Of what one run among several says only this is passed on.
    let mut tell = |event: Event<'_>| {
        if let Event::CacheNote(note) = event {
            tell(SweepEvent::CacheNote(note));
        }
    };
    pool.install(|| {
        let mut run = if path.join("checkpoints").is_dir() {
            match Run::resume(path, means, &mut tell)? {
                Some(run) => run,
                None => return Ok(Ending::Finished),
            }
        } else {
            // A run that died before its first checkpoint begins again.
            let folder = OutputFolder::create(path, path.exists())?;
            let source = SourceRecord::Deck(member.deck.clone()).read()?;
            let assembled = Assembled::of(&source, means, &mut tell)?;
            Run::begin(&source, assembled, folder)?
        };
        run.drive(deadline, cancel, &mut tell)
    })
}
