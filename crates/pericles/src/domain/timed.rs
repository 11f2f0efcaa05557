//! Time that a process spends in communication.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use super::Comm;

/// A communicator that measures the time spent in its calls: the transfer, and the wait for processes that arrive later.
///
/// ```
/// use std::sync::Arc;
/// use std::time::Duration;
/// use pericles::domain::{Alone, Comm, Timed};
///
/// let comm = Timed::new(Arc::new(Alone));
/// comm.max(&mut [1.0]);
/// assert!(comm.waited() < Duration::from_secs(1));
/// ```
pub struct Timed {
    inner: Arc<dyn Comm>,
    nanoseconds: AtomicU64,
}

impl Timed {
    /// Measures the calls of a communicator.
    pub fn new(inner: Arc<dyn Comm>) -> Self {
        Self {
            inner,
            nanoseconds: AtomicU64::new(0),
        }
    }

    fn timed<T>(&self, call: impl FnOnce(&dyn Comm) -> T) -> T {
        let began = Instant::now();
        let result = call(&*self.inner);
        let spent = u64::try_from(began.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.nanoseconds.fetch_add(spent, Ordering::Relaxed);
        result
    }
}

impl Comm for Timed {
    fn rank(&self) -> usize {
        self.inner.rank()
    }

    fn size(&self) -> usize {
        self.inner.size()
    }

    fn exchange(&self, peers: &[usize], sent: &[Vec<f64>], received: &mut [Vec<f64>]) {
        self.timed(|inner| inner.exchange(peers, sent, received));
    }

    fn sum(&self, numbers: &mut [i128]) {
        self.timed(|inner| inner.sum(numbers));
    }

    fn max(&self, numbers: &mut [f64]) {
        self.timed(|inner| inner.max(numbers));
    }

    fn waited(&self) -> Duration {
        Duration::from_nanos(self.nanoseconds.load(Ordering::Relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Threads;

    /// Delay of one of the processes.
    const LATE: Duration = Duration::from_millis(60);

    #[test]
    fn processes_that_arrive_early_wait_for_the_last_one() {
        type Call = fn(&dyn Comm);
        let calls: [Call; 3] = [
            |comm| comm.max(&mut [comm.rank() as f64]),
            |comm| comm.sum(&mut [1]),
            |comm| comm.exchange(&[1 - comm.rank()], &[vec![1.0]], &mut [vec![]]),
        ];
        for call in calls {
            let waited = Threads::run(2, |comm| {
                let comm = Timed::new(comm);
                assert_eq!(comm.waited(), Duration::ZERO);
                // Both start together.
                comm.max(&mut [0.0]);
                let before = comm.waited();
                if comm.rank() == 1 {
                    std::thread::sleep(LATE);
                }
                call(&comm);
                comm.waited() - before
            });
            assert!(waited[0] >= LATE / 2, "{waited:?}");
            assert!(waited[1] < waited[0], "{waited:?}");
        }
    }

    #[test]
    fn results_are_those_of_the_communicator() {
        let found = Threads::run(3, |comm| {
            let comm = Timed::new(comm);
            let (mut sum, mut max) = ([comm.rank() as i128], [comm.rank() as f64]);
            comm.sum(&mut sum);
            comm.max(&mut max);
            (comm.rank(), comm.size(), sum, max)
        });
        let expected: Vec<_> = (0..3).map(|rank| (rank, 3, [3], [2.0])).collect();
        assert_eq!(found, expected);
    }
}
