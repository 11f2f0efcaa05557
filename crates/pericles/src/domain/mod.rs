//! Domain decomposition: the points owned by a process, and communication with other processes.
//!
//! A body may be divided among several processes. Each process owns some of the points; integrators, observers and
//! boundaries see vectors of these points, contiguous and component-major. Of the points of other processes it has
//! copies, *ghosts*, as far as its own points interact with them. Ghost values are stored in a separate buffer and
//! are visible to forces only: a force requests them ([`Domain::ghosts`]) before each of its passes. Sums, maxima
//! and counts over points go through the domain too, so that no other code depends on the number of processes. A
//! single process that owns all points ([`Alone`]) is the normal case; [`Threads`] are processes within a program.
//! [`division`](crate::division) decides which process owns which points.
//!
//! The number of a point in the whole body is its index in [`PointCloud`](crate::space::PointCloud), for every
//! division. Rows of bonds and groups of eight follow these numbers, so that the force on a point has the same bits
//! for every division. Each process stores its own points in ascending order of these numbers.

mod agreement;
mod exchange;
mod first;
mod replicated;
mod sums;
mod threads;
mod timed;

use std::borrow::Cow;
use std::cmp::Ordering;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

pub use agreement::{agreed, all};
pub use exchange::exchange_all;
pub use first::{collect, distribute, text_message, text_of};
pub use replicated::Replicated;
pub use threads::Threads;
pub use timed::Timed;

/// Communication between the processes that share a body. It offers no sum of floating-point numbers, because such
/// a sum depends on the number of processes.
pub trait Comm: Send + Sync {
    /// Index of this process.
    fn rank(&self) -> usize;

    /// Number of processes.
    fn size(&self) -> usize;

    /// Sends `sent[k]` to process `peers[k]` and fills `received[k]` with what that process sends to this one.
    fn exchange(&self, peers: &[usize], sent: &[Vec<f64>], received: &mut [Vec<f64>]);

    /// Replaces each number by its sum over all processes.
    fn sum(&self, numbers: &mut [i128]);

    /// Replaces each number by its maximum over all processes.
    fn max(&self, numbers: &mut [f64]);

    /// Time that this process has spent in communication; zero if it is not measured. See [`Timed`].
    fn waited(&self) -> Duration {
        Duration::ZERO
    }
}

/// One process that owns all points.
#[derive(Debug, Clone, Copy, Default)]
pub struct Alone;

impl Comm for Alone {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn exchange(&self, _peers: &[usize], _sent: &[Vec<f64>], _received: &mut [Vec<f64>]) {}

    fn sum(&self, _numbers: &mut [i128]) {}

    fn max(&self, _numbers: &mut [f64]) {}
}

/// A process that owns ghosts of this process, or whose ghosts this process owns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Peer {
    /// Its index.
    pub rank: usize,
    /// Own points that are its ghosts, by their local index.
    pub sent: Vec<u32>,
    /// Ghosts that it owns, in the same order.
    pub received: Range<usize>,
}

/// A message between two points of different processes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Letter {
    /// Sending point; ghosts are counted after the own points.
    pub from: usize,
    /// Receiving point, counted in the same way.
    pub to: usize,
    /// Content of the message.
    pub numbers: [f64; Letter::NUMBERS],
}

impl Letter {
    /// Count of numbers in a message.
    pub const NUMBERS: usize = 4;
}

/// The points of a process and its communication.
#[derive(Clone)]
pub struct Domain {
    owned: usize,
    ghosts: usize,
    /// Numbers in the whole body, own points first; empty if all points are owned.
    numbers: Vec<u32>,
    peers: Vec<Peer>,
    comm: Arc<dyn Comm>,
}

impl fmt::Debug for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            owned,
            ghosts,
            peers,
            comm,
            ..
        } = self;
        let size = comm.size();
        let rank = comm.rank();
        write!(
            f,
            "{owned} points of process {rank} of {size}, {ghosts} ghosts of {} others",
            peers.len()
        )
    }
}

/// A vector field on the points of a process: component c of own point i is `owned[c * n + i]`, of ghost g
/// `ghosts[c * m + g]`, with n own points and m ghosts.
#[derive(Debug, Clone, Copy)]
pub struct Field<'a> {
    /// Values of own points.
    pub owned: &'a [f64],
    /// Values of ghosts.
    pub ghosts: &'a [f64],
}

