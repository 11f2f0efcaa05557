//! [`BondView`] for linear peridynamic solids.

use super::bonds::slot;
use super::force::LinearSolidForce;
use super::kinematics::Kinematics;
use crate::lanes::{F64x8, LANES, dot};
use crate::material::PairForce;
use crate::operator::{BondAt, BondView};
use crate::parallel::components;

impl<L: Kinematics, const D: usize> LinearSolidForce<L, D> {
    /// ξ and η of a bond.
    fn vectors(&self, u: &[&[f64]; D], i: usize, j: usize) -> [[f64; D]; 2] {
        let eta = std::array::from_fn(|c| u[c][slot(j)] - u[c][i]);
        [self.view().vector::<D>(i, j), eta]
    }

    /// p = A θ/m of a point.
    fn pressure(&self, u: &[&[f64]; D], i: usize) -> f64 {
        let family = self.bonds.family(i);
        let intact = family.filter(|&(entry, _)| self.is_intact(i, entry));
        let extension: f64 = intact
            .map(|(entry, j)| {
                let [xi, eta] = self.vectors(u, i, j);
                let weight = self.view().weight_of(entry, [i, j], xi);
                let stretch = L::exact_stretch(strain::<L, D>(xi, eta)).0[0];
                weight * dot(xi, xi) * stretch
            })
            .sum();
        self.states.pressure[i] * self.states.dilatation[i] * extension
    }
}

/// t of a bond.
fn strain<L: Kinematics, const D: usize>(xi: [f64; D], eta: [f64; D]) -> F64x8 {
    let (measure, square) = L::Measure::stretch_measure(xi, eta);
    F64x8([measure / square; LANES])
}

/// The dilatations of a point and its neighbours are computed for each call.
impl<L: Kinematics, const D: usize> BondView for LinearSolidForce<L, D> {
    fn for_each_bond(&self, u: &[f64], i: usize, visit: &mut dyn FnMut(BondAt)) {
        let (bonds, u) = (self.view(), components::<D>(u, self.cloud.len()));
        let spatial =
            |vector: [f64; D]| std::array::from_fn(|c| vector.get(c).copied().unwrap_or(0.0));
        let lanes = |x: f64| F64x8([x; LANES]);
        let pressure = self.pressure(&u, i);
        let family = self.bonds.family(i);
        for (entry, j) in family.filter(|&(entry, _)| self.is_intact(i, entry)) {
            let [xi, eta] = self.vectors(&u, i, j);
            let p = lanes(pressure + self.pressure(&u, j));
            let stiffness = self.states.stiffness[i] + self.states.stiffness[j];
            let s = lanes(bonds.factor_of(entry) * stiffness);
            let pull = L::exact_pull(strain::<L, D>(xi, eta), p, s).0[0];
            let weight = bonds.weight_of(entry, [i, j], xi);
            let direction = L::direction(xi.map(lanes), eta.map(lanes));
            visit(BondAt {
                neighbour: j,
                xi: spatial(xi),
                eta: spatial(eta),
                force: spatial(direction.map(|y| weight * pull * y.0[0])),
            });
        }
    }
}
