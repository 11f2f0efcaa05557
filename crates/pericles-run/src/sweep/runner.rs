//! Execution of sweeps.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{panic, thread};

use pericles_io::OutputFolder;

use super::axis::Axis;
use super::record::{Member, Record};
use super::results::{SweepResults, is_sweep};
use super::table::Table;
use crate::assembled::Means;
use crate::cancel::Cancel;
use crate::deadline::Deadline;
use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::event::Event;
use crate::json::write_json;
use crate::results::Results;
use crate::run::{Ending, Run};
use crate::sequence::{self, Sequence, is_sequence};
use crate::source::SourceRecord;

/// A sweep whose decks are valid, before its folder is created.
pub struct Plan {
    record: Record,
}

impl Plan {
    /// Plans all combinations of the values of the keys; all runs start from the state of the run `from`, if it is given.
    ///
    /// # Errors
    /// The deck is invalid for one of the values. All are checked before the first run.
    pub fn new(deck: DeckText, axes: Vec<Axis>, from: Option<PathBuf>) -> Result<Self, RunError> {
        // The sweep may be resumed in another folder.
        let from = from.map(|path| std::path::absolute(&path).unwrap_or(path));
        let record = Record { deck, axes, from };
        for member in record.members() {
            member.deck.read()?;
        }
        Ok(Self { record })
    }

    /// Writes the record to the folder.
    ///
    /// # Errors
    /// The record cannot be written.
    pub fn begin(self, folder: OutputFolder) -> Result<Sweep, RunError> {
        write_json(&SweepResults::record_file(folder.path()), &self.record)?;
        Ok(Sweep {
            sweep: SweepResults::of(self.record, folder.path()),
            folder,
        })
    }

    /// Begins the sweep in a folder, or continues there: results of the same deck with the same values are kept, and the runs of
    /// other decks with the names of runs of this sweep are removed.
    ///
    /// # Errors
    /// The folder exists, is not empty and has no sweep, or it cannot be written.
    pub fn enter(self, path: &Path) -> Result<Sweep, RunError> {
        if !is_sweep(path) {
            let is_empty = path
                .read_dir()
                .is_ok_and(|mut entries| entries.next().is_none());
            return self.begin(OutputFolder::create(path, is_empty)?);
        }
        let folder = OutputFolder::open(path)?;
        for member in self.record.members() {
            let place = folder.file(&member.name);
            if place.exists() && !is_of(&place, &member.deck) {
                OutputFolder::create(place, true)?;
            }
        }
        self.begin(folder)
    }
}

/// Returns whether a folder has results of a deck.
fn is_of(folder: &Path, deck: &DeckText) -> bool {
    let source = Results::open(folder).and_then(|results| results.source());
    match source {
        Ok(SourceRecord::Deck(found)) => {
            (&found.source, &found.overrides) == (&deck.source, &deck.overrides)
        }
        _ => false,
    }
}

/// A sweep with its locked folder.
pub struct Sweep {
    sweep: SweepResults,
    folder: OutputFolder,
}

/// Settings of a sweep.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Threads per run.
    pub threads: usize,
    /// Cache and memory limit; the limit is for all runs together.
    pub means: Means,
    /// Deadline of all runs.
    pub deadline: Option<Deadline>,
}

/// An event of a sweep; events of runs come from several threads.
#[derive(Debug)]
#[non_exhaustive]
pub enum SweepEvent<'a> {
    /// The runs begin.
    Begins {
        /// Number of runs.
        runs: usize,
        /// Number of concurrent runs.
        at_once: usize,
        /// The folder of the sweep.
        folder: &'a Path,
    },
    /// A note about the cache from one of the runs.
    CacheNote(&'a str),
    /// A run has ended.
    Ended {
        /// The name of its folder.
        run: &'a str,
        /// The outcome.
        how: &'a Result<Ending, RunError>,
    },
}

/// The outcome of a sweep.
pub struct SweepEnd {
    /// The table of the runs, as in `summary.csv`.
    pub table: Table,
    /// The outcome of the first unfinished run; finished if all runs have finished.
    pub worst: Result<Ending, RunError>,
}

