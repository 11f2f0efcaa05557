//! [`BondView`] for linear peridynamic solids on a lattice.

use super::force::LinearSolidGrid;
use crate::domain::Field;
use crate::operator::state_based::kinematics::Kinematics;
use crate::operator::state_based::view::{force_of_bond, weighted_extension};
use crate::operator::{BondAt, BondValues, BondView};
use crate::parallel::for_each_point;

impl<L: Kinematics, const D: usize> LinearSolidGrid<L, D> {
    /// Returns p = A θ/m of a point with its thermal pull at the time of the last force evaluation.
    fn pressure_of(&self, u: Field<'_>, i: usize) -> f64 {
        let (place, left) = self.bonds.bonds_of(i);
        let extension: f64 = left
            .map(|k| {
                let offset = &self.offsets[k];
                let eta = u.difference::<D>([i, self.bonds.form().point_beyond(place, k)]);
                weighted_extension::<L, D>(offset.weight, offset.xi, eta)
            })
            .sum();
        let thermal = self.heat.as_ref().map_or(0.0, |heat| {
            heat.pull(&self.states, [i, i], heat.expansion.latest()[i])
        });
        self.states.pressure[i] * self.states.dilatation[i] * extension + thermal
    }
}

/// The values of points are p = A θ/m with thermal pulls.
impl<L: Kinematics, const D: usize> BondView for LinearSolidGrid<L, D> {
    fn values_at(&self, u: Field<'_>) -> BondValues {
        let pressures = for_each_point(self.cloud.len(), &|i| self.pressure_of(u, i));
        BondValues::of_points(u, pressures, self.cloud.domain())
    }

    fn for_each_bond(&self, values: &BondValues, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let (u, pressures) = (values.displacement(), values.points());
        let (place, left) = self.bonds.bonds_of(i);
        for k in left {
            let offset = &self.offsets[k];
            let j = self.bonds.form().point_beyond(place, k);
            let eta = u.difference::<D>([i, j]);
            let p = pressures.at::<1>(0, i) + pressures.at::<1>(0, j);
            let s = self.states.stiffness[i] + self.states.stiffness[j];
            let force = force_of_bond::<L, D>(offset.weight, [p, s], offset.xi, eta);
            visit(BondAt::new(j, offset.xi, eta, force).of_small_strain(L::LINEAR));
        }
    }

    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let (place, left) = self.bonds.bonds_of(i);
        for k in left {
            let j = self.bonds.form().point_beyond(place, k);
            visit(BondAt::undeformed(j, self.offsets[k].xi));
        }
    }
}
