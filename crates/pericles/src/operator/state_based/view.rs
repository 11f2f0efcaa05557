//! [`BondView`] for linear peridynamic solids.

use super::force::LinearSolidForce;
use super::kinematics::Kinematics;
use crate::domain::Field;
use crate::lanes::{F64x8, LANES, dot};
use crate::material::PairForce;
use crate::operator::{BondAt, BondValues, BondView};
use crate::parallel::for_each_point;

impl<L: Kinematics, const D: usize> LinearSolidForce<L, D> {
    /// Returns ξ and η of the bond from point i to a site.
    fn vectors(&self, u: Field<'_>, i: usize, site: usize) -> [[f64; D]; 2] {
        let eta = u.difference::<D>([i, self.bonds.form().sites().point(site)]);
        [
            self.view().vector::<D>(self.bonds.form().site(i), site),
            eta,
        ]
    }

    /// Returns p = A θ/m of a point with its thermal pull at the time of the last force evaluation.
    fn pressure_of(&self, u: Field<'_>, i: usize) -> f64 {
        let here = self.bonds.form().site(i);
        let extension: f64 = self
            .bonds
            .intact_of(i)
            .map(|(entry, b)| {
                let [xi, eta] = self.vectors(u, i, b);
                let weight = self.view().weight_of(entry, [here, b], xi);
                weighted_extension::<L, D>(weight, xi, eta)
            })
            .sum();
        let latest = self.latest_stretches();
        let thermal = latest.map_or(0.0, |stretches| self.thermal_pull(i, stretches[i]));
        self.states.pressure[here] * self.states.dilatation[i] * extension + thermal
    }
}

/// Returns the strain t of a bond.
fn strain<L: Kinematics, const D: usize>(xi: [f64; D], eta: [f64; D]) -> F64x8 {
    let (measure, square) = L::Measure::stretch_measure(xi, eta);
    F64x8([measure / square; LANES])
}

/// Returns ω r e of a bond with the weight ω.
pub(super) fn weighted_extension<L: Kinematics, const D: usize>(
    weight: f64,
    xi: [f64; D],
    eta: [f64; D],
) -> f64 {
    let stretch = L::exact_stretch(strain::<L, D>(xi, eta)).0[0];
    weight * dot(xi, xi) * stretch
}

/// Returns the force density of a bond with the weight ω from p and s, each summed over both ends.
pub(super) fn force_of_bond<L: Kinematics, const D: usize>(
    weight: f64,
    [p, s]: [f64; 2],
    xi: [f64; D],
    eta: [f64; D],
) -> [f64; D] {
    let lanes = |x: f64| F64x8([x; LANES]);
    let pull = L::exact_pull(strain::<L, D>(xi, eta), lanes(p), lanes(s)).0[0];
    let direction = L::direction(xi.map(lanes), eta.map(lanes));
    direction.map(|y| weight * pull * y.0[0])
}

/// The values of points are p = A θ/m with thermal pulls.
impl<L: Kinematics, const D: usize> BondView for LinearSolidForce<L, D> {
    fn values_at(&self, u: Field<'_>) -> BondValues {
        let pressures = for_each_point(self.cloud.len(), &|i| self.pressure_of(u, i));
        BondValues::of_points(u, pressures, self.cloud.domain())
    }

    fn for_each_bond(&self, values: &BondValues, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let (bonds, here) = (self.view(), self.bonds.form().site(i));
        let (u, pressures) = (values.displacement(), values.points());
        for (entry, b) in self.bonds.intact_of(i) {
            let j = self.bonds.form().sites().point(b);
            let [xi, eta] = self.vectors(u, i, b);
            let p = pressures.at::<1>(0, i) + pressures.at::<1>(0, j);
            let stiffness = self.states.stiffness[here] + self.states.stiffness[b];
            let s = bonds.factor_of(entry) * stiffness;
            let weight = bonds.weight_of(entry, [here, b], xi);
            let force = force_of_bond::<L, D>(weight, [p, s], xi, eta);
            visit(BondAt::new(j, xi, eta, force).of_small_strain(L::LINEAR));
        }
    }

    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let (bonds, here) = (self.view(), self.bonds.form().site(i));
        for (_, b) in self.bonds.intact_of(i) {
            let xi = bonds.vector::<D>(here, b);
            visit(BondAt::undeformed(self.bonds.form().sites().point(b), xi));
        }
    }
}
