//! Reverse entries: the bonds of a list seen from their other ends.

use crate::domain::Domain;
use crate::error::{PericlesError, Result};
use crate::lanes::LANES;
use crate::parallel::for_each_point;

use super::BondList;

/// The reverse entry of each entry of a list, for values that the two ends of a bond store separately.
///
/// The reverse entry of a bond to a ghost belongs to the process that owns the ghost. Its place is that of its value
/// behind those of the own entries, as [`ReverseEntries::with_others`] returns them.
#[derive(Default)]
pub(crate) struct ReverseEntries {
    /// Place of the reverse entry of each entry; that of the entry itself for padding.
    places: Vec<u32>,
    /// Own entries whose values each peer needs, in the order in which it reads them.
    sent: Vec<Vec<u32>>,
    /// Number of entries of other processes.
    received: usize,
}

/// A directed bond: numbers of its first and last point in the whole body, and the periods by which the last one is moved.
/// The order of these keys does not depend on the process.
type Key = (usize, [i16; 3], usize);

/// A bond between two processes.
struct Across {
    entry: u32,
    forth: Key,
    back: Key,
}

impl ReverseEntries {
    /// Finds the reverse entries of a list. All processes must call it together.
    ///
    /// # Errors
    /// More than 4.29e9 entries on one of the processes.
    pub fn new(bonds: &BondList) -> Result<Self> {
        let (sites, own) = (bonds.sites(), bonds.len());
        let domain = sites.cloud().domain();
        let is_beyond = |site: usize| sites.point(site) >= own;
        let entries = bonds.present().len() * LANES;
        let of_point = |i: usize| bonds.family(i).filter(|&(_, b)| is_beyond(b)).count();
        let received: usize = match domain.ghost_points() {
            0 => 0,
            _ => (0..own).map(of_point).sum(),
        };
        let most = domain.max((entries + received) as f64);
        if most > f64::from(u32::MAX) {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of directed bonds with history",
                value: most,
                allowed: "at most 4.29e9",
            });
        }
        let back = |i: usize, site: usize| {
            let shift = opposite(sites.shift(site));
            let mut family = bonds.family(sites.point(site));
            let found = family.find(|&(_, b)| sites.point(b) == i && sites.shift(b) == shift);
            found.map(|(entry, _)| entry)
        };
        let of_points = for_each_point(own, &|i| {
            let groups = bonds.groups(i);
            let mut places: Vec<u32> = (groups.start * LANES..groups.end * LANES)
                .map(|entry| entry as u32)
                .collect();
            for (entry, site) in bonds.family(i).filter(|&(_, b)| !is_beyond(b)) {
                if let Some(found) = back(i, site) {
                    places[entry - groups.start * LANES] = found as u32;
                }
            }
            places
        });
        let mut reverse = Self {
            places: of_points.concat(),
            sent: Vec::new(),
            received,
        };
        reverse.find_others(bonds, entries);
        Ok(reverse)
    }

    /// Finds the entries of bonds between processes: both sort them by the same keys.
    fn find_others(&mut self, bonds: &BondList, entries: usize) {
        let (sites, own) = (bonds.sites(), bonds.len());
        let domain = sites.cloud().domain();
        let mut across: Vec<Vec<Across>> = domain.peers().iter().map(|_| Vec::new()).collect();
        if across.is_empty() {
            return;
        }
        for i in 0..own {
            for (entry, site) in bonds.family(i) {
                let j = sites.point(site);
                let Some(ghost) = j.checked_sub(own) else {
                    continue;
                };
                let shift = sites.shift(site);
                let [here, there] = [i, j].map(|k| domain.number(k));
                let mut peers = domain.peers().iter().zip(&mut across);
                if let Some((_, across)) = peers.find(|(peer, _)| peer.received.contains(&ghost)) {
                    across.push(Across {
                        entry: entry as u32,
                        forth: (here, shift, there),
                        back: (there, opposite(shift), here),
                    });
                }
            }
        }
        let mut next = entries as u32;
        for mut across in across {
            across.sort_unstable_by_key(|bond| bond.forth);
            self.sent
                .push(across.iter().map(|bond| bond.entry).collect());
            across.sort_unstable_by_key(|bond| bond.back);
            for bond in across {
                self.places[bond.entry as usize] = next;
                next += 1;
            }
        }
    }

    /// Place of the reverse entry of each entry; that of the entry itself for padding.
    #[inline(always)]
    pub fn places(&self) -> &[u32] {
        &self.places
    }

    /// Returns the values of own entries, followed by those of the reverse entries of other processes. All processes must
    /// call it together.
    pub fn with_others(&self, domain: &Domain, of_entries: &[f64]) -> Vec<f64> {
        let mut values = Vec::with_capacity(of_entries.len() + self.received);
        values.extend_from_slice(of_entries);
        values.extend(domain.exchange_places(&self.sent, of_entries));
        values
    }

    /// Number of values of [`ReverseEntries::with_others`].
    pub fn with_others_len(&self) -> usize {
        self.places.len() + self.received
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        let sent = self.sent.iter().map(|places| size_of_val(&places[..]));
        size_of_val(&self.places[..]) + sent.sum::<usize>()
    }
}

fn opposite(shift: [i16; 3]) -> [i16; 3] {
    shift.map(|periods| -periods)
}
