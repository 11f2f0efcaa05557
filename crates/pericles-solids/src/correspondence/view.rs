//! Views of bonds and plastic strain of correspondence bodies, for output.

use pericles::domain::Field;
use pericles::operator::{BondAt, BondView, PlasticView};

use super::bonds::Bond;
use super::force::CorrespondenceForce;

/// The accumulated plastic strain ∫ √(2/3 d_p : d_p) dt.
impl<const D: usize> PlasticView for CorrespondenceForce<D> {
    fn plastic_strain_into(&self, out: &mut [f64]) {
        for (i, strain) in out.iter_mut().enumerate() {
            *strain = self.plastic_strain(i);
        }
    }
}

/// Each call computes the deformation gradients of a point and its neighbours.
impl<const D: usize> BondView for CorrespondenceForce<D> {
    fn has_forces(&self) -> bool {
        !self.cloud.domain().is_divided()
    }

    fn for_each_bond(&self, u: Field<'_>, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let (heat, sites) = (self.latest_heat(), self.bonds.list.sites());
        let state = |k: usize| {
            let eta = |bond: &Bond<D>| u.difference::<D>([k, sites.point(bond.site)]);
            self.state_of(k, &self.shapes[k], &eta, &heat).0
        };
        let own = state(i);
        self.bonds.for_each(i, self.bits(i), |bond: Bond<D>| {
            let j = sites.point(bond.site);
            let eta = u.difference::<D>([i, j]);
            let mut force = [0.0; D];
            own.add_force(&state(j), &bond, &eta, &mut force);
            visit(BondAt::new(j, bond.xi, eta, force));
        });
    }

    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let sites = self.bonds.list.sites();
        self.bonds.for_each(i, self.bits(i), |bond: Bond<D>| {
            visit(BondAt::undeformed(sites.point(bond.site), bond.xi));
        });
    }
}
