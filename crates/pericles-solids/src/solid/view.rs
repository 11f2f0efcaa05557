//! Bonds, plastic strains and stresses of state-based bodies, for output.

use pericles::domain::Field;
use pericles::lanes::{F64x8, LANES};
use pericles::operator::{
    BondAt, BondValues, BondView, Kinematics, PlasticView, PointSubset, StressView,
};

use super::family::{Bond, SingleBond};
use super::loops::end_of;
use super::{Solid, SolidForce};

impl<S: Solid<D>, const D: usize> PlasticView for SolidForce<S, D> {
    fn plastic_strain_into(&self, out: &mut [f64]) {
        for (i, strain) in out.iter_mut().enumerate() {
            let own = self.material(i).plastic_strain(self.history.of_point(i));
            *strain = own.unwrap_or(0.0);
        }
    }
}

/// The stress at the temperature of the last force evaluation.
impl<S: Solid<D>, const D: usize> StressView for SolidForce<S, D> {
    fn stresses(&self, u: &[f64]) -> Vec<[[f64; 3]; 3]> {
        let ghosts = self.cloud.domain().ghosts(u);
        let rows = self.packed(Field::new(u, &ghosts));
        let all = self.tensors(self.latest_time(), &rows, &self.latest_heat());
        let spatial = |[stress, _]: &[[[f64; D]; D]; 2]| {
            std::array::from_fn(|a| {
                std::array::from_fn(|b| {
                    let row = stress.get(a);
                    row.and_then(|row| row.get(b)).copied().unwrap_or(0.0)
                })
            })
        };
        all.iter().map(spatial).collect()
    }
}

/// Returns a single bond in all lanes.
pub(super) fn in_lanes<const D: usize>(bond: &SingleBond<D>) -> Bond<F64x8, D> {
    let lanes = |x: f64| F64x8([x; LANES]);
    let square: f64 = bond.xi.iter().map(|x| x * x).sum();
    Bond {
        xi: bond.xi.map(lanes),
        eta: bond.eta.map(lanes),
        weight: lanes(bond.weight),
        square: lanes(square),
        inverse_square: lanes(1.0 / square),
    }
}

/// The values of points come from the pass over points, at the temperature of the last force evaluation.
impl<S: Solid<D>, const D: usize> BondView for SolidForce<S, D> {
    fn values_at(&self, u: Field<'_>) -> BondValues {
        let (heat, rows) = (self.latest_heat(), self.packed(u));
        let states = self.states(self.latest_time(), &heat, &rows, None, &PointSubset::All);
        let (own, ghosts) = self.exchanged(&states.values);
        BondValues {
            of_points: own,
            of_ghosts: ghosts,
            of_bonds: states.of_bonds.clone(),
            ..BondValues::of_displacement(u)
        }
    }

    fn for_each_bond(&self, values: &BondValues, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let sites = self.bonds.list().sites();
        let (u, points) = (values.displacement(), values.points());
        let end = |point: usize, entry: Option<&u32>| {
            let numbers: Vec<f64> = (0..S::VALUES)
                .map(|number| points.entry(S::VALUES, number, point))
                .collect();
            let of_bond = entry.map_or(0.0, |&entry| values.of_bonds[entry as usize]);
            end_of(&numbers, F64x8([of_bond; LANES]))
        };
        for (entry, site) in self.bonds.all.intact_of(i) {
            let j = sites.point(site);
            let bond = SingleBond {
                entry,
                site,
                eta: u.difference::<D>([i, j]),
                xi: self.bonds.vector([sites.of_point(i), site]),
                weight: self.bonds.weight_of(entry),
            };
            let back = self.opposite.of_entry().get(entry);
            let forth = back.map(|_| entry as u32);
            let lanes = in_lanes(&bond);
            let here = S::pull(&end(i, forth.as_ref()), &lanes);
            let there = S::pull(&end(j, back), &lanes);
            let force = std::array::from_fn(|c| bond.weight * (here[c].0[0] + there[c].0[0]));
            let at = BondAt::new(j, bond.xi, bond.eta, force);
            visit(at.of_small_strain(S::Kinematics::LINEAR));
        }
    }

    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let sites = self.bonds.list().sites();
        for (_, site) in self.bonds.all.intact_of(i) {
            let xi = self.bonds.vector::<D>([sites.of_point(i), site]);
            let at = BondAt::undeformed(sites.point(site), xi);
            visit(at.of_small_strain(S::Kinematics::LINEAR));
        }
    }
}
