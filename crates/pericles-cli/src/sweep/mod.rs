//! `run --sweep`: one deck at several values of its keys, each run in a folder of its own.
//!
//! ```text
//! plate-sweep/
//!   sweep.json                 the deck and the values, enough to go on
//!   spacing=0.5_mm/  …         one output folder per value, or combination of values
//!   summary.csv                a row per run: values, status, energies, probes at the end
//! ```
//!
//! Runs share the process and the cores: so many at once as the cores allow with the threads each run takes, every one in a pool of its own. A run that fails does not stop the others.

mod axis;
mod summary;

pub(crate) use axis::Axis;

use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use pericles_io::{IoError, OutputFolder, write_atomically};
use serde::{Deserialize, Serialize};

use crate::args::{Caching, ResumeArgs, RunArgs, RunOptions};
use crate::checkpoint::DeckText;
use crate::console;
use crate::deadline::Deadline;
use crate::error::CliError;
use crate::exit::Exit;
use crate::given;
use crate::prepare::Means;
use crate::results::Results;
use crate::run::{self, Session};
use crate::signals::Signals;
use crate::units::threads;

const RECORD: &str = "sweep.json";

/// What `sweep.json` holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Record {
    deck: DeckText,
    axes: Vec<Axis>,
}

/// One combination of values.
struct Member {
    /// Its folder's name.
    name: String,
    /// One value per axis.
    values: Vec<String>,
    deck: DeckText,
}

/// Whether a folder is that of a sweep.
pub(crate) fn is_sweep(folder: &Path) -> bool {
    folder.join(RECORD).is_file()
}

/// Runs a deck at all combinations of values.
///
/// # Errors
/// Values that the deck refuses, before anything is run; output that cannot be written.
pub(crate) fn run(args: &RunArgs) -> Result<Exit, CliError> {
    let (deck, changes) = (&args.deck, &args.overrides.set);
    let sweep = Sweep::begun(
        deck,
        changes,
        args.sweep.clone(),
        args.out.as_deref(),
        "-sweep",
    )?;
    sweep.drive(&Settings::new(&args.options))
}

/// Goes on with a sweep: runs that have finished stay, others go on from their checkpoint or begin.
///
/// # Errors
/// A folder that is none of a sweep, output that cannot be written.
pub(crate) fn resume(args: &ResumeArgs) -> Result<Exit, CliError> {
    let folder = OutputFolder::open(&args.dir)?;
    let path = folder.file(RECORD);
    let text = std::fs::read_to_string(&path).map_err(|error| IoError::reading(&path, error))?;
    let record: Record = serde_json::from_str(&text).map_err(|error| CliError::Damaged {
        path,
        reason: error.to_string(),
    })?;
    let sweep = Sweep {
        members: record.members(),
        record,
        folder,
    };
    sweep.drive(&Settings::new(&args.options))
}

/// A sweep in its folder.
pub(crate) struct Sweep {
    record: Record,
    members: Vec<Member>,
    folder: OutputFolder,
}

impl Sweep {
    /// Makes the folder of a new sweep, once nothing in its decks can be wrong.
    ///
    /// # Errors
    /// Values that the deck refuses; a folder that exists or cannot be made.
    pub(crate) fn begun(
        deck: &Path,
        overrides: &[String],
        axes: Vec<Axis>,
        out: Option<&Path>,
        suffix: &str,
    ) -> Result<Self, CliError> {
        let read = given::deck(deck, overrides)?;
        let record = Record {
            deck: DeckText::of(&read, deck.display().to_string()),
            axes,
        };
        let members = record.members();
        // Before the folder is made: nobody wants half a sweep because of a slip in its last value.
        for member in &members {
            member.deck.read()?;
        }
        let folder = run::output_folder(out, None, deck, suffix)?;
        let text = serde_json::to_string_pretty(&record)?;
        write_atomically(&folder.file(RECORD), |file| writeln!(file, "{text}"))?;
        Ok(Self {
            record,
            members,
            folder,
        })
    }

    /// Runs what has not finished.
    ///
    /// # Errors
    /// Output that cannot be written.
    pub(crate) fn drive(&self, settings: &Settings<'_>) -> Result<Exit, CliError> {
        self.record.drive(&self.members, &self.folder, settings)
    }

    /// Its folder.
    pub(crate) fn folder(&self) -> &OutputFolder {
        &self.folder
    }

    /// The results of all runs that left some.
    pub(crate) fn results(&self) -> impl Iterator<Item = Results> {
        let folders = self
            .members
            .iter()
            .map(|member| self.folder.file(&member.name));
        folders.filter_map(|folder| Results::open(&folder).ok())
    }
}

/// How the runs of a sweep are done.
pub(crate) struct Settings<'a> {
    /// Threads of one run.
    threads: usize,
    caching: &'a Caching,
    /// Bytes for all runs together.
    memory: u64,
    deadline: Option<Deadline>,
    quiet: bool,
}

impl<'a> Settings<'a> {
    /// What the command line says; one thread a run unless it says otherwise.
    pub(crate) fn new(options: &'a RunOptions) -> Self {
        let Means { caching, memory } = options.means();
        Self {
            threads: options.execution.threads.count_or(1),
            caching,
            memory,
            deadline: Deadline::from_now(options.limits.wall_time),
            quiet: options.execution.quiet,
        }
    }
}

