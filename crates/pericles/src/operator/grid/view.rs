//! The bonds of a lattice body one by one.

use super::force::GridForce;
use crate::domain::Field;
use crate::operator::fast_law::FastLaw;
use crate::operator::view::{BondAt, BondView};

impl<L: FastLaw, const D: usize> BondView for GridForce<L, D> {
    fn for_each_bond(&self, u: Field<'_>, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let place = self.layout.place_of(i);
        let (chunk, lane) = self.layout.chunk_at(place);
        let block = self.layout.block_of(chunk);
        let offsets = self.stencil.offsets();
        let first = (chunk - self.layout.chunks_of(block).start) * offsets.len();
        let intact = &self.blocks[block].intact[first..first + offsets.len()];
        let spatial =
            |vector: [f64; D]| std::array::from_fn(|c| vector.get(c).copied().unwrap_or(0.0));
        let left = offsets.iter().zip(intact).enumerate();
        for (k, (offset, _)) in left.filter(|(_, (_, bits))| **bits >> lane & 1 == 1) {
            let stiffness = self.stiffness_of(chunk, k, lane);
            let j = self
                .layout
                .point_at(place.wrapping_add_signed(offset.shift));
            let eta = u.difference::<D>([i, j]);
            let force = L::force(offset.xi, eta).map(|force| stiffness * force);
            visit(BondAt {
                neighbour: j,
                xi: spatial(offset.xi),
                eta: spatial(eta),
                force: spatial(force),
            });
        }
    }
}
