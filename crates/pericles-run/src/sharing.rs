//! How the processes that shared a run spent their time.

use std::time::Duration;

use pericles::domain::Domain;
use serde::Serialize;

use crate::machine;
use crate::units::{bytes, count, percent, significant};

/// The division of a run among several processes, and the time that they waited for each other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sharing {
    /// Number of processes.
    pub processes: usize,
    /// Ghosts of all processes per point of the body.
    pub halo: f64,
    /// Mean share of the time that a process spends in communication: transfer, and waiting for others.
    pub waiting: f64,
    /// Largest share of this time.
    pub largest_waiting: f64,
    /// Largest over mean time that a process does not spend in communication.
    pub imbalance: f64,
    /// Largest peak memory of a process since its start, bytes; `None` if the system does not report it.
    pub largest_peak_memory: Option<u64>,
}

impl Sharing {
    /// Returns the sharing of a part of a run that has taken some seconds, of which this process has spent `waited` in
    /// communication ([`Comm::waited`](pericles::domain::Comm::waited)); `None` for a single process. All processes must call it
    /// together.
    pub fn of(domain: &Domain, seconds: f64, waited: Duration) -> Option<Self> {
        if !domain.is_divided() {
            return None;
        }
        let processes = domain.count(1);
        let [ghosts, points] =
            [domain.ghost_points(), domain.owned_points()].map(|own| domain.count(own as u64));
        let waited = waited.as_secs_f64();
        let busy = (seconds - waited).max(0.0);
        let mean = |own: f64| domain.sum(1, |_| own) / processes as f64;
        let share = |time: f64| if seconds > 0.0 { time / seconds } else { 0.0 };
        let (mean_busy, most_busy) = (mean(busy), domain.max(busy));
        Some(Self {
            processes: processes as usize,
            halo: ghosts as f64 / points as f64,
            waiting: mean(share(waited)),
            largest_waiting: domain.max(share(waited)),
            imbalance: if mean_busy > 0.0 {
                most_busy / mean_busy
            } else {
                1.0
            },
            largest_peak_memory: Self::largest(domain, machine::peak_memory()),
        })
    }

    /// Returns the largest number of all processes; `None` if one of them has none.
    fn largest(domain: &Domain, own: Option<u64>) -> Option<u64> {
        let largest = domain.max(own.map_or(f64::INFINITY, |bytes| bytes as f64));
        largest.is_finite().then_some(largest as u64)
    }

    /// Returns a line for the end of a run.
    pub fn line(&self) -> String {
        let memory = match self.largest_peak_memory {
            Some(memory) => format!(", peak memory up to {}", bytes(memory)),
            None => String::new(),
        };
        format!(
            "{} processes: ghosts {} of the points, {} of the time in communication (largest {}), imbalance {}{memory}",
            count(self.processes as u64),
            percent(self.halo),
            percent(self.waiting),
            percent(self.largest_waiting),
            significant(self.imbalance, 3)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::domain::{Peer, Threads};

    #[test]
    fn times_of_all_processes_are_combined() {
        assert_eq!(Sharing::of(&Domain::alone(7), 1.0, Duration::ZERO), None);
        // Two processes of three points, each with one ghost; the second one waits for half of the time.
        let found = Threads::run(2, |comm| {
            let rank = comm.rank();
            let (first, other) = (3 * rank as u32, 1 - rank);
            let numbers = vec![first, first + 1, first + 2, 3 * other as u32];
            let peer = Peer {
                rank: other,
                sent: vec![0],
                received: 0..1,
            };
            let domain = Domain::new(numbers, 3, vec![peer], comm);
            Sharing::of(&domain, 2.0, Duration::from_secs(rank as u64)).unwrap()
        });
        assert_eq!(found[0], found[1]);
        let memory = found[0].largest_peak_memory;
        let expected = Sharing {
            processes: 2,
            halo: 2.0 / 6.0,
            waiting: 0.25,
            largest_waiting: 0.5,
            imbalance: 2.0 / 1.5,
            largest_peak_memory: memory,
        };
        assert_eq!(found[0], expected);
        let expected = Sharing {
            largest_peak_memory: None,
            ..expected
        };
        assert_eq!(
            expected.line(),
            "2 processes: ghosts 33 % of the points, 25 % of the time in communication (largest 50 %), imbalance 1.33"
        );
    }
}
