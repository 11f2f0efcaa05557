//! Pairs of points that may touch soon: candidates for contact.

use rayon::prelude::*;

use pericles::domain::Domain;
use pericles::neighbourhood::BondSet;
use pericles::operator::Force;
use pericles::parallel::{BLOCK, for_each_point};

use super::Pieces;
use super::cells::Cells;
use super::nearby::Nearby;
use super::ranges::Ranges;
use crate::bodies::Touching;
use crate::law::ContactPairs;
use crate::vector::{dot, minus};

/// Pairs closer than the contact distance plus a skin at the time of the search. While no point moves relative to another
/// by more than the skin, they contain all pairs in contact.
///
/// Rows contain both ends of each pair, in ascending order, so that forces do not depend on the list: candidates that do
/// not touch add nothing. The list is therefore not part of a checkpoint. Of several processes each has the rows of its own
/// points.
#[derive(Debug, Clone)]
pub(super) struct Candidates {
    /// Own points, and points of other processes near them.
    nearby: Nearby,
    /// First entry of each row.
    starts: Vec<usize>,
    near: Vec<u32>,
    /// Whether the pair of an entry may touch: not for pairs with an intact bond.
    open: Vec<bool>,
    /// Points with an open entry, ascending.
    exposed: Vec<u32>,
    ranges: Ranges,
    /// Numbers of bonds that broke so far, for the ranges of points of the forces.
    broken: Vec<u64>,
}

/// The internal forces' list of bonds, if contact depends on it.
fn bonds<'a>(touching: &Touching, forces: &'a dyn Force) -> Option<&'a dyn BondSet> {
    match touching.law.pairs {
        ContactPairs::Unbonded => forces.bond_set(),
        ContactPairs::Pieces | ContactPairs::All => None,
    }
}

impl Candidates {
    /// Searches all pairs of own points at displacement u. All processes must call it together.
    pub(super) fn search(
        own: &Touching,
        pieces: &Pieces,
        u: &[f64],
        skin: f64,
        forces: &dyn Force,
    ) -> Self {
        let (n, dimension) = (own.cloud.len(), own.cloud.dimension());
        let domain = own.cloud.domain();
        let mut places = for_each_point(n, &|i| own.place(u, i));
        let largest = domain.max(own.size.iter().copied().fold(0.0, f64::max));
        let reach = own.law.distance * largest;
        let ranges = Ranges::new(pieces, (domain, dimension), (&places, u), skin, reach);
        let most = reach + skin;
        let nearby = Nearby::find(own, &places, most);
        let touching = nearby.touching(own);
        let all = nearby.vector(u);
        places.extend((n..touching.cloud.len()).map(|i| touching.place(&all, i)));
        let cells = Cells::new(&places, dimension, most);
        let of_block = |block: usize| {
            let (mut near, mut lengths) = (Vec::new(), Vec::new());
            for i in block * BLOCK..((block + 1) * BLOCK).min(n) {
                let first = near.len();
                cells.visit(places[i], |other| {
                    let apart = minus(other.place, places[i]);
                    let (square, j) = (dot(apart, apart), other.point as usize);
                    if square < most * most && j != i && may_touch(touching, [i, j], square, skin) {
                        near.push(other.point);
                    }
                });
                match nearby.are_own() {
                    true => near[first..].sort_unstable(),
                    false => near[first..].sort_unstable_by_key(|&j| nearby.number(j)),
                }
                lengths.push(near.len() - first);
            }
            (near, lengths)
        };
        let blocks: Vec<_> = (0..n.div_ceil(BLOCK))
            .into_par_iter()
            .map(of_block)
            .collect();
        let (mut starts, mut near) = (Vec::with_capacity(n + 1), Vec::new());
        starts.push(0);
        for (own, lengths) in blocks {
            for length in lengths {
                starts.push(starts[starts.len() - 1] + length);
            }
            near.extend(own);
        }
        let mut candidates = Self {
            open: vec![bonds(own, forces).is_none(); near.len()],
            nearby,
            starts,
            near,
            exposed: Vec::new(),
            ranges,
            broken: Vec::new(),
        };
        if let Some(bonds) = bonds(own, forces) {
            bonds.for_each_change_count(&mut |_, count| candidates.broken.push(count));
            candidates.close_bonded(own, forces, std::slice::from_ref(&(0..n)));
        }
        candidates.find_exposed();
        candidates
    }

    /// Returns whether the lists of all processes contain all pairs in contact at displacement u. All processes must call it
    /// together.
    pub(super) fn contains_contacts(&self, u: &[f64], domain: &Domain) -> bool {
        self.ranges.are_kept(u, domain)
    }

