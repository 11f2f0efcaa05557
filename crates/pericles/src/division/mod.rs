//! Division of a body among processes: which process owns which points, and which points of others it needs.
//!
//! [`bisect`] assigns points to processes by recursive coordinate bisection. [`part_by_bisection`], or [`divide`] for any other
//! division, creates the part of a body that a process computes, with its ghosts and its communication; results do not depend on
//! the division, bit for bit ([`domain`](crate::domain)). [`shares`] predicts points, ghosts and messages of every process.
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
pub use bisection::{Bisection, Cuts, Points, bisect};
pub use placement::rounds;

use crate::domain::{Comm, Domain, Peer};
use crate::error::Result;
use crate::family::pairs_of_sites;
use crate::space::{Point, PointCloud, PointSource, Sites, check_length};

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

/// Returns the points of others within reach of each of the points `rows`, with their owners. `near` are points of a body,
/// among them all within reach of the rows, and `owners` their owners; points are identified by their indices in `near`.
fn foreign(
    near: &Arc<PointCloud>,
    owners: &[u32],
    reach: f64,
    rows: &[u32],
) -> Result<Vec<BTreeSet<(u32, u32)>>> {
    check_length("the owners of the points", owners.len(), near.len())?;
    if rows.is_empty() {
        return Ok(Vec::new());
    }
    let sites = Sites::new(near, reach)?;
    let owner = |site: usize| owners[sites.point(site)];
    let is_foreign = |i: usize, j: usize| owner(i) != owner(j);
    let (starts, found) = pairs_of_sites(&sites, rows, reach, &|i, j, distance| {
        distance <= reach && is_foreign(i, j)
    });
    let of_row = |k: usize| {
        let row = found[starts[k]..starts[k + 1]].iter();
        row.map(|&site| sites.point(site as usize))
            .map(|point| (owners[point], point as u32))
            .collect()
    };
    Ok((0..rows.len()).into_par_iter().map(of_row).collect())
}

/// Returns a test whether a position lies in the box around some points, enlarged by twice the reach, because coordinates are
/// rounded.
fn around(points: &PointCloud, reach: f64) -> impl Fn(Point) -> bool + use<> {
    let side = |c: usize| {
        let along = points.axis(c).iter();
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| {
            (low.min(x), high.max(x))
        });
        low - 2.0 * reach..=high + 2.0 * reach
    };
    let sides: Vec<_> = (0..points.dimension()).map(side).collect();
    move |place| sides.iter().zip(place).all(|(side, x)| side.contains(&x))
}

/// Creates the part of a body that the calling process owns, with ghosts as far as bonds of length up to `reach` (m) lead.
/// `owner` returns the process of a point by its number and position, m. Only the points of this part and of its surroundings are
/// created; of bodies with periodic faces all.
///
/// # Errors
/// Bonds that span too many periods of the body.
pub fn divide(
    body: &dyn PointSource,
    owner: impl Fn(u32, Point) -> u32,
    reach: f64,
    comm: Arc<dyn Comm>,
) -> Result<PointCloud> {
    let rank = comm.rank() as u32;
    let own = body.points_where(&mut |number, place| owner(number, place) == rank);
    let is_near = around(&own, reach);
    let is_periodic = own.is_periodic();
    // Images beyond periodic faces may lie anywhere.
    let near = body.points_where(&mut |_, place| is_periodic || is_near(place));
    let near = Arc::new(near);
    let number = |point: usize| near.domain().number(point) as u32;
    let owners: Vec<u32> = (0..near.len())
        .map(|k| owner(number(k), near.point(k)))
        .collect();
    let all = 0..near.len() as u32;
    let rows: Vec<u32> = all.filter(|&k| owners[k as usize] == rank).collect();
    let found = foreign(&near, &owners, reach, &rows)?;
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
    let (owned, mut numbers) = (own.len(), own.domain().own_numbers());
    let peers = peers.into_iter().map(|(rank, (sent, ghosts))| {
        let first = numbers.len() - owned;
        numbers.extend(ghosts.iter().map(|&point| number(point as usize)));
        Peer {
            rank: rank as usize,
            sent,
            received: first..first + ghosts.len(),
        }
    });
    let peers = peers.collect();
    let spacing = own.spacing();
    Ok(own.with_domain(Domain::new(numbers, owned, peers, comm), spacing))
}

/// Creates the part of a body that the calling process owns, see [`divide`], if it is divided by recursive coordinate bisection into
/// as many parts of equal numbers of points as there are processes. No process stores the points of others, except for ghosts. All
/// processes must call it together.
///
/// # Errors
/// The errors of [`divide`].
pub fn part_by_bisection(
    body: &dyn PointSource,
    reach: f64,
    cuts: Cuts,
    comm: Arc<dyn Comm>,
) -> Result<PointCloud> {
    let (rank, size) = (comm.rank() as u64, comm.size() as u64);
    let count = body.count() as u64;
    let bound = |rank: u64| (rank * count / size) as u32;
    let range = bound(rank)..bound(rank + 1);
    let slice = body.points_where(&mut |number, _| range.contains(&number));
    let points = Points {
        dimension: slice.dimension(),
        positions: slice.positions(),
        numbers: &slice.domain().own_numbers(),
        weights: &[],
    };
    let parts = bisect(&*comm, &points, comm.size(), cuts);
    drop(slice);
    divide(
        body,
        |number, place| parts.owner(number, place),
        reach,
        comm,
    )
}

/// Returns the part of a body that the calling process owns, with ghosts as far as bonds of length up to `reach` (m) lead.
/// `owners` has the process of each point.
///
/// # Errors
/// Owners that are not one per point, and those of [`divide`].
pub fn part_of(
    whole: &PointCloud,
    owners: &[u32],
    reach: f64,
    comm: Arc<dyn Comm>,
) -> Result<PointCloud> {
    check_length("the owners of the points", owners.len(), whole.len())?;
    divide(whole, |number, _| owners[number as usize], reach, comm)
}

/// Returns points, ghosts and messages of each of `processes` processes for bonds of length up to `reach` (m).
///
/// # Errors
/// The errors of [`part_of`].
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
