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
}

saved! {
    impl Checkpointed for Bonds {
        all: part,
        reference, unit, weight: fixed,
    }
}

impl Bonds {
    pub fn new(list: BondList, damage: DamageMeasure, influence: &Influence, horizon: f64) -> Self {
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
        let of_point = for_each_point(list.len(), &|i| {
            let mut row = vec![0.0; list.groups(i).len() * LANES];
            let (first, a) = (list.groups(i).start * LANES, list.site(i));
            for (entry, b) in list.family(i) {
                let alpha = influence.alpha_of(list.vector(a, b), horizon);
                row[entry - first] = alpha * list.volume_factor(a, b) * list.volume(b);
            }
            row
        });
        Self {
            weight: of_point.concat(),
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
        Form::bytes(self.list()) + size_of_val(&self.weight[..]) + size_of_val(&self.reference[..])
    }
}
