//! Options that several commands have.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use pericles_run::{self as library, Means, RunError, machine};

use super::values::{threads, wall_time};

/// Changes to the deck.
#[derive(Debug, Args)]
pub(crate) struct Overrides {
    /// Change the deck, such as time.dt=auto or crack.0.ends=open; may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
}

/// How a run is conducted.
#[derive(Debug, Args)]
pub(crate) struct RunOptions {
    #[command(flatten)]
    pub(crate) caching: Caching,
    #[command(flatten)]
    pub(crate) limits: Limits,
    #[command(flatten)]
    pub(crate) execution: Execution,
}

impl RunOptions {
    /// What a model may be made with.
    pub(crate) fn means(&self) -> Means {
        Means {
            caching: self.caching.wanted(),
            memory: self.limits.memory.bytes(),
        }
    }
}

/// Where results that are dear to compute are kept from run to run.
#[derive(Debug, Args)]
pub(crate) struct Caching {
    /// Keep kernels and distances that take long to compute in DIR [default: $XDG_CACHE_HOME/pericles or ~/.cache/pericles]
    #[arg(long = "cache", value_name = "DIR")]
    folder: Option<PathBuf>,
    /// Compute everything anew and keep nothing
    #[arg(long, conflicts_with = "folder")]
    no_cache: bool,
}

impl Caching {
    /// Where they are kept.
    pub(crate) fn wanted(&self) -> library::Caching {
        match &self.folder {
            Some(folder) => library::Caching::Folder(folder.clone()),
            None if self.no_cache => library::Caching::Off,
            None => library::Caching::User,
        }
    }
}

/// What a run may use up.
#[derive(Debug, Args)]
pub(crate) struct Limits {
    /// Stop in time, with a checkpoint, before so much time on the clock has passed, such as 2h, "90 min" or seconds; the exit status is then 7
    #[arg(long, value_name = "TIME", value_parser = wall_time)]
    pub(crate) wall_time: Option<Duration>,
    #[command(flatten)]
    pub(crate) memory: Memory,
}

/// Memory.
#[derive(Debug, Args)]
pub(crate) struct Memory {
    /// Refuse what is estimated to need more memory, such as 8GB, 512MiB or bytes; the exit status is then 8 [default: what the machine has free]
    #[arg(long = "max-memory", value_name = "SIZE", value_parser = machine::size)]
    most: Option<u64>,
}

impl Memory {
    /// Bytes that a run may take; without a limit from the user those that are free, where the system tells.
    pub(crate) fn bytes(&self) -> u64 {
        self.most.unwrap_or_else(machine::memory)
    }
}

/// How to compute and how much to say.
#[derive(Debug, Args)]
pub(crate) struct Execution {
    #[command(flatten)]
    pub(crate) threads: Threads,
    /// Say nothing but errors
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// Threads.
#[derive(Debug, Args)]
pub(crate) struct Threads {
    /// Threads [default: one per core]; results do not depend on it
    #[arg(long = "threads", value_name = "N", value_parser = threads)]
    count: Option<NonZeroUsize>,
}

impl Threads {
    /// The number given, or another.
    pub(crate) fn count_or(&self, other: usize) -> usize {
        self.count.map_or(other, NonZeroUsize::get)
    }

    /// Starts the threads; without a number one per core.
    pub(crate) fn start(&self) -> Result<usize, RunError> {
        let count = self.count.map_or(0, NonZeroUsize::get);
        rayon::ThreadPoolBuilder::new()
            .num_threads(count)
            .build_global()?;
        Ok(rayon::current_num_threads())
    }
}
