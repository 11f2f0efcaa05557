//! Reverse entries of bonds, for values of bonds that both ends read.

use pericles::domain::Letter;
use pericles::family::BondList;
use pericles::lanes::LANES;
use pericles::neighbourhood::{BreakEvent, Form};
use pericles::parallel::for_each_point;
use pericles::{PericlesError, Result};

/// Places of the values of reverse entries in an array with the values of own entries, followed by those of ghosts.
///
/// A process sends the values of all bonds of its points near other processes, as many for each point as the largest family
/// has entries.
#[derive(Default)]
pub(super) struct Opposites {
    /// The place of the reverse entry of each own entry; padding is its own reverse entry.
    of_entry: Vec<u32>,
    /// Values sent per point; zero for bodies that are not divided among processes.
    width: usize,
    ghosts: usize,
}

impl Opposites {
    /// Finds the reverse entries of a list. All processes must call it together.
    ///
    /// # Errors
    /// More than 4.29e9 directed bonds.
    pub fn new(list: &BondList) -> Result<Self> {
        let (entries, sites) = (list.present().len() * LANES, list.sites());
        let domain = sites.cloud().domain();
        let families = (0..list.len()).map(|i| list.groups(i).len() * LANES);
        let (width, ghosts) = match domain.is_divided() {
            true => {
                let largest = domain.max(families.max().unwrap_or(0) as f64);
                (largest as usize, domain.ghost_points())
            }
            false => (0, 0),
        };
        let places = entries + width * ghosts;
        domain.agreed(match u32::try_from(places) {
            Ok(_) => Ok(()),
            Err(_) => Err(PericlesError::OutOfRange {
                quantity: "the number of directed bonds with history",
                value: places as f64,
                allowed: "at most 4.29e9",
            }),
        })?;
        let back = |i: usize, site: usize| {
            let shift = sites.shift(site).map(|periods| -periods);
            let mut family = list.family(sites.point(site));
            let found = family.find(|&(_, b)| sites.point(b) == i && sites.shift(b) == shift);
            found.map(|(entry, _)| entry)
        };
        let of_points = for_each_point(list.len(), &|i| {
            let groups = list.groups(i);
            let own = groups.start * LANES..groups.end * LANES;
            let mut places: Vec<u32> = own.map(|entry| entry as u32).collect();
            for (entry, site) in list.family(i) {
                if sites.point(site) < list.len()
                    && let Some(found) = back(i, site)
                {
                    places[entry - groups.start * LANES] = found as u32;
                }
            }
            places
        });
        let mut of_entry = of_points.concat();
        // The owner of the other end learns the position of the entry among those of the point.
        let mut letters: Vec<Letter> = Vec::new();
        for i in 0..list.len() {
            let first = list.groups(i).start * LANES;
            for (entry, site) in list.family(i) {
                if sites.point(site) >= list.len() {
                    letters.push(list.letter(&BreakEvent {
                        point: i as u32,
                        entry,
                        dissipated: (entry - first) as f64,
                    }));
                }
            }
        }
        for letter in domain.deliver(letters) {
            if let Some(place) = list.place_of(&letter) {
                let position = letter.numbers[0] as usize;
                let place_of_value = entries + position * ghosts + (letter.from - list.len());
                of_entry[list.entry_at(place)] = place_of_value as u32;
            }
        }
        Ok(Self {
            of_entry,
            width,
            ghosts,
        })
    }

    /// Returns the place of the reverse entry of each entry.
    #[inline(always)]
    pub fn of_entry(&self) -> &[u32] {
        &self.of_entry
    }

    /// Returns the number of values of own entries and of ghosts.
    pub fn places(&self) -> usize {
        self.of_entry.len() + self.width * self.ghosts
    }

    /// Returns the number of values sent per point.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Sets the values of ghosts. All processes must call it together.
    pub fn exchange(&self, list: &BondList, values: &mut [f64]) {
        if self.width == 0 {
            return;
        }
        let n = list.len();
        let (own, of_ghosts) = values.split_at_mut(self.of_entry.len());
        let mut sent = vec![0.0; self.width * n];
        for i in 0..n {
            let groups = list.groups(i);
            let numbers = &own[groups.start * LANES..groups.end * LANES];
            for (position, number) in numbers.iter().enumerate() {
                sent[position * n + i] = *number;
            }
        }
        of_ghosts.copy_from_slice(&list.sites().cloud().domain().ghosts(&sent));
    }
}