impl<'a> Field<'a> {
    /// Combines the values of own points and ghosts.
    pub fn new(owned: &'a [f64], ghosts: &'a [f64]) -> Self {
        Self { owned, ghosts }
    }

    /// Returns component c of D at a point; ghosts are counted after the own points.
    #[inline(always)]
    pub fn at<const D: usize>(&self, c: usize, point: usize) -> f64 {
        self.entry(D, c, point)
    }

    /// Returns component c of `components` at a point, as [`Field::at`].
    #[inline(always)]
    pub fn entry(&self, components: usize, c: usize, point: usize) -> f64 {
        let n = self.owned.len() / components;
        let m = self.ghosts.len() / components;
        match point.checked_sub(n) {
            None => self.owned[c * n + point],
            Some(ghost) => self.ghosts[c * m + ghost],
        }
    }

    /// Returns the value at point j minus the value at point i.
    pub fn difference<const D: usize>(&self, [i, j]: [usize; 2]) -> [f64; D] {
        std::array::from_fn(|c| self.at::<D>(c, j) - self.at::<D>(c, i))
    }
}

impl Domain {
    /// The domain of a single process that owns all points.
    pub fn alone(points: usize) -> Self {
        Self {
            owned: points,
            ghosts: 0,
            numbers: Vec::new(),
            peers: Vec::new(),
            comm: Arc::new(Alone),
        }
    }

    /// The domain of one of several processes: the numbers of its points in the whole body, first `owned` own
    /// points in ascending order, then ghosts.
    ///
    /// # Panics
    /// If the ghosts of the peers are not the points after the own ones, or the numbers of own points do not
    /// increase.
    pub fn new(numbers: Vec<u32>, owned: usize, peers: Vec<Peer>, comm: Arc<dyn Comm>) -> Self {
        let ghosts = peers.iter().map(|peer| peer.received.len()).sum();
        assert_eq!(numbers.len(), owned + ghosts, "one number per point");
        assert!(
            numbers[..owned].is_sorted_by(|a, b| a < b),
            "own points are in ascending order"
        );
        Self {
            owned,
            ghosts,
            numbers,
            peers,
            comm,
        }
    }

    /// Number in the whole body of own point k, or of ghost k − n if k ≥ n, the number of own points.
    pub fn number(&self, k: usize) -> usize {
        match &self.numbers[..] {
            [] => k,
            numbers => numbers[k] as usize,
        }
    }

    /// Numbers of own points in the whole body; empty if all points are owned.
    pub fn own_numbers(&self) -> Vec<u32> {
        match &self.numbers[..] {
            [] => Vec::new(),
            numbers => numbers[..self.owned].to_vec(),
        }
    }