    /// The points in the rows: own points and points of other processes near them.
    pub(super) fn nearby(&self) -> &Nearby {
        &self.nearby
    }

    /// Returns whether bonds broke since the list was last brought up to date.
    pub(super) fn is_behind(&self, touching: &Touching, forces: &dyn Force) -> bool {
        let (mut k, mut same) = (0, true);
        if let Some(bonds) = bonds(touching, forces) {
            bonds.for_each_change_count(&mut |_, count| {
                same &= self.broken.get(k) == Some(&count);
                k += 1;
            });
        }
        !same
    }

    /// Opens the pairs whose bonds have broken.
    pub(super) fn follow_breaks(&mut self, touching: &Touching, forces: &dyn Force) {
        let Some(bonds) = bonds(touching, forces) else {
            return;
        };
        let (mut k, mut changed) = (0, Vec::new());
        bonds.for_each_change_count(&mut |range, count| {
            if self.broken[k] != count {
                self.broken[k] = count;
                changed.push(range);
            }
            k += 1;
        });
        self.close_bonded(touching, forces, &changed);
        self.find_exposed();
    }

    /// Decides for the rows of ranges of points which pairs are open. Pairs that are open remain so: bonds do not heal.
    fn close_bonded(
        &mut self,
        touching: &Touching,
        forces: &dyn Force,
        ranges: &[std::ops::Range<usize>],
    ) {
        let blocks: Vec<std::ops::Range<usize>> = ranges
            .iter()
            .flat_map(|range| {
                let end = range.end;
                range
                    .clone()
                    .step_by(BLOCK)
                    .map(move |first| first..(first + BLOCK).min(end))
            })
            .collect();
        let (starts, near, before) = (&self.starts, &self.near, &self.open);
        // Points of other processes have other places among the ghosts of the bonds: the numbers in the whole body are common.
        let (domain, nearby) = (touching.cloud.domain(), &self.nearby);
        let of_block = |block: &std::ops::Range<usize>| {
            let mut open = before[starts[block.start]..starts[block.end]].to_vec();
            if let Some(bonds) = bonds(touching, forces) {
                for i in block.clone() {
                    let row = &near[starts[i]..starts[i + 1]];
                    let own = starts[i] - starts[block.start];
                    let own = &mut open[own..own + row.len()];
                    let (Some(&low), Some(&high)) = (row.first(), row.last()) else {
                        continue;
                    };
                    if !own.contains(&false) {
                        continue;
                    }
                    own.fill(true);
                    let [low, high] = [low, high].map(|j| nearby.number(j));
                    bonds.for_each_intact_of(i, &mut |j| {
                        let j = domain.number(j);
                        if (low..=high).contains(&j)
                            && let Ok(k) = row.binary_search_by_key(&j, |&k| nearby.number(k))
                        {
                            own[k] = false;
                        }
                    });
                }
            }
            open
        };
        let found: Vec<Vec<bool>> = blocks.par_iter().map(of_block).collect();
        for (block, open) in blocks.iter().zip(found) {
            self.open[self.starts[block.start]..self.starts[block.end]].copy_from_slice(&open);
        }
    }

    fn find_exposed(&mut self) {
        let exposed = |&i: &u32| {
            let row = self.starts[i as usize]..self.starts[i as usize + 1];
            self.open[row].contains(&true)
        };
        let n = self.starts.len() as u32 - 1;
        self.exposed = (0..n).into_par_iter().filter(exposed).collect();
    }

    /// Own points that may touch others, ascending.
    pub(super) fn exposed(&self) -> &[u32] {
        &self.exposed
    }

    /// Points that may touch point i, ascending.
    #[inline]
    pub(super) fn row(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        let row = self.starts[i]..self.starts[i + 1];
        let entries = self.near[row.clone()].iter().zip(&self.open[row]);
        entries.filter(|(_, open)| **open).map(|(j, _)| *j as usize)
    }

    /// Number of open entries: each pair that may touch is counted once for each own point.
    pub(super) fn entries(&self) -> u64 {
        self.open.iter().filter(|open| **open).count() as u64
    }
}

/// Returns whether two points at a distance with the square `square` (m²) may touch before they have moved relative to
/// each other by the skin (m).
fn may_touch(touching: &Touching, [i, j]: [usize; 2], square: f64, skin: f64) -> bool {
    let reach = touching.law.distance * 0.5 * (touching.size[i] + touching.size[j]) + skin;
    let piece = &touching.bodies.piece;
    let wanted = touching.law.pairs != ContactPairs::Pieces || piece[i] != piece[j];
    wanted && square < reach * reach
}
