//! Division of a body among processes: which process owns which points, and which points of others it needs.
//!
//! [`bisect`] assigns points to processes by recursive coordinate bisection. [`part_of`] makes the part of a body that a
//! process computes, with its ghosts and its communication; results do not depend on the division, bit for bit
//! ([`domain`](crate::domain)). [`shares`] predicts points, ghosts and messages of every process.
//! [`DividedArchive`] returns ranges of the arrays of the whole body, for checkpoints that do not depend on the division, and
//! [`Archive::part_of`](crate::Archive::part_of) the arrays of a process from such ranges.
//! [`Archive::gathered`](crate::Archive::gathered) makes the archive of the whole body on the first process,
//! [`Archive::scattered`](crate::Archive::scattered) the archives of its parts.

mod archives;
mod bisection;
mod message;
mod placement;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rayon::prelude::*;

pub use archives::{ArrayOutline, ArraySource, DividedArchive, DividedArray};
pub use bisection::{Cuts, Points, bisect};
pub use placement::rounds;

use crate::domain::{Alone, Comm, Domain, Peer};
use crate::error::Result;
use crate::family::pairs_of_sites;
use crate::space::{PointCloud, Sites, check_length};

/// Points and messages of a process.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Share {
    /// Points of the process.
    pub owned: usize,
    /// Points of others whose values it receives in each exchange.
    pub ghosts: usize,
    /// Own points that interact with points of others.
    pub boundary: usize,
    /// Number of processes with which it exchanges messages.
    pub peers: usize,
}

/// Returns the owners of the points of others within reach of each of the points `wanted`, which are ascending, and those points.
/// The search is restricted to the surroundings of the wanted points.
fn foreign(
    whole: &Arc<PointCloud>,
    owners: &[u32],
    reach: f64,
    wanted: &[u32],
) -> Result<Vec<BTreeSet<(u32, u32)>>> {
    check_length("the owners of the points", owners.len(), whole.len())?;
    if wanted.is_empty() {
        return Ok(Vec::new());
    }
    // Images beyond periodic faces may lie anywhere.
    let near = match whole.is_periodic() || wanted.len() == whole.len() {
        true => Arc::clone(whole),
        false => around(whole, wanted, reach),
    };
    let number = |point: usize| near.domain().number(point);
    // Both are ascending.
    let mut next = wanted.iter().peekable();
    let is_wanted = |&k: &u32| {
        next.next_if(|&&i| i as usize == number(k as usize))
            .is_some()
    };
    let rows: Vec<u32> = (0..near.len() as u32).filter(is_wanted).collect();
    let sites = Sites::new(&near, reach)?;
    let owner = |site: usize| owners[number(sites.point(site))];
    let is_foreign = |i: usize, j: usize| owner(i) != owner(j);
    let (starts, found) = pairs_of_sites(&sites, &rows, reach, &|i, j, distance| {
        distance <= reach && is_foreign(i, j)
    });
    let of_row = |k: usize| {
        let row = found[starts[k]..starts[k + 1]].iter();
        row.map(|&site| number(sites.point(site as usize)))
            .map(|point| (owners[point], point as u32))
            .collect()
    };
    Ok((0..wanted.len()).into_par_iter().map(of_row).collect())
}

/// Returns the points of a body in the box around some of its points, enlarged by `reach`.
fn around(whole: &PointCloud, points: &[u32], reach: f64) -> Arc<PointCloud> {
    let axes = 0..whole.dimension();
    let box_of = |c: usize| {
        let along = points.iter().map(|&i| whole.axis(c)[i as usize]);
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        // Twice the reach: coordinates are rounded.
        low - 2.0 * reach..=high + 2.0 * reach
    };
    let sides: Vec<_> = axes.map(box_of).collect();
    let is_inside = |&i: &u32| {
        let mut sides = sides.iter().zip(0..);
        sides.all(|(side, c)| side.contains(&whole.axis(c)[i as usize]))
    };
    let numbers: Vec<u32> = (0..whole.len() as u32).filter(is_inside).collect();
    let n = numbers.len();
    let domain = Domain::new(numbers, n, Vec::new(), Arc::new(Alone));
    Arc::new(whole.part(domain))
}

/// Returns the part of a body that the calling process owns, with ghosts as far as bonds of length up to `reach` (m) lead.
/// `owners` has the process of each point.
///
/// Every process needs the whole body to make its part.
///
/// # Errors
/// Owners that are not one per point; bonds that span too many periods of the body.
pub fn part_of(
    whole: &Arc<PointCloud>,
    owners: &[u32],
    reach: f64,
    comm: Arc<dyn Comm>,
) -> Result<PointCloud> {
    let rank = comm.rank() as u32;
    let all = 0..whole.len() as u32;
    let own: Vec<u32> = all
        .filter(|&i| owners.get(i as usize) == Some(&rank))
        .collect();
    let found = foreign(whole, owners, reach, &own)?;
    // Own points that each peer needs, by local number, and points of the peer, both ascending.
    let mut peers: BTreeMap<u32, (Vec<u32>, BTreeSet<u32>)> = BTreeMap::new();
    for (local, foreign) in found.iter().enumerate() {
        for &(owner, point) in foreign {
            let (sent, ghosts) = peers.entry(owner).or_default();
            // A point has several neighbours of the same owner.
            if sent.last() != Some(&(local as u32)) {
                sent.push(local as u32);
            }
            ghosts.insert(point);
        }
    }
    let (owned, mut numbers) = (own.len(), own);
    let peers = peers.into_iter().map(|(rank, (sent, ghosts))| {
        let first = numbers.len() - owned;
        numbers.extend(&ghosts);
        Peer {
            rank: rank as usize,
            sent,
            received: first..first + ghosts.len(),
        }
    });
    let peers = peers.collect();
    Ok(whole.part(Domain::new(numbers, owned, peers, comm)))
}

/// Returns points, ghosts and messages of each of `processes` processes for bonds of length up to `reach` (m).
///
/// # Errors
/// Those of [`part_of`].
pub fn shares(
    whole: &Arc<PointCloud>,
    owners: &[u32],
    processes: usize,
    reach: f64,
) -> Result<Vec<Share>> {
    let all: Vec<u32> = (0..whole.len() as u32).collect();
    let mut shares = vec![Share::default(); processes];
    let mut peers = vec![BTreeSet::new(); processes];
    for (i, foreign) in foreign(whole, owners, reach, &all)?.iter().enumerate() {
        let own = &mut shares[owners[i] as usize];
        own.owned += 1;
        own.boundary += usize::from(!foreign.is_empty());
        let others: BTreeSet<u32> = foreign.iter().map(|&(owner, _)| owner).collect();
        for &other in &others {
            shares[other as usize].ghosts += 1;
            peers[other as usize].insert(owners[i]);
        }
    }
    for (share, peers) in shares.iter_mut().zip(peers) {
        share.peers = peers.len();
    }
    Ok(shares)
}
