//! The other ends of bonds that broke in a sweep over some of the points only.

use crate::domain::Letter;
use crate::family::BondList;
use crate::operator::damage::BlockDamage;

/// Takes the bonds that blocks have noted as broken, and returns for the other end of each its point, the entry that leads back, and the energy that the first end has booked, J. Bonds whose other end belongs to another
/// process are reported to that process, and returned there.
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
