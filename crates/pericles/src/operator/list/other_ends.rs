//! Other ends of bonds that broke in a sweep over a subset of points.

use crate::domain::Letter;
use crate::family::BondList;
use crate::operator::damage::BlockDamage;

/// Clears the recorded broken bonds of blocks and returns, for the other end of each, its point, the reverse
/// entry and the energy recorded for the first end, J. A bond whose other end belongs to another process is
/// sent to that process and returned there.
pub fn other_ends(bonds: &BondList, blocks: &mut [BlockDamage]) -> Vec<(usize, usize, f64)> {
    let sites = bonds.sites();
    let mut letters = Vec::new();
    for block in blocks {
        for event in block.tally.events.drain(..) {
            let site = bonds.neighbour(event.entry);
            let [x, y, z] = sites.shift(site).map(|periods| -f64::from(periods));
            letters.push(Letter {
                from: event.point as usize,
                to: sites.point(site),
                numbers: [event.dissipated, x, y, z],
            });
        }
    }
    let letters = sites.cloud().domain().deliver(letters);
    let found = |letter: &Letter| {
        let [dissipated, x, y, z] = letter.numbers;
        let leads_back = |&(_, site): &(usize, usize)| {
            sites.point(site) == letter.from && sites.shift(site).map(f64::from) == [x, y, z]
        };
        let (back, _) = bonds.family(letter.to).find(leads_back)?;
        Some((letter.to, back, dissipated))
    };
    letters.iter().filter_map(found).collect()
}