type TellSweep<'a> = &'a (dyn Fn(SweepEvent<'_>) + Sync);

impl Sweep {
    /// Opens the sweep in a folder. Finished runs are kept, others continue from their checkpoint or start.
    ///
    /// # Errors
    /// The folder does not contain a sweep.
    pub fn open(path: &Path) -> Result<Self, RunError> {
        let folder = OutputFolder::open(path)?;
        let sweep = SweepResults::open(path)?;
        Ok(Self { sweep, folder })
    }

    /// Runs all unfinished runs.
    ///
    /// # Errors
    /// The table cannot be written. Failed runs are reported and do not stop the others.
    pub fn drive(
        &self,
        settings: &Settings,
        cancel: &Cancel,
        tell: TellSweep<'_>,
    ) -> Result<SweepEnd, RunError> {
        let members = &self.sweep.members;
        tell(SweepEvent::Begins {
            runs: members.len(),
            at_once: settings.at_once(members.len()),
            folder: self.folder.path(),
        });
        let from = self.sweep.record.from.as_deref();
        let ends = run_all(members, (from, &self.folder), settings, cancel, tell);
        let table = self.sweep.table();
        table.write()?;
        Ok(SweepEnd {
            table,
            worst: worst(ends),
        })
    }

    /// Returns the folder.
    pub fn folder(&self) -> &OutputFolder {
        &self.folder
    }

    /// Returns the deck, the values and the present results.
    pub fn found(&self) -> &SweepResults {
        &self.sweep
    }
}

impl Settings {
    /// Returns the number of concurrent runs, of `runs` runs.
    fn at_once(&self, runs: usize) -> usize {
        let cores = thread::available_parallelism().map_or(1, usize::from);
        (cores / self.threads).clamp(1, runs.max(1))
    }
}

/// Runs all members that have not finished, and returns their outcomes in order.
pub(crate) fn run_all(
    members: &[Member],
    (from, folder): (Option<&Path>, &OutputFolder),
    settings: &Settings,
    cancel: &Cancel,
    tell: TellSweep<'_>,
) -> Vec<Result<Ending, RunError>> {
    let at_once = settings.at_once(members.len());
    let means = Means {
        memory: settings.means.memory / at_once as u64,
        ..settings.means.clone()
    };
    let next = AtomicUsize::new(0);
    let worker = || {
        let mut ends = Vec::new();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(member) = members.get(number) else {
                return ends;
            };
            if cancel.is_cancelled() {
                ends.push((number, Ok(Ending::Cancelled)));
                continue;
            }
            let path = folder.file(&member.name);
            let how = run_member(member, (from, &path), settings, &means, cancel, tell);
            tell(SweepEvent::Ended {
                run: &member.name,
                how: &how,
            });
            ends.push((number, how));
        }
    };
    let mut ends: Vec<(usize, Result<Ending, RunError>)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..at_once).map(|_| scope.spawn(worker)).collect();
        let joined = workers.into_iter().map(|worker| worker.join());
        joined
            .flat_map(|ends| ends.unwrap_or_else(|panic| panic::resume_unwind(panic)))
            .collect()
    });
    ends.sort_by_key(|(number, _)| *number);
    ends.into_iter().map(|(_, how)| how).collect()
}

/// Returns the outcome of the first run that has not finished; finished if all have.
pub(crate) fn worst(ends: Vec<Result<Ending, RunError>>) -> Result<Ending, RunError> {
    let mut ends = ends.into_iter();
    let trouble = ends.find(|end| !matches!(end, Ok(Ending::Finished)));
    trouble.unwrap_or(Ok(Ending::Finished))
}

/// Runs a member of the sweep on its own threads.
fn run_member(
    member: &Member,
    (from, path): (Option<&Path>, &Path),
    settings: &Settings,
    means: &Means,
    cancel: &Cancel,
    tell: TellSweep<'_>,
) -> Result<Ending, RunError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(settings.threads)
        .build()?;
    let deadline = settings.deadline.clone();
    // Of the events of a single run, only these are passed on.
    let mut tell = |event: Event<'_>| {
        if let Event::CacheNote(note) = event {
            tell(SweepEvent::CacheNote(note));
        }
    };
    pool.install(|| {
        let sequence = match is_sequence(path) {
            true => Some(Sequence::open(path, means)?),
            false => match sequence::Plan::new(member.deck.clone(), from.map(Path::to_path_buf))? {
                Some(plan) => Some(plan.begin(OutputFolder::create(path, path.exists())?, means)?),
                None => None,
            },
        };
        if let Some(sequence) = sequence {
            return sequence.drive(means, &mut tell, |_, mut run| {
                run.drive(deadline.clone(), cancel, &mut |_| {})
            });
        }
        match Run::resume_or_begin(path, &member.deck, from, means, &mut tell)? {
            Some(mut run) => run.drive(deadline, cancel, &mut tell),
            None => Ok(Ending::Finished),
        }
    })
}