    /// Returns one value per point, first own points, then ghosts. All processes must call it together.
    pub fn with_ghosts<'a>(&self, owned: &'a [f64]) -> Cow<'a, [f64]> {
        if self.peers.is_empty() {
            return Cow::Borrowed(owned);
        }
        Cow::Owned([owned, &self.ghosts(owned)].concat())
    }

    /// Returns one flag per point, first own points, then ghosts. All processes must call it together.
    pub fn marks_with_ghosts<'a>(&self, owned: &'a [bool]) -> Cow<'a, [bool]> {
        if self.peers.is_empty() {
            return Cow::Borrowed(owned);
        }
        let numbers: Vec<f64> = owned
            .iter()
            .map(|&mark| f64::from(u8::from(mark)))
            .collect();
        let marks = self.with_ghosts(&numbers);
        Cow::Owned(marks.iter().map(|&mark| mark != 0.0).collect())
    }

    /// Marks the own points whose ghosts are marked on other processes, and returns those that were not marked. `marks` has
    /// one flag per point, first own points, then ghosts. All processes must call it together.
    pub fn merge_ghost_marks(&self, marks: &mut [bool]) -> Vec<u32> {
        let flag = |&mark: &bool| f64::from(u8::from(mark));
        let of_ghosts = |peer: &Peer| &marks[self.owned..][peer.received.clone()];
        let received = self.exchange(|peer| of_ghosts(peer).iter().map(flag).collect());
        let mut new = Vec::new();
        for (peer, received) in self.peers.iter().zip(&received) {
            let marked = peer.sent.iter().zip(received);
            for (&i, _) in marked.filter(|&(_, &mark)| mark != 0.0) {
                if !std::mem::replace(&mut marks[i as usize], true) {
                    new.push(i);
                }
            }
        }
        new
    }

    /// Returns the messages to own points: `letters`, which own points send, and the messages from other
    /// processes, in the order of the numbers of receiving and then of sending points, which does not depend on the division. All
    /// processes must call it together.
    ///
    /// # Panics
    /// If a point that sends to a ghost is not a ghost of the owner of that ghost.
    pub fn deliver(&self, letters: Vec<Letter>) -> Vec<Letter> {
        const LENGTH: usize = 2 + Letter::NUMBERS;
        let own = |one: &Letter| one.to < self.owned;
        let (mut arrived, away): (Vec<Letter>, Vec<Letter>) = letters.into_iter().partition(own);
        let received = self.exchange(|peer| {
            let first = self.owned + peer.received.start;
            let theirs = first..first + peer.received.len();
            let to_them = away.iter().filter(|one| theirs.contains(&one.to));
            to_them
                .flat_map(|one| {
                    let from = peer.sent.iter().position(|&k| k as usize == one.from);
                    let from = from.expect("the owners of both ends of a bond have the bond");
                    let place = [one.to - first, from].map(|k| k as f64);
                    place.into_iter().chain(one.numbers)
                })
                .collect()
        });
        for (peer, numbers) in self.peers.iter().zip(&received) {
            arrived.extend(numbers.chunks_exact(LENGTH).map(|one| Letter {
                from: self.owned + peer.received.start + one[1] as usize,
                to: peer.sent[one[0] as usize] as usize,
                numbers: std::array::from_fn(|k| one[2 + k]),
            }));
        }
        let ends = |one: &Letter| (one.to, self.number(one.from));
        arrived.sort_unstable_by(|a, b| {
            // Images of a point beyond periodic faces send several messages.
            let numbers = a.numbers.iter().zip(&b.numbers);
            let by_content = numbers.map(|(a, b)| a.total_cmp(b));
            let by_content = by_content.fold(Ordering::Equal, Ordering::then);
            ends(a).cmp(&ends(b)).then(by_content)
        });
        arrived
    }

    /// Sends a message to each peer and returns the messages of the peers.
    fn exchange(&self, message: impl Fn(&Peer) -> Vec<f64>) -> Vec<Vec<f64>> {
        let mut received = vec![Vec::new(); self.peers.len()];
        if !self.peers.is_empty() {
            let ranks: Vec<usize> = self.peers.iter().map(|peer| peer.rank).collect();
            let sent: Vec<Vec<f64>> = self.peers.iter().map(message).collect();
            self.comm.exchange(&ranks, &sent, &mut received);
        }
        received
    }

    /// Sends a message to the first process, which receives the messages of all processes in the order of ranks; `None` on the
    /// others. All processes must call it together.
    pub fn collect(&self, message: Vec<f64>) -> Option<Vec<Vec<f64>>> {
        collect(&*self.comm, message)
    }

    /// Sends `messages[k]` from the first process, which passes one per process, to process k, and returns the message of
    /// this process. All processes must call it together.
    pub fn distribute(&self, messages: Option<Vec<Vec<f64>>>) -> Vec<f64> {
        distribute(&*self.comm, messages)
    }

    /// Returns a component-major vector on the points of the whole body, in the order of their numbers, on the first process;
    /// `None` on the others. All processes must call it together.
    pub fn gather<'a>(&self, owned: &'a [f64]) -> Option<Cow<'a, [f64]>> {
        if !self.is_divided() {
            return Some(Cow::Borrowed(owned));
        }
        let own = self.owned;
        let components = self.max((owned.len() / own.max(1)) as f64) as usize;
        let numbers = (0..own).map(|k| self.number(k) as f64);
        let messages = self.collect(numbers.chain(owned.iter().copied()).collect())?;
        let points = |message: &Vec<f64>| message.len() / (components + 1);
        let whole: usize = messages.iter().map(points).sum();
        let mut gathered = vec![0.0; components * whole];
        for message in &messages {
            let (numbers, values) = message.split_at(points(message));
            for (c, values) in values.chunks(numbers.len().max(1)).enumerate() {
                for (&number, &value) in numbers.iter().zip(values) {
                    gathered[c * whole + number as usize] = value;
                }
            }
        }
        Some(Cow::Owned(gathered))
    }

    /// Returns whether this is the first of the processes, which writes files and messages for all.
    pub fn is_first(&self) -> bool {
        self.comm.rank() == 0
    }

    /// Returns the communication with the other processes.
    pub fn comm(&self) -> &Arc<dyn Comm> {
        &self.comm
    }

    /// Number of points of the whole body. All processes must call it together.
    pub fn whole_points(&self) -> usize {
        self.count(self.owned as u64) as usize
    }

    /// Returns whether other processes own points of the body.
    pub fn is_divided(&self) -> bool {
        self.comm.size() > 1
    }

    /// Number of own points.
    pub fn owned_points(&self) -> usize {
        self.owned
    }

    /// Number of ghosts.
    pub fn ghost_points(&self) -> usize {
        self.ghosts
    }

    /// Returns the values of the ghosts of a component-major vector on points, from their owners. All processes
    /// must call it together.
    pub fn ghosts(&self, owned: &[f64]) -> Vec<f64> {
        if self.peers.is_empty() {
            return Vec::new();
        }
        let components = owned.len() / self.owned.max(1);
        let received = self.exchange(|peer| {
            let of = |c: usize| {
                peer.sent
                    .iter()
                    .map(move |&i| owned[c * self.owned + i as usize])
            };
            (0..components).flat_map(of).collect()
        });
        let mut ghosts = vec![0.0; components * self.ghosts];
        for (peer, values) in self.peers.iter().zip(&received) {
            for (c, values) in values.chunks(peer.received.len().max(1)).enumerate() {
                let from = c * self.ghosts + peer.received.start;
                ghosts[from..from + values.len()].copy_from_slice(values);
            }
        }
        ghosts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_of_all_points_are_gathered_in_the_order_of_their_numbers() {
        // Point k belongs to process k modulo 3; the last of four processes has no points.
        let found = Threads::run(4, |comm| {
            let rank = comm.rank() as u32;
            let numbers: Vec<u32> = (0..11).filter(|k| k % 3 == rank).collect();
            let own = numbers.len();
            let domain = Domain::new(numbers.clone(), own, vec![], comm);
            assert_eq!(domain.whole_points(), 11);
            let axis = |c: u32| numbers.iter().map(move |&k| f64::from(k + 100 * c));
            let values: Vec<f64> = axis(0).chain(axis(1)).collect();
            let whole = domain.gather(&values).map(Cow::into_owned);
            let each = (0..4).map(|k| vec![f64::from(k); k as usize]).collect();
            let own = domain.distribute(domain.is_first().then_some(each));
            assert_eq!(own, vec![f64::from(rank); rank as usize]);
            whole
        });
        let expected: Vec<f64> = (0..11).chain(100..111).map(f64::from).collect();
        assert_eq!(found, [Some(expected), None, None, None]);
    }

    /// Point 1 of a chain receives messages of all others, in the order of their numbers for every division.
    #[test]
    fn messages_to_a_point_have_the_same_order_for_every_division() {
        const POINTS: u32 = 7;
        for size in [1, 3] {
            let found = Threads::run(size, |comm| {
                let (rank, size) = (comm.rank() as u32, size as u32);
                let of = |rank: u32| (0..POINTS).filter(move |k| k % size == rank);
                let mut numbers: Vec<u32> = of(rank).collect();
                let own = numbers.len();
                let others = (0..size).filter(|&other| other != rank);
                let peers: Vec<Peer> = others
                    .map(|other| {
                        let first = numbers.len() - own;
                        numbers.extend(of(other));
                        Peer {
                            rank: other as usize,
                            sent: (0..own as u32).collect(),
                            received: first..numbers.len() - own,
                        }
                    })
                    .collect();
                let to = numbers.iter().position(|&k| k == 1).unwrap();
                let domain = Domain::new(numbers, own, peers, comm);
                let letter = |from: usize| Letter {
                    from,
                    to,
                    numbers: [0.0; Letter::NUMBERS],
                };
                let arrived = domain.deliver((0..own).rev().map(letter).collect());
                arrived
                    .iter()
                    .map(|one| domain.number(one.from))
                    .collect::<Vec<_>>()
            });
            let of_owner = &found[1 % size];
            assert_eq!(of_owner, &(0..POINTS as usize).collect::<Vec<_>>());
        }
    }
}
