//! Options shared by several commands.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use pericles_deck::{DeviceKind, DevicePrecision, Processor};
use pericles_run::sequence::last_step;
use pericles_run::sweep::Settings;
use pericles_run::{self as library, Deadline, Means, Origin, RunError, machine};

use super::values::{device, device_precision, threads, wall_time};
use crate::devices::devices;

/// Overrides of deck keys.
#[derive(Debug, Args)]
pub(crate) struct Overrides {
    /// Override a key of the deck, such as time.dt=auto or crack.0.ends=open; KEY=unset removes it; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) set: Vec<String>,
}

/// The run whose state a run starts from.
#[derive(Debug, Args)]
pub(crate) struct FromRun {
    /// Start from the state at the end of another run of the same points, given by its output folder or one of its
    /// checkpoints: displacement, velocity, broken bonds, variables of softening and plastic flow, temperature. Time starts at zero
    #[arg(long, value_name = "DIR")]
    pub(crate) from: Option<PathBuf>,
}

impl FromRun {
    /// Returns the folder or checkpoint: the last step of a run of several steps.
    ///
    /// # Errors
    /// The record of the steps cannot be read.
    pub(crate) fn path(&self) -> Result<Option<PathBuf>, RunError> {
        self.from.as_deref().map(last_step).transpose()
    }

    /// Opens the state. All processes must call it together.
    ///
    /// # Errors
    /// The folder contains no usable checkpoint.
    pub(crate) fn open(&self, means: &Means) -> Result<Option<Origin>, RunError> {
        let open = |path: PathBuf| Origin::open(&path, means.memory, &*means.comm);
        self.path()?.map(open).transpose()
    }
}

/// Options of a run.
#[derive(Debug, Args)]
pub(crate) struct RunOptions {
    #[command(flatten)]
    pub(crate) caching: Caching,
    #[command(flatten)]
    pub(crate) limits: Limits,
    #[command(flatten)]
    pub(crate) execution: Execution,
    #[command(flatten)]
    pub(crate) device: DeviceChoice,
}

impl RunOptions {
    /// Returns the settings of several runs, by default on one thread each.
    pub(crate) fn of_several(&self) -> Settings {
        Settings {
            threads: self.execution.threads.count_or(1),
            means: self.means(),
            deadline: Deadline::from_now(self.limits.wall_time),
        }
    }

    /// Returns the cache and memory limit for building a model.
    pub(crate) fn means(&self) -> Means {
        self.device.with(Means {
            caching: self.caching.wanted(),
            memory: self.limits.memory.bytes(),
            ..Means::default()
        })
    }
}

/// The processor of the steps.
#[derive(Debug, Args)]
pub(crate) struct DeviceChoice {
    /// Processor of the time steps: cpu, gpu, or gpu:N, graphics processor N of `pericles devices` [default: that of the deck]
    #[arg(long, value_name = "DEVICE", value_parser = device)]
    device: Option<Processor>,
    /// Precision of a graphics processor: double or mixed [default: double if it has it]
    #[arg(long, value_name = "PRECISION", value_parser = device_precision, requires = "device")]
    precision: Option<DevicePrecision>,
}

impl DeviceChoice {
    /// Returns the processor that the command line wants, if it wants one.
    fn wanted(&self) -> Option<Processor> {
        let precision = self.precision.unwrap_or_default();
        self.device.map(|device| Processor {
            precision,
            ..device
        })
    }

    /// Returns the graphics processor that the command line wants, if it wants one.
    pub(crate) fn graphics(&self) -> Option<Processor> {
        self.wanted()
            .filter(|wanted| wanted.device == DeviceKind::Gpu)
    }

    /// Returns means with this choice.
    pub(crate) fn with(&self, means: Means) -> Means {
        Means {
            devices: devices(),
            processor: self.wanted(),
            ..means
        }
    }
}

/// Options of the cache for results that are expensive to compute.
#[derive(Debug, Args)]
pub(crate) struct Caching {
    /// Cache folder for expensive kernels and geodesic distances [default: $XDG_CACHE_HOME/pericles or
    /// ~/.cache/pericles]
    #[arg(long = "cache", value_name = "DIR")]
    folder: Option<PathBuf>,
    /// Do not read or write the cache
    #[arg(long, conflicts_with = "folder")]
    no_cache: bool,
}

impl Caching {
    /// Returns where results are cached.
    pub(crate) fn wanted(&self) -> library::Caching {
        match &self.folder {
            Some(folder) => library::Caching::Folder(folder.clone()),
            None if self.no_cache => library::Caching::Off,
            None => library::Caching::User,
        }
    }
}

/// Limits on the resources of a run.
#[derive(Debug, Args)]
pub(crate) struct Limits {
    /// Wall-clock time limit, such as 2h, "90 min" or 5400 (seconds): the run stops before it with a checkpoint and
    /// exit status 7
    #[arg(long, value_name = "TIME", value_parser = wall_time)]
    pub(crate) wall_time: Option<Duration>,
    #[command(flatten)]
    pub(crate) memory: Memory,
}

/// Memory limit.
#[derive(Debug, Args)]
pub(crate) struct Memory {
    /// Memory limit of all processes together, such as 8GB, 512MiB or a number of bytes: models with a larger estimate are
    /// rejected with exit status 8 [default: available memory]
    #[arg(long = "max-memory", value_name = "SIZE", value_parser = machine::size)]
    most: Option<u64>,
}

impl Memory {
    /// Returns the limit in bytes; by default the available memory, if the system reports it.
    pub(crate) fn bytes(&self) -> u64 {
        self.most.unwrap_or_else(machine::memory)
    }

    /// Returns the limit given on the command line, bytes.
    pub(crate) fn given(&self) -> Option<u64> {
        self.most
    }
}

/// Threads and verbosity.
#[derive(Debug, Args)]
pub(crate) struct Execution {
    #[command(flatten)]
    pub(crate) threads: Threads,
    /// Print errors only
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// The number of threads.
#[derive(Debug, Args)]
pub(crate) struct Threads {
    /// Number of threads of each process; results do not depend on it [default: one per core]
    #[arg(long = "threads", value_name = "N", value_parser = threads)]
    count: Option<NonZeroUsize>,
}

impl Threads {
    /// Returns the number given, or `other` by default.
    pub(crate) fn count_or(&self, other: usize) -> usize {
        self.count.map_or(other, NonZeroUsize::get)
    }

    /// Starts the thread pool; by default one thread per core.
    pub(crate) fn start(&self) -> Result<usize, RunError> {
        // The library counts the cores.
        self.start_or(0)
    }

    /// Starts the thread pool, by default with `other` threads; the calling thread is one of them, so that it computes without
    /// handing its work over.
    pub(crate) fn start_or(&self, other: usize) -> Result<usize, RunError> {
        let count = self.count_or(other);
        rayon::ThreadPoolBuilder::new()
            .num_threads(count)
            .use_current_thread()
            .build_global()?;
        Ok(rayon::current_num_threads())
    }
}
