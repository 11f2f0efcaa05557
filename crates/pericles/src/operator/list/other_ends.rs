//! The other ends of bonds that broke in a sweep over some of the points only.

use crate::domain::Letter;
use crate::family::BondList;
use crate::operator::damage::BlockDamage;

/// Takes the events of blocks and finds the other end of each bond: its point, the entry that leads back, and the energy booked at the first end, J. Ends that other processes own are told them.
pub fn other_ends(bonds: &BondList, blocks: &mut [BlockDamage]) -> Vec<(usize, usize, f64)> {
    let sites = bonds.sites();
    let (n, domain) = (sites.cloud().len(), sites.cloud().domain());
    let (mut here, mut away) = (Vec::new(), Vec::new());
    for block in blocks {
        for event in block.tally.events.drain(..) {
            let site = bonds.neighbour(event.entry);
            let [x, y, z] = sites.shift(site).map(|periods| -f64::from(periods));
            let letter = Letter {
                from: event.point as usize,
                to: sites.point(site),
                numbers: [event.dissipated, x, y, z],
            };
            match letter.to.checked_sub(n) {
                None => here.push(letter),
                Some(ghost) => away.push(Letter {
                    to: ghost,
                    ..letter
                }),
            }
        }
    }
    here.extend(domain.deliver(&away).into_iter().map(|letter| Letter {
        from: n + letter.from,
        ..letter
    }));
    let found = |letter: &Letter| {
        let [dissipated, x, y, z] = letter.numbers;
        let leads_back = |&(_, site): &(usize, usize)| {
            sites.point(site) == letter.from && sites.shift(site).map(f64::from) == [x, y, z]
        };
        let (back, _) = bonds.family(letter.to).find(leads_back)?;
        Some((letter.to, back, dissipated))
    };
    here.iter().filter_map(found).collect()
}
