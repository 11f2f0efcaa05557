//! Processes that are threads of a single program.

use std::collections::VecDeque;
use std::panic::resume_unwind;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use super::Comm;

/// Communication between threads in place of processes, for tests and programs: a body divided among threads has the same
/// results, bit for bit, as one divided among the processes of several machines.
pub struct Threads {
    rank: usize,
    size: usize,
    board: Arc<Board>,
}

/// What the threads share.
#[derive(Default)]
struct Board {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// Number of reductions that have been completed, and of threads that have contributed to the next one.
    completed: u64,
    arrived: usize,
    sums: Reduction<i128>,
    maxima: Reduction<f64>,
    /// Messages from thread a to thread b, at a · size + b.
    messages: Vec<VecDeque<Vec<f64>>>,
    /// The first thread that ended by a panic.
    failed: Option<usize>,
}

/// A reduction in progress, and the result of the last one.
#[derive(Default)]
struct Reduction<T> {
    collected: Vec<T>,
    result: Vec<T>,
}

impl<T: Copy> Reduction<T> {
    fn add(&mut self, own: &[T], merge: impl Fn(T, T) -> T) {
        match self.collected.is_empty() {
            true => self.collected.extend_from_slice(own),
            false => {
                let pairs = self.collected.iter_mut().zip(own);
                pairs.for_each(|(sum, own)| *sum = merge(*sum, *own));
            }
        }
    }

    fn complete(&mut self) {
        self.result = std::mem::take(&mut self.collected);
    }
}

impl Board {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until a condition holds.
    ///
    /// # Panics
    /// If another thread has ended by a panic, so that the condition may never hold.
    fn wait_until<'a>(
        &self,
        mut state: MutexGuard<'a, State>,
        holds: impl Fn(&State) -> bool,
    ) -> MutexGuard<'a, State> {
        while !holds(&state) {
            assert!(
                state.failed.is_none(),
                "another thread of the run has failed"
            );
            let woken = self.changed.wait(state);
            state = woken.unwrap_or_else(PoisonError::into_inner);
        }
        state
    }
}

/// Marks the run as failed if its thread panics, so that the others do not wait for it.
struct Watch(Arc<Board>, usize);

impl Drop for Watch {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.lock().failed.get_or_insert(self.1);
            self.0.changed.notify_all();
        }
    }
}

impl Threads {
    /// Runs `work` on `size` threads, each with its communicator; returns the results in the order of ranks.
    ///
    /// # Panics
    /// If the work panics on any thread.
    pub fn run<T: Send>(size: usize, work: impl Fn(Arc<dyn Comm>) -> T + Sync) -> Vec<T> {
        let board = Arc::new(Board::default());
        board
            .lock()
            .messages
            .resize_with(size * size, VecDeque::new);
        thread::scope(|scope| {
            let start = |rank| {
                let (board, work) = (Arc::clone(&board), &work);
                scope.spawn(move || {
                    let _watch = Watch(Arc::clone(&board), rank);
                    work(Arc::new(Self { rank, size, board }))
                })
            };
            let threads: Vec<_> = (0..size).map(start).collect();
            let ended = threads.into_iter().map(thread::ScopedJoinHandle::join);
            let mut results: Vec<_> = ended.collect();
            // The first panic is the cause of the others.
            if let Some(rank) = board.lock().failed {
                results.swap(0, rank);
            }
            let one =
                |result: thread::Result<T>| result.unwrap_or_else(|panic| resume_unwind(panic));
            results.into_iter().map(one).collect()
        })
    }

    /// Adds the numbers of this thread to a reduction and returns its result.
    fn reduce<T: Copy>(
        &self,
        numbers: &mut [T],
        of: impl Fn(&mut State) -> &mut Reduction<T>,
        merge: impl Fn(T, T) -> T,
    ) {
        let mut state = self.board.lock();
        let before = state.completed;
        of(&mut state).add(numbers, merge);
        state.arrived += 1;
        if state.arrived == self.size {
            of(&mut state).complete();
            state.arrived = 0;
            state.completed += 1;
            self.board.changed.notify_all();
        }
        // The next reduction is complete only after every thread has read the result of this one.
        let mut state = self
            .board
            .wait_until(state, |state| state.completed > before);
        numbers.copy_from_slice(&of(&mut state).result);
    }
}

impl Comm for Threads {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn exchange(&self, peers: &[usize], sent: &[Vec<f64>], received: &mut [Vec<f64>]) {
        let mut state = self.board.lock();
        for (&peer, message) in peers.iter().zip(sent) {
            state.messages[self.rank * self.size + peer].push_back(message.clone());
        }
        self.board.changed.notify_all();
        for (&peer, place) in peers.iter().zip(received) {
            let from = peer * self.size + self.rank;
            let arrived = |state: &State| !state.messages[from].is_empty();
            state = self.board.wait_until(state, arrived);
            *place = state.messages[from].pop_front().unwrap_or_default();
        }
    }

    fn sum(&self, numbers: &mut [i128]) {
        self.reduce(numbers, |state| &mut state.sums, |a, b| a + b);
    }

    fn max(&self, numbers: &mut [f64]) {
        self.reduce(numbers, |state| &mut state.maxima, f64::max);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reductions_and_messages_reach_all_threads() {
        let results = Threads::run(4, |comm| {
            let (rank, size) = (comm.rank(), comm.size());
            let mut sums = [rank as i128, 1];
            let mut most = [-(rank as f64)];
            let next = (rank + 1) % size;
            let before = (rank + size - 1) % size;
            let mut received = vec![Vec::new(); 2];
            for round in 0..100 {
                let mut again = [round];
                comm.sum(&mut again);
                assert_eq!(again, [4 * round]);
            }
            comm.sum(&mut sums);
            comm.max(&mut most);
            let sent = [vec![rank as f64], vec![]];
            comm.exchange(&[next, before], &sent, &mut received);
            (sums, most, received)
        });
        for (rank, (sums, most, received)) in results.iter().enumerate() {
            assert_eq!((*sums, *most), ([6, 4], [0.0]));
            assert_eq!(received[0], Vec::<f64>::new());
            assert_eq!(received[1], [((rank + 3) % 4) as f64]);
        }
    }

    #[test]
    #[should_panic = "no data on rank 1"]
    fn a_panic_ends_all_threads() {
        Threads::run(3, |comm| {
            assert!(comm.rank() != 1, "no data on rank {}", comm.rank());
            comm.sum(&mut [1]);
        });
    }
}