impl Record {
    /// All combinations, the last axis running fastest.
    fn members(&self) -> Vec<Member> {
        let mut combinations = vec![Vec::new()];
        for axis in &self.axes {
            let extended = combinations.iter().flat_map(|values: &Vec<String>| {
                axis.values.iter().map(move |value| {
                    let mut values = values.clone();
                    values.push(value.clone());
                    values
                })
            });
            combinations = extended.collect();
        }
        let mut members: Vec<Member> = Vec::new();
        for values in combinations {
            let mut name = self.name(&values);
            // Characters that names cannot have may have told two of them apart.
            if members.iter().any(|member| member.name == name) {
                name += &format!("-{}", members.len() + 1);
            }
            members.push(self.member(name, values));
        }
        members
    }

    fn name(&self, values: &[String]) -> String {
        let parts: Vec<String> = (self.axes.iter().zip(values))
            .map(|(axis, value)| format!("{}={value}", axis.name()))
            .collect();
        let plain = |c: char| {
            if c.is_alphanumeric() || "+-.=,".contains(c) {
                c
            } else {
                '_'
            }
        };
        parts.join(",").chars().map(plain).collect()
    }

    fn member(&self, name: String, values: Vec<String>) -> Member {
        let mut deck = self.deck.clone();
        let sets = self.axes.iter().zip(&values);
        deck.overrides
            .extend(sets.map(|(axis, value)| format!("{}={value}", axis.key)));
        Member { name, values, deck }
    }

    fn drive(
        &self,
        members: &[Member],
        folder: &OutputFolder,
        settings: &Settings<'_>,
    ) -> Result<Exit, CliError> {
        let signals = Signals::watch().map_err(CliError::Signals)?;
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let at_once = (cores / settings.threads).clamp(1, members.len().max(1));
        let means = Means {
            caching: settings.caching,
            memory: settings.memory / at_once as u64,
        };
        if !settings.quiet {
            console::note(format_args!(
                "{} runs, {at_once} at a time on {} each; results in {}",
                members.len(),
                threads(settings.threads),
                folder.path().display()
            ));
        }
        let next = AtomicUsize::new(0);
        let worker = || {
            let mut worst = Exit::Done;
            while let Some(member) = members.get(next.fetch_add(1, Ordering::Relaxed)) {
                if let Some(asked) = signals.asked() {
                    return asked;
                }
                let exit = member.run(folder, settings, &means, &signals);
                // The first trouble decides the status.
                if worst == Exit::Done {
                    worst = exit;
                }
            }
            worst
        };
        let exits: Vec<Exit> = thread::scope(|scope| {
            let workers: Vec<_> = (0..at_once).map(|_| scope.spawn(worker)).collect();
            let joined = workers.into_iter().map(|worker| worker.join());
            joined.map(|exit| exit.unwrap_or(Exit::Internal)).collect()
        });
        summary::write(&self.axes, members, folder, settings.quiet)?;
        let trouble = exits.into_iter().find(|exit| *exit != Exit::Done);
        Ok(signals.asked().or(trouble).unwrap_or(Exit::Done))
    }
}

impl Member {
    /// Runs it as far as it goes, says so, and reports what went wrong.
    fn run(
        &self,
        sweep: &OutputFolder,
        settings: &Settings<'_>,
        means: &Means<'_>,
        signals: &Signals,
    ) -> Exit {
        let exit = self
            .attempt(&sweep.file(&self.name), settings, means, signals)
            .unwrap_or_else(|error| {
                console::note(format_args!("{}:", self.name));
                error.report();
                error.exit()
            });
        if !settings.quiet {
            let word = match exit {
                Exit::Done => "finished",
                Exit::StoppedEarly | Exit::Interrupted | Exit::Terminated => "stopped",
                _ => "failed",
            };
            console::note(format_args!("{}: {word}", self.name));
        }
        exit
    }

    fn attempt(
        &self,
        path: &Path,
        settings: &Settings<'_>,
        means: &Means<'_>,
        signals: &Signals,
    ) -> Result<Exit, CliError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(settings.threads)
            .build()?;
        let deadline = settings.deadline.clone();
        pool.install(|| {
            let session = if path.join("checkpoints").is_dir() {
                match Session::resumed(path, means, true)? {
                    Some(session) => session,
                    None => return Ok(Exit::Done),
                }
            } else {
                // A run that died before its first checkpoint begins again.
                let folder = OutputFolder::create(path, path.exists())?;
                let deck = self.deck.read()?;
                let model = run::modelled(&deck, means)?;
                Session::begun(&deck, self.deck.clone(), model, folder, true)?
            };
            session.drive(deadline, signals)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_combination_has_a_folder_of_its_own() {
        let record = Record {
            deck: DeckText {
                file: "a.toml".into(),
                source: String::new(),
                overrides: vec!["time.end=1".into()],
                inputs: Default::default(),
            },
            axes: vec![
                "body.spacing=1 mm,1/mm".parse().unwrap(),
                "m=3,4".parse().unwrap(),
            ],
        };
        let members = record.members();
        let names: Vec<&str> = members.iter().map(|member| member.name.as_str()).collect();
        assert_eq!(
            names,
            [
                "spacing=1_mm,m=3",
                "spacing=1_mm,m=4",
                "spacing=1_mm,m=3-3",
                "spacing=1_mm,m=4-4"
            ]
        );
        assert_eq!(
            members[1].deck.overrides,
            ["time.end=1", "body.spacing=1 mm", "m=4"]
        );
    }
}
