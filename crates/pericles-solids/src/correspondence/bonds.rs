//! Bonds of a correspondence body in the layout of the loops.

use pericles::domain::Field;
use pericles::family::BondList;
use pericles::kernel::Influence;
use pericles::lanes::{LANES, Row};
use pericles::neighbourhood::{DamageMeasure, Form, Neighbourhood};
use pericles::parallel::for_each_point;
use pericles::saved;
use pericles::space::Sites;
use rayon::prelude::*;

use super::control::Control;
use super::tensor::Matrix;

/// A bond of a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bond<const D: usize> {
    /// Entry of the bond in the list.
    pub entry: usize,
    /// Site of the other end point.
    pub site: usize,
    /// ξ, m.
    pub xi: [f64; D],
    /// ω = w b V of the other end point, m³ for a dimensionless w.
    pub weight: f64,
}

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

    /// Returns the families.
    #[inline(always)]
    pub fn list(&self) -> &BondList {
        self.all.form()
    }

    /// Returns ξ between two sites, m.
    #[inline(always)]
    pub fn vector<const D: usize>(&self, a: usize, b: usize) -> [f64; D] {
        let (from, to) = (&self.reference[a], &self.reference[b]);
        std::array::from_fn(|c| (to[c] - from[c]) * self.unit[c])
    }

    /// Calls `visit` for each bond of a point whose bit is set in `intact`, the bytes of its groups.
    #[inline(always)]
    pub fn for_each<const D: usize>(
        &self,
        i: usize,
        intact: &[u8],
        mut visit: impl FnMut(Bond<D>),
    ) {
        let (groups, here) = (self.list().groups(i), self.list().site(i));
        for (&bits, group) in intact.iter().zip(groups) {
            if bits == 0 {
                continue;
            }
            let neighbours = self.list().group(group);
            for (lane, &site) in neighbours.iter().enumerate() {
                if bits >> lane & 1 == 1 {
                    let entry = group * LANES + lane;
                    visit(Bond {
                        entry,
                        site,
                        xi: self.vector(here, site),
                        weight: self.weight[entry],
                    });
                }
            }
        }
    }

    /// Returns the memory, bytes.
    pub fn bytes(&self) -> usize {
        Form::bytes(self.list()) + size_of_val(&self.weight[..]) + size_of_val(&self.reference[..])
    }
}

/// Values of an end point that the force of a bond depends on.
#[derive(Debug, Clone, Copy)]
pub(super) struct SiteState<const D: usize> {
    /// P K⁻¹ − Z (F − I)
    pub push: Matrix<D>,
    pub control: Control<D>,
}

impl<const D: usize> Default for SiteState<D> {
    fn default() -> Self {
        Self {
            push: [[0.0; D]; D],
            control: Control::NONE,
        }
    }
}

impl<const D: usize> SiteState<D> {
    /// Adds ω [(sum of both pushes) ξ + (sum of both controls) η] of a bond.
    #[inline(always)]
    pub fn add_force(&self, there: &Self, bond: &Bond<D>, eta: &[f64; D], out: &mut [f64; D]) {
        let (near, far) = (self.control.apply(eta), there.control.apply(eta));
        for a in 0..D {
            let mut pull = near[a] + far[a];
            for b in 0..D {
                pull += (self.push[a][b] + there.push[a][b]) * bond.xi[b];
            }
            out[a] += bond.weight * pull;
        }
    }
}

/// Layout of the values per point of the pass over points.
pub(super) struct Values;

impl Values {
    /// Returns the number of values: D² of the push, the dilatation, and 1 or D (D + 1)/2 of the control.
    pub fn count<const D: usize>(tensor: bool) -> usize {
        D * D + 1 + if tensor { D * (D + 1) / 2 } else { 1 }
    }

    /// Returns the slot of the dilatation.
    pub const fn dilatation<const D: usize>() -> usize {
        D * D
    }

    /// Returns the value of a point in a slot.
    pub fn slot<const D: usize>(state: &SiteState<D>, dilatation: f64, slot: usize) -> f64 {
        if slot < D * D {
            return state.push[slot / D][slot % D];
        }
        if slot == D * D {
            return dilatation;
        }
        match (&state.control, places::<D>().nth(slot - D * D - 1)) {
            (Control::Tensor(z), Some((a, b))) => z[a][b],
            (Control::Scalar(z), Some((a, b))) if a == b => *z,
            _ => 0.0,
        }
    }

    /// Reads the values of a point or ghost.
    pub fn read<const D: usize>(values: Field<'_>, count: usize, point: usize) -> SiteState<D> {
        let at = |slot: usize| values.entry(count, slot, point);
        let mut push = [[0.0; D]; D];
        for (slot, entry) in push.iter_mut().flatten().enumerate() {
            *entry = at(slot);
        }
        let control = if count == D * D + 2 {
            Control::Scalar(at(D * D + 1))
        } else {
            let mut z = [[0.0; D]; D];
            for (slot, (a, b)) in places::<D>().enumerate() {
                z[a][b] = at(D * D + 1 + slot);
                z[b][a] = z[a][b];
            }
            Control::Tensor(z)
        };
        SiteState { push, control }
    }
}

/// Returns row and column of the components of a symmetric tensor, the diagonal first.
fn places<const D: usize>() -> impl Iterator<Item = (usize, usize)> {
    let diagonal = (0..D).map(|a| (a, a));
    diagonal.chain((0..D).flat_map(|a| (a + 1..D).map(move |b| (a, b))))
}

/// Reads the states of all sites.
pub(super) fn read_sites<const D: usize>(
    values: Field<'_>,
    count: usize,
    sites: &Sites,
    states: &mut [SiteState<D>],
) {
    const PART: usize = 1024;
    states
        .par_chunks_mut(PART)
        .enumerate()
        .for_each(|(part, states)| {
            for (site, state) in (part * PART..).zip(states) {
                *state = Values::read(values, count, sites.point(site));
            }
        });
}
