//! Processes that share a run: started by `mpirun` or `srun`, connected by MPI.
//!
//! A run is divided among all processes that a launcher has started; the first one prints. Commands that cannot be divided, and
//! programs built without MPI, do not run as several copies, which would write the same files.

#[cfg(not(feature = "mpi"))]
mod absent;
mod cores;
mod launch;

use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use pericles::domain::{Alone, Comm, Timed};
#[cfg(feature = "mpi")]
use pericles_mpi::{Mpi, abort, library};
use pericles_run::units::{count, significant, threads};

use crate::args::{Memory, Threads};
use crate::bug;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

#[cfg(not(feature = "mpi"))]
use absent::{Mpi, abort, library};
use cores::Cores;
use launch::Launch;

/// The processes of a run.
pub(crate) struct Processes {
    comm: Arc<dyn Comm>,
    /// The connection, if there are several.
    job: Option<Arc<Mpi>>,
    launch: Option<Launch>,
}

impl Processes {
    /// Connects the processes that a launcher has started; `shared` is whether the command can be divided among several.
    ///
    /// # Errors
    /// There are several processes, and the command cannot be divided or the program cannot connect them.
    pub(crate) fn start(shared: bool) -> Result<Self, CliError> {
        let launch = Launch::of_process();
        let alone = Self {
            comm: Arc::new(Alone),
            job: None,
            launch,
        };
        let Some(Launch { size, .. }) = launch.filter(|launch| launch.size > 1) else {
            return Ok(alone);
        };
        if !shared {
            return Err(CliError::OneProcess { processes: size });
        }
        let Some(job) = Mpi::start() else {
            return Err(match cfg!(feature = "mpi") {
                true => CliError::OneThread { library: library() },
                false => CliError::NoMpi { processes: size },
            });
        };
        if job.size() != size {
            return Err(CliError::OtherMpi {
                launched: size,
                connected: job.size(),
                library: library(),
            });
        }
        bug::end_job_at_panics(job.rank(), size, abort);
        let job = Arc::new(job);
        Ok(Self {
            comm: Arc::new(Timed::new(Arc::clone(&job) as Arc<dyn Comm>)),
            job: Some(job),
            launch,
        })
    }

    /// Returns the communication between the processes.
    pub(crate) fn comm(&self) -> Arc<dyn Comm> {
        Arc::clone(&self.comm)
    }

    /// Returns the memory limit of all processes together, bytes: by default the memory available on their machines. All processes
    /// must call it together.
    pub(crate) fn memory(&self, limit: &Memory) -> u64 {
        if let Some(given) = limit.given() {
            return given;
        }
        // Processes of one machine share its memory.
        let machine = self.job.as_ref().map(|job| job.of_machine());
        let is_first = machine.is_none_or(|machine| machine.rank() == 0);
        let mut sum = [i128::from(if is_first { limit.bytes() } else { 0 })];
        self.comm.sum(&mut sum);
        u64::try_from(sum[0]).unwrap_or(u64::MAX)
    }

    /// Returns whether this is the first of the processes, which prints for all.
    pub(crate) fn is_first(&self) -> bool {
        self.comm.rank() == 0
    }

    /// Returns an error if there are several processes.
    pub(crate) fn require_one(&self) -> Result<(), CliError> {
        match self.comm.size() {
            1 => Ok(()),
            processes => Err(CliError::OneProcess { processes }),
        }
    }

    /// Starts the thread pool of each process: by default one thread per core that other processes leave to it. Processes that
    /// a launcher has started print how many cores they have. All processes must call it together.
    ///
    /// # Errors
    /// The thread pool cannot be started.
    pub(crate) fn start_threads(&self, wanted: &Threads, quiet: bool) -> Result<(), CliError> {
        if self.launch.is_none() {
            wanted.start()?;
            return Ok(());
        }
        let machine = self.job.as_ref().map(|job| job.of_machine());
        let machine: &dyn Comm = machine.as_ref().map_or(&Alone, |machine| machine);
        let cores = Cores::of_process(machine);
        let started = wanted.start_or(cores.threads())?;
        let mut machines = [i128::from(machine.rank() == 0)];
        self.comm.sum(&mut machines);
        // Largest number of threads, smallest share of the cores, and largest excess of threads.
        let mut most = [
            started as f64,
            -cores.share,
            started as f64 - cores.share.max(1.0),
        ];
        self.comm.max(&mut most);
        if !self.is_first() {
            return Ok(());
        }
        let size = self.comm.size();
        if !quiet && size > 1 {
            let machines = match machines[0] {
                1 => "one machine".into(),
                several => format!("{several} machines"),
            };
            console::note(format_args!(
                "{} processes on {machines} with {} each; cores of process 0: {}",
                count(size as u64),
                threads(started),
                cores.list()
            ));
        }
        /// Fractions of a core are due to processes that share cores.
        const EXCESS: f64 = 0.5;
        if most[2] >= EXCESS {
            let [threads, share] = [most[0], -most[1]].map(|number| significant(number, 2));
            console::note(format_args!(
                "warning: {threads} threads per process on {share} cores per process. Use fewer threads (--threads), or give each \
                 process more cores: `mpirun --bind-to none`, `mpirun --map-by socket:PE={threads}`, `srun --cpus-per-task={threads}`"
            ));
        }
        Ok(())
    }

    /// Agrees on the exit status of all processes, and reports the error of the lowest process that has one of its own. To be
    /// called last.
    pub(crate) fn conclude(&self, outcome: Result<Exit, CliError>) -> u8 {
        /// Above all exit statuses.
        const STATUSES: f64 = 256.0;
        /// Time for the other processes to arrive after an error of this one. If they do not, they wait for a message from this
        /// process.
        const PATIENCE: Duration = Duration::from_secs(10);
        let Some(job) = &self.job else {
            return reported(outcome).status();
        };
        let (rank, size) = (job.rank(), job.size());
        let (own, error) = match outcome {
            Ok(exit) => (f64::from(exit.status()), None),
            Err(error) if error.is_elsewhere() => (f64::from(Exit::Internal.status()), Some(error)),
            Err(error) => {
                let order = (size - rank) as f64 * STATUSES;
                (order + f64::from(error.exit().status()), Some(error))
            }
        };
        let report = |error: &CliError| {
            if rank > 0 {
                console::note(format_args!("process {rank} of {size}, counted from 0:"));
            }
            error.report();
        };
        let began = Instant::now();
        let agreed = job.agree_at_end(own, &mut || {
            if let (Some(error), true, true) = (&error, own >= STATUSES, began.elapsed() > PATIENCE)
            {
                report(error);
                abort(i32::from(error.exit().status()));
            }
        });
        // An error that no process reports is reported by all that have it.
        if let (Some(error), true) = (&error, agreed == own) {
            report(error);
        }
        (agreed % STATUSES) as u8
    }
}

/// Reports the error of a command of a single process.
fn reported(outcome: Result<Exit, CliError>) -> Exit {
    outcome.unwrap_or_else(|error| {
        error.report();
        error.exit()
    })
}

/// Reports an error of processes that are not connected, once, and returns the exit status.
pub(crate) fn rejected(error: &CliError) -> u8 {
    /// Launchers end all processes when one fails; the first one needs time to print.
    const PAUSE: Duration = Duration::from_secs(1);
    match Launch::of_process() {
        Some(launch) if launch.rank > 0 => thread::sleep(PAUSE),
        _ => error.report(),
    }
    error.exit().status()
}
