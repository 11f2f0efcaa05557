//! Bonds of a body in the layout of the loops.

use pericles::family::BondList;
use pericles::kernel::Influence;
use pericles::lanes::{LANES, Lanes, Row};
use pericles::neighbourhood::{DamageMeasure, Form, Neighbourhood};
use pericles::parallel::for_each_point;
use pericles::saved;

/// A bond list with positions and weights.
pub(super) struct Bonds {
    pub all: Neighbourhood<BondList>,
    /// Positions in units of `unit`; on a lattice integer coordinates, so that equal bonds have bitwise equal vectors.
    reference: Vec<Row>,
    unit: [f64; 3],
    /// ω by entry.
    weight: Vec<f64>,
    /// w by entry; empty if no material reads it.
    influence: Vec<f64>,
}

saved! {
    impl Checkpointed for Bonds {
        all: part,
        reference, unit, weight, influence: fixed,
    }
}

impl Bonds {
    /// Creates the layout of a list; `reads_influence` states whether a material reads w.
    pub fn new(
        list: BondList,
        damage: DamageMeasure,
        (influence, horizon): (&Influence, f64),
        reads_influence: bool,
    ) -> Self {
        let places = list.sites().places();
        let row = |site: usize| {
            let [x, y, z] = match places.lattice() {
                Some(lattice) => lattice.coordinates(lattice.node[site]).map(f64::from),
                None => places.point(site),
            };
            Row([x, y, z, 0.0])
        };
        let reference = (0..places.len()).map(row).collect();
        let unit = places.lattice().map_or([1.0; 3], |lattice| lattice.spacing);
        let by_entry = |of_bond: &(dyn Fn(usize, usize) -> f64 + Sync)| -> Vec<f64> {
            let of_point = for_each_point(list.len(), &|i| {
                let mut row = vec![0.0; list.groups(i).len() * LANES];
                let (first, a) = (list.groups(i).start * LANES, list.site(i));
                for (entry, b) in list.family(i) {
                    row[entry - first] = of_bond(a, b);
                }
                row
            });
            of_point.concat()
        };
        let alpha = |a: usize, b: usize| influence.alpha_of(list.vector(a, b), horizon);
        Self {
            weight: by_entry(&|a, b| alpha(a, b) * list.volume_factor(a, b) * list.volume(b)),
            influence: match reads_influence {
                true => by_entry(&alpha),
                false => Vec::new(),
            },
            reference,
            unit,
            all: Neighbourhood::new(list, damage),
        }
    }

    /// The families.
    #[inline(always)]
    pub fn list(&self) -> &BondList {
        self.all.form()
    }

    /// Positions of all sites in units of [`Bonds::unit`].
    #[inline(always)]
    pub fn reference(&self) -> &[Row] {
        &self.reference
    }

    /// The unit of positions along each axis, m.
    #[inline(always)]
    pub fn unit(&self) -> &[f64; 3] {
        &self.unit
    }

    /// Returns ω of a group.
    #[inline(always)]
    pub fn weight<T: Lanes>(&self, group: usize) -> T {
        T::load(&self.weight, group * LANES)
    }

    /// Returns w of a group.
    #[inline(always)]
    pub fn influence<T: Lanes>(&self, group: usize) -> T {
        match self.influence.is_empty() {
            true => T::splat(0.0),
            false => T::load(&self.influence, group * LANES),
        }
    }

    /// Returns ω of an entry.
    pub fn weight_of(&self, entry: usize) -> f64 {
        self.weight[entry]
    }

    /// Returns ξ between two sites, m.
    pub fn vector<const D: usize>(&self, [a, b]: [usize; 2]) -> [f64; D] {
        let (from, to) = (&self.reference[a], &self.reference[b]);
        std::array::from_fn(|c| (to[c] - from[c]) * self.unit[c])
    }

    /// Returns the memory, bytes.
    pub fn bytes(&self) -> usize {
        let numbers = size_of_val(&self.weight[..]) + size_of_val(&self.influence[..]);
        Form::bytes(self.list()) + numbers + size_of_val(&self.reference[..])
    }
}
