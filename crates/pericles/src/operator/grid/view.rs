//! Access to individual bonds of a lattice body.

use super::force::GridForce;
use crate::operator::fast_law::VectorLaw;
use crate::operator::view::{BondAt, BondValues, BondView};

impl<L: VectorLaw, const D: usize> BondView for GridForce<L, D> {
    fn for_each_bond(&self, values: &BondValues, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let u = values.displacement();
        let (place, left) = self.bonds.bonds_of(i);
        let (chunk, lane) = self.layout().chunk_at(place);
        let stretches = self.latest_stretches();
        for k in left {
            let (offset, stiffness) = (
                &self.doubles.offsets()[k],
                self.stiffness_of(chunk, k, lane),
            );
            let j = self.bonds.form().point_beyond(place, k);
            let eta = u.difference::<D>([i, j]);
            let thermal = stretches.as_ref().map_or(0.0, |of| 0.5 * (of[i] + of[j]));
            let free = offset.xi.map(|x| (1.0 + thermal) * x);
            let pulled = std::array::from_fn(|c| eta[c] - thermal * offset.xi[c]);
            let stiffness = (1.0 + thermal) * stiffness;
            let force = L::force(free, pulled).map(|force| stiffness * force);
            visit(BondAt::new(j, offset.xi, eta, force).of_small_strain(L::LINEAR));
        }
    }

    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let (place, left) = self.bonds.bonds_of(i);
        for k in left {
            let offset = &self.doubles.offsets()[k];
            let j = self.bonds.form().point_beyond(place, k);
            visit(BondAt::undeformed(j, offset.xi));
        }
    }
}
