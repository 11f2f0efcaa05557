//! Stress and strain of points, and bond failure by them.
//!
//! A bond breaks when its failure index exceeds one, a function of the mean Cauchy stress and of the mean strain of its
//! end points ([`BondCriterion`](pericles::material::BondCriterion)). The strain is the symmetric part of the
//! displacement gradient (Σ ω η ⊗ ξ) K⁻¹ that fits the intact bonds best, less the thermal stretch.

use pericles::domain::Field;
use pericles::lanes::{F64x8, LANES, Row};
use pericles::material::{BondPlace, BondState};
use pericles::operator::{Kinematics, PointSubset};
use pericles::parallel::for_each_point;

use super::breaking::Entries;
use super::family::{Point, SingleBond};
use super::heat::Heat;
use super::loops::for_each_pull;
use super::shape::ShapeTensor;
use super::view::in_lanes;
use super::{Solid, SolidForce, State};
use crate::tensor::{Matrix, combination, product, symmetric, unit};

/// Returns Σ ω T ⊗ y over the intact bonds of a point, with y = ξ + η, or ξ for linear kinematics.
pub(super) fn stress_of_force_state<S: Solid<D> + ?Sized, const D: usize>(
    material: &S,
    at: &Point<'_, S::Shape, D>,
) -> Matrix<D> {
    let mut stress = [[F64x8([0.0; LANES]); D]; D];
    let set_state = |out: &mut State<'_>| {
        material.state::<F64x8>(at, out);
    };
    for_each_pull::<S, D>(at, set_state, |_, bond, pull| {
        let along = S::Kinematics::direction(bond.xi, bond.eta);
        for a in 0..D {
            for b in 0..D {
                stress[a][b] = stress[a][b] + bond.weight * pull[a] * along[b];
            }
        }
    });
    stress.map(|row| row.map(F64x8::sum))
}

impl<S: Solid<D>, const D: usize> SolidForce<S, D> {
    /// Returns the Cauchy stress and the strain of all own points.
    pub(super) fn tensors(&self, t: f64, rows: &[Row], heat: &Heat) -> Vec<[Matrix<D>; 2]> {
        for_each_point(self.cloud.len(), &|i| {
            let Some(at) = self.point(i, t, heat, rows) else {
                return [[[0.0; D]; D]; 2];
            };
            let factor = self.stiffness_of(i);
            let stress = self.material(i).stress(&at);
            let stress = stress.map(|row| row.map(|entry| factor * entry));
            let inverse = ShapeTensor::of(&at.family).inverse();
            let strain = inverse.map_or([[0.0; D]; D], |inverse| {
                let gradient = product(&at.family.moment::<F64x8>(&at.family), &inverse);
                combination(1.0, &symmetric(&gradient), -at.thermal, &unit::<D>())
            });
            [stress, strain]
        })
    }

    /// Returns the entries of the points `on` whose failure index exceeds `limit`. All processes must call it together.
    pub(super) fn over_stressed(
        &self,
        t: f64,
        rows: &[Row],
        on: &PointSubset<'_>,
        heat: &Heat,
        limit: f64,
    ) -> Entries {
        let n = self.cloud.len();
        let mut own = vec![0.0; 2 * D * D * n];
        for (i, tensors) in self.tensors(t, rows, heat).iter().enumerate() {
            for (slot, value) in tensors.iter().flatten().flatten().enumerate() {
                own[slot * n + i] = *value;
            }
        }
        let ghosts = self.cloud.domain().ghosts(&own);
        let (tensors, sites) = (Field::new(&own, &ghosts), self.bonds.list().sites());
        let tensor = |slot: usize, point: usize| tensors.entry(2 * D * D, slot, point);
        let varies = self.materials.criteria().vary();
        let expansion = self.expansion.as_ref().filter(|_| varies);
        let temperatures = expansion.map(|expansion| expansion.temperatures(t));
        let place_of = |bond: &SingleBond<D>, ends: [usize; 2], t: f64| {
            let mut place = self.cloud.point(ends[0]);
            for (x, xi) in place.iter_mut().zip(bond.xi) {
                *x += 0.5 * xi;
            }
            let mean = |all: &Vec<f64>| 0.5 * (all[ends[0]] + all[ends[1]]);
            BondPlace {
                place,
                t,
                temperature: temperatures.as_ref().map_or(0.0, mean),
            }
        };
        self.entries_of(on, |i, found| {
            let family = self.family(i, rows);
            let here = family.site();
            family.for_each(|bond| {
                let state = || {
                    let eta = self.motion(bond);
                    let j = sites.point(bond.site);
                    let at = match varies {
                        true => place_of(bond, [i, j], t),
                        false => BondPlace::default(),
                    };
                    let (xi, eta) = heat.expanded(sites, [here, bond.site], bond.xi, eta);
                    BondState::between::<D>(tensor, [i, j], [xi, eta], at)
                };
                let over = self.materials.failure_index(here, bond.site, state) > limit;
                if over && self.bonds.list().may_break(bond.entry) {
                    found.push((i, bond.entry));
                }
            });
        })
    }

    /// Returns η of a bond; for linear kinematics its part along the bond.
    fn motion(&self, bond: &SingleBond<D>) -> [f64; D] {
        if !S::Kinematics::LINEAR {
            return bond.eta;
        }
        let stretch = in_lanes(bond).stretch::<S::Kinematics>().0[0];
        bond.xi.map(|x| stretch * x)
    }
}
