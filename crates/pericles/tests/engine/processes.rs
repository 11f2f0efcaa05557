//! Threads that exchange messages in place of processes.

use std::collections::VecDeque;
use std::sync::{Arc, Barrier, Condvar, Mutex};

use pericles::domain::Comm;

/// Data shared by the threads.
struct Office {
    barrier: Barrier,
    /// Sums and maxima in progress.
    numbers: Mutex<(Vec<i128>, Vec<f64>)>,
    /// Messages between threads.
    letters: Mutex<Vec<Vec<VecDeque<Vec<f64>>>>>,
    delivered: Condvar,
}

pub struct Threads {
    rank: usize,
    size: usize,
    office: Arc<Office>,
}

impl Threads {
    /// Lets every thread combine its numbers with the shared ones in turn and read the result.
    fn combine(
        &self,
        add: impl FnOnce(&mut (Vec<i128>, Vec<f64>)),
        read: impl FnOnce(&(Vec<i128>, Vec<f64>)),
    ) {
        add(&mut self.office.numbers.lock().unwrap());
        self.office.barrier.wait();
        read(&self.office.numbers.lock().unwrap());
        if self.office.barrier.wait().is_leader() {
            *self.office.numbers.lock().unwrap() = Default::default();
        }
        self.office.barrier.wait();
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
        let mut letters = self.office.letters.lock().unwrap();
        for (&peer, letter) in peers.iter().zip(sent) {
            letters[self.rank][peer].push_back(letter.clone());
        }
        self.office.delivered.notify_all();
        for (&peer, place) in peers.iter().zip(received) {
            *place = loop {
                match letters[peer][self.rank].pop_front() {
                    Some(letter) => break letter,
                    None => letters = self.office.delivered.wait(letters).unwrap(),
                }
            };
        }
    }

    fn sum(&self, numbers: &mut [i128]) {
        let own = numbers.to_vec();
        let add = |shared: &mut (Vec<i128>, Vec<f64>)| {
            shared.0.resize(own.len(), 0);
            shared
                .0
                .iter_mut()
                .zip(&own)
                .for_each(|(sum, own)| *sum += own);
        };
        self.combine(add, |shared| numbers.copy_from_slice(&shared.0));
    }

    fn max(&self, numbers: &mut [f64]) {
        let own = numbers.to_vec();
        let add = |shared: &mut (Vec<i128>, Vec<f64>)| {
            shared.1.resize(own.len(), f64::NEG_INFINITY);
            shared
                .1
                .iter_mut()
                .zip(&own)
                .for_each(|(most, own)| *most = most.max(*own));
        };
        self.combine(add, |shared| numbers.copy_from_slice(&shared.1));
    }
}

/// Runs `work` on several threads, each with its communicator; results in the order of ranks.
pub fn on_processes<T: Send>(size: usize, work: impl Fn(Arc<dyn Comm>) -> T + Sync) -> Vec<T> {
    let office = Arc::new(Office {
        barrier: Barrier::new(size),
        numbers: Mutex::default(),
        letters: Mutex::new(vec![vec![VecDeque::new(); size]; size]),
        delivered: Condvar::new(),
    });
    std::thread::scope(|scope| {
        let ranks: Vec<_> = (0..size)
            .map(|rank| {
                let (office, work) = (office.clone(), &work);
                scope.spawn(move || work(Arc::new(Threads { rank, size, office })))
            })
            .collect();
        ranks.into_iter().map(|rank| rank.join().unwrap()).collect()
    })
}
