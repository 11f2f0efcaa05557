//! Points of other processes that own points may touch.
//!
//! The search also finds the points of other processes within the contact distance and the skin of the box of own
//! points, and makes a second domain of them: the loops see a body of own points and these ghosts. All processes
//! decide together whether a search is due, by the ranges of their displacements. Bonds lead to ghosts of another
//! domain, so that points are compared by their numbers in the whole body.

use std::borrow::Cow;
use std::sync::Arc;

use pericles::PointScalar;
use pericles::domain::{Domain, Peer};

use super::span::Span;
use crate::bodies::Touching;
use crate::vector::V3;

/// The points that take part in the contact of a process: its own ones, followed by points of other processes near them.
///
/// Any two points may touch, so that these ghosts differ from the ghosts of bonds, and change with every search.
#[derive(Debug, Clone)]
pub(super) struct Nearby {
    /// Numbers of all these points, and the exchange of their values.
    domain: Domain,
    /// Their data; `None` if all points are own points.
    touching: Option<Arc<Touching>>,
}

impl Nearby {
    /// Finds the points of other processes closer to own points at `places` than `reach` (m). All processes must call it
    /// together.
    pub(super) fn find(own: &Touching, places: &[V3], reach: f64) -> Self {
        let domain = own.cloud.domain();
        if !domain.is_divided() {
            return Self {
                domain: domain.clone(),
                touching: None,
            };
        }
        let domain = exchanged(domain, places, reach);
        let with_ghosts = |values: &[f64]| domain.with_ghosts(values).into_owned();
        let scalar = |values: &PointScalar| match values {
            PointScalar::PerPoint(values) => PointScalar::PerPoint(with_ghosts(values)),
            uniform => uniform.clone(),
        };
        let pieces: Vec<f64> = own.bodies.piece.iter().map(|&p| f64::from(p)).collect();
        let mut all = own.clone();
        all.bodies.piece = with_ghosts(&pieces).iter().map(|&p| p as u32).collect();
        all.bodies.density = scalar(&own.bodies.density);
        all.size = with_ghosts(&own.size);
        all.stiffness = with_ghosts(&own.stiffness);
        all.cloud = Arc::new(own.cloud.with_ghosts_of(&domain));
        Self {
            domain,
            touching: Some(Arc::new(all)),
        }
    }

    /// Number of own points.
    pub(super) fn own_points(&self) -> usize {
        self.domain.owned_points()
    }

    /// Returns whether own points are numbered as in the whole body, so that they are in the order of their numbers.
    pub(super) fn are_own(&self) -> bool {
        self.touching.is_none()
    }

    /// Number of a point in the whole body.
    #[inline]
    pub(super) fn number(&self, point: u32) -> usize {
        self.domain.number(point as usize)
    }

    /// Returns the data of all points, from the data of own points.
    pub(super) fn touching<'a>(&'a self, own: &'a Touching) -> &'a Touching {
        self.touching.as_deref().unwrap_or(own)
    }

    /// Returns a component-major vector on all points from that on own points. All processes must call it together.
    pub(super) fn vector<'a>(&self, own: &'a [f64]) -> Cow<'a, [f64]> {
        let ghosts = self.domain.ghosts(own);
        if ghosts.is_empty() {
            return Cow::Borrowed(own);
        }
        let (n, m) = (self.own_points(), self.domain.ghost_points());
        let components = own.chunks(n).zip(ghosts.chunks(m));
        Cow::Owned(
            components
                .flat_map(|(own, ghosts)| [own, ghosts].concat())
                .collect(),
        )
    }
}

/// Returns the domain of own points and of the points of others within `reach` (m) of the box of own points.
fn exchanged(own: &Domain, places: &[V3], reach: f64) -> Domain {
    let (comm, n) = (own.comm(), own.owned_points());
    let rank = comm.rank();
    let mut boxes = vec![Span::NOTHING; comm.size()];
    for place in places {
        boxes[rank].add_place(*place);
    }
    Span::agree(&mut boxes, own);
    let near = |other: &Span, one: &Span| one.gap(other) <= reach * reach;
    let ranks =
        (0..comm.size()).filter(|&other| other != rank && near(&boxes[other], &boxes[rank]));
    let ranks: Vec<usize> = ranks.collect();
    let of_peer = |&other: &usize| -> Vec<u32> {
        let theirs = &boxes[other];
        let own = (0..n as u32).filter(|&i| near(theirs, &Span::at(places[i as usize])));
        own.collect()
    };
    let sent: Vec<Vec<u32>> = ranks.iter().map(of_peer).collect();
    let number = |&i: &u32| own.number(i as usize) as f64;
    let messages: Vec<Vec<f64>> = sent
        .iter()
        .map(|one| one.iter().map(number).collect())
        .collect();
    let mut received = vec![Vec::new(); ranks.len()];
    if !ranks.is_empty() {
        comm.exchange(&ranks, &messages, &mut received);
    }
    let mut numbers: Vec<u32> = (0..n).map(|i| own.number(i) as u32).collect();
    let peers = ranks.iter().zip(sent).zip(&received);
    let peers = peers.map(|((&rank, sent), theirs)| {
        let first = numbers.len() - n;
        numbers.extend(theirs.iter().map(|&number| number as u32));
        let received = first..first + theirs.len();
        Peer {
            rank,
            sent,
            received,
        }
    });
    let peers = peers.collect();
    Domain::new(numbers, n, peers, Arc::clone(comm))
}
