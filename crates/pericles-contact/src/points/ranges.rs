//! How far points have moved relative to each other since a search.

use rayon::prelude::*;

use pericles::domain::Domain;
use pericles::parallel::BLOCK;

use super::Pieces;
use super::span::Span;
use crate::vector::V3;

/// Pieces that are followed separately; a body with more of them is followed as one.
const MOST: usize = 8;

/// Displacements at the time of a search, and how far pieces may move relative to each other before pairs in contact may
/// be missing from its result.
#[derive(Debug, Clone)]
pub(super) struct Ranges {
    u: Vec<f64>,
    /// Piece of each point; empty if all points are followed as one.
    piece: Vec<u32>,
    pieces: usize,
    points: usize,
    dimension: usize,
    /// Squares of the allowed relative displacements of two pieces, m².
    allowed: Vec<f64>,
}

impl Ranges {
    /// Starts to follow the points from displacement u, where a search has found all pairs closer than the contact
    /// distance, at most `reach`, plus `skin`. Pieces far apart may approach each other by more than the skin. All
    /// processes must call it together.
    pub(super) fn new(
        pieces: &Pieces,
        (domain, dimension): (&Domain, usize),
        (places, u): (&[V3], &[f64]),
        skin: f64,
        reach: f64,
    ) -> Self {
        let one = pieces.count > MOST || pieces.count <= 1;
        let mut ranges = Self {
            u: u.to_vec(),
            piece: if one {
                Vec::new()
            } else {
                pieces.of_point.clone()
            },
            pieces: if one { 1 } else { pieces.count },
            points: places.len(),
            dimension,
            allowed: Vec::new(),
        };
        let mut boxes = vec![Span::NOTHING; ranges.pieces];
        for (i, place) in places.iter().enumerate() {
            boxes[ranges.piece_of(i)].add_place(*place);
        }
        Span::agree(&mut boxes, domain);
        for p in 0..ranges.pieces {
            for q in 0..ranges.pieces {
                let free = boxes[p].gap(&boxes[q]).sqrt() - reach;
                let most = if p == q { skin } else { free.max(skin) };
                ranges.allowed.push(most * most);
            }
        }
        ranges
    }

    fn piece_of(&self, i: usize) -> usize {
        self.piece.get(i).map_or(0, |piece| *piece as usize)
    }

    /// Returns whether no point has moved too far relative to another at displacement u: the same for all processes, which
    /// must call it together.
    pub(super) fn are_kept(&self, u: &[f64], domain: &Domain) -> bool {
        let (n, dimension) = (self.points, self.dimension);
        let of_block = |block: usize| {
            let mut spans = [Span::NOTHING; MOST];
            let own = block * BLOCK..((block + 1) * BLOCK).min(n);
            for c in 0..dimension {
                let (now, then) = (&u[c * n..(c + 1) * n], &self.u[c * n..(c + 1) * n]);
                if self.piece.is_empty() {
                    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
                    for (now, then) in now[own.clone()].iter().zip(&then[own.clone()]) {
                        let moved = now - then;
                        low = if moved < low { moved } else { low };
                        high = if moved > high { moved } else { high };
                    }
                    spans[0].add(c, low);
                    spans[0].add(c, high);
                } else {
                    for i in own.clone() {
                        spans[self.piece[i] as usize].add(c, now[i] - then[i]);
                    }
                }
            }
            spans
        };
        let nothing = || [Span::NOTHING; MOST];
        let merged = |mut a: [Span; MOST], b: [Span; MOST]| {
            a.iter_mut().zip(&b).for_each(|(a, b)| a.merge(b));
            a
        };
        let blocks = (0..n.div_ceil(BLOCK)).into_par_iter();
        let mut spans = blocks.map(of_block).reduce(nothing, merged);
        Span::agree(&mut spans[..self.pieces], domain);
        let pairs = (0..self.pieces).flat_map(|p| (p..self.pieces).map(move |q| [p, q]));
        let mut pairs = pairs.map(|[p, q]| {
            let apart = spans[p].spread(&spans[q], dimension);
            apart <= self.allowed[p * self.pieces + q]
        });
        pairs.all(|kept| kept)
    }
}
