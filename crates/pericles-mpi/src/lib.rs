//! Communication between the processes of an MPI job.
//!
//! [`Mpi`] implements [`Comm`]. A program divides its body with [`division`](pericles::division) and computes the part of its
//! process; the results equal the results of a single process, bit for bit. `examples/plate.rs` is a complete program.
//!
//! The crate needs an MPI library with its compiler wrapper `mpicc`, and libclang while it is built.

use std::panic;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use mpi::Threading;
use mpi::collective::SystemOperation;
use mpi::environment::Universe;
use mpi::request::multiple_scope;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Destination, Source};
use pericles::domain::Comm;

/// Exit status of a job that a panic of one of its processes ends ([`Mpi::end_at_panics`]).
pub const PANICKED: i32 = 70;

/// The processes of a job, or some of them.
pub struct Mpi {
    rank: usize,
    size: usize,
    world: Mutex<World>,
    /// For [`Mpi::agree_at_end`]: reductions on it cannot be taken for others that a process still waits for.
    end: Mutex<World>,
    // Ends MPI when the last copy is dropped, after all calls.
    universe: Arc<Universe>,
}

struct World(SimpleCommunicator);

// SAFETY: MPI is initialised for calls from any thread of the process, one at a time, and the mutexes around the handles
// ensure that the calls of a communicator are made one at a time. Two communicators are not used at the same time.
unsafe impl Send for World {}

fn locked(world: &Mutex<World>) -> MutexGuard<'_, World> {
    world.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends all processes of the job at once. They leave no checkpoint.
pub fn abort(status: i32) -> ! {
    SimpleCommunicator::world().abort(status)
}

/// Returns the name and version of the MPI library, on one line.
pub fn library() -> String {
    let name = mpi::environment::library_version().unwrap_or_default();
    let line = name.lines().next().unwrap_or_default();
    let first = line.split(',').next().unwrap_or_default();
    first.trim_end_matches('\0').trim().replace('\t', " ")
}

impl Mpi {
    /// Starts MPI; `None` if it has been started before, or if the library does not allow calls from several threads.
    ///
    /// A panic of one process leaves the others waiting: see [`Mpi::end_at_panics`].
    pub fn start() -> Option<Self> {
        let (universe, threading) = mpi::initialize_with_threading(Threading::Serialized)?;
        if threading < Threading::Serialized {
            return None;
        }
        let world = universe.world();
        Some(Self::of(world, Arc::new(universe)))
    }

    fn of(world: SimpleCommunicator, universe: Arc<Universe>) -> Self {
        Self {
            rank: world.rank() as usize,
            size: world.size() as usize,
            end: Mutex::new(World(world.duplicate())),
            world: Mutex::new(World(world)),
            universe,
        }
    }

    /// Replaces the panic hook: a panic prints its message and ends all processes of the job with the status
    /// [`PANICKED`]. Without it the others would never end.
    pub fn end_at_panics(&self) {
        let (rank, size) = (self.rank, self.size);
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            eprint!("process {rank} of {size}: ");
            usual(info);
            abort(PANICKED);
        }));
    }

    /// Returns the processes that run on the same machine. All processes must call it together.
    pub fn of_machine(&self) -> Self {
        let world = locked(&self.world).0.split_shared(self.rank as i32);
        Self::of(world, Arc::clone(&self.universe))
    }

    /// Returns the largest of the numbers of all processes, as the last call of each of them. Calls `waiting` from time to
    /// time until all have called it, so that a process can [`abort`] the job if others never do, because they wait for a
    /// message that this process does not send.
    pub fn agree_at_end(&self, own: f64, waiting: &mut dyn FnMut()) -> f64 {
        /// Between two looks at the state of the reduction.
        const PAUSE: Duration = Duration::from_millis(1);
        let end = &locked(&self.end).0;
        let (own, mut largest) = ([own], [0.0]);
        mpi::request::scope(|scope| {
            let operation = SystemOperation::max();
            let mut request =
                end.immediate_all_reduce_into(scope, &own[..], &mut largest[..], operation);
            while let Err(pending) = request.test() {
                request = pending;
                waiting();
                thread::sleep(PAUSE);
            }
        });
        largest[0]
    }
}

/// Number of pieces of an integer in a sum.
const PIECES: usize = 4;
/// Bits of a piece; sums of pieces over up to 2³¹ processes do not overflow.
const BITS: u32 = 32;

/// Splits an integer into unsigned pieces and a signed highest one.
fn pieces(number: i128) -> [i64; PIECES] {
    std::array::from_fn(|k| {
        let rest = number >> (BITS * k as u32);
        match k + 1 < PIECES {
            true => (rest & i128::from(u32::MAX)) as i64,
            false => rest as i64,
        }
    })
}

/// Returns the integer with the given sums of pieces.
fn joined(sums: &[i64]) -> i128 {
    let pieces = sums.iter().enumerate();
    pieces.fold(0, |number: i128, (k, &piece)| {
        number.wrapping_add(i128::from(piece) << (BITS * k as u32))
    })
}

impl Comm for Mpi {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn exchange(&self, peers: &[usize], sent: &[Vec<f64>], received: &mut [Vec<f64>]) {
        let world = &locked(&self.world).0;
        let process = |&peer: &usize| world.process_at_rank(peer as i32);
        multiple_scope(sent.len(), |scope, requests| {
            for (peer, message) in peers.iter().zip(sent) {
                requests.add(process(peer).immediate_send(scope, &message[..]));
            }
            for (peer, place) in peers.iter().zip(received) {
                (*place, _) = process(peer).receive_vec();
            }
            requests.wait_all(&mut Vec::new());
        });
    }

    fn sum(&self, numbers: &mut [i128]) {
        let own: Vec<i64> = numbers.iter().copied().flat_map(pieces).collect();
        let mut sums = vec![0; own.len()];
        let operation = SystemOperation::sum();
        locked(&self.world)
            .0
            .all_reduce_into(&own, &mut sums, operation);
        for (number, sums) in numbers.iter_mut().zip(sums.chunks(PIECES)) {
            *number = joined(sums);
        }
    }

    fn max(&self, numbers: &mut [f64]) {
        let own = numbers.to_vec();
        let operation = SystemOperation::max();
        locked(&self.world)
            .0
            .all_reduce_into(&own, numbers, operation);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_pieces_are_sums_of_integers() {
        let numbers = [
            0,
            -1,
            i128::from(u64::MAX),
            -(1 << 100),
            1 << 90,
            i128::MAX / 8,
            i128::MIN / 8,
        ];
        for a in numbers {
            for b in numbers {
                let sums: Vec<i64> = pieces(a)
                    .iter()
                    .zip(pieces(b))
                    .map(|(a, b)| a + b)
                    .collect();
                assert_eq!(joined(&sums), a + b);
            }
        }
    }
}
