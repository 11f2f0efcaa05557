//! Views of bonds and plastic strain of correspondence bodies, for output.

use pericles::domain::Field;
use pericles::operator::{BondAt, BondValues, BondView, PlasticView, PointSubset, StressView};

use super::bonds::{Bond, Values};
use super::force::CorrespondenceForce;

/// The accumulated plastic strain ∫ √(2/3 d_p : d_p) dt.
impl<const D: usize> PlasticView for CorrespondenceForce<D> {
    fn plastic_strain_into(&self, out: &mut [f64]) {
        for (i, strain) in out.iter_mut().enumerate() {
            *strain = self.plastic_strain(i);
        }
    }
}

impl<const D: usize> StressView for CorrespondenceForce<D> {
    fn stresses(&self, u: &[f64]) -> Vec<[[f64; 3]; 3]> {
        let ghosts = self.cloud.domain().ghosts(u);
        self.cauchy_stresses(Field::new(u, &ghosts))
    }
}

/// The values of points come from the pass over points, with the temperature of the last force evaluation.
impl<const D: usize> BondView for CorrespondenceForce<D> {
    fn values_at(&self, u: Field<'_>) -> BondValues {
        let mut values = vec![0.0; self.value_count() * self.cloud.len()];
        self.values_with(&self.latest_heat(), u, &PointSubset::All, &mut values);
        BondValues::of_points(u, values, self.cloud.domain())
    }

    fn for_each_bond(&self, values: &BondValues, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let (count, sites) = (self.value_count(), self.bonds.list().sites());
        let (u, points) = (values.displacement(), values.points());
        let own = Values::read::<D>(points, count, i);
        self.bonds.for_each(i, self.bits(i), |bond: Bond<D>| {
            let j = sites.point(bond.site);
            let eta = u.difference::<D>([i, j]);
            let mut force = [0.0; D];
            own.add_force(&Values::read(points, count, j), &bond, &eta, &mut force);
            visit(BondAt::new(j, bond.xi, eta, force));
        });
    }

    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let sites = self.bonds.list().sites();
        self.bonds.for_each(i, self.bits(i), |bond: Bond<D>| {
            visit(BondAt::undeformed(sites.point(bond.site), bond.xi));
        });
    }
}
