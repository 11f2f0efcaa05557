//! Bond failure by stress and strain.
//!
//! A bond breaks when its failure index exceeds one, a function of the mean Cauchy stress and of the mean strain of its
//! end points ([`BondCriterion`](pericles::material::BondCriterion)). The strain is the symmetric part of F − I, less
//! the thermal stretch.

use pericles::domain::Field;
use pericles::lanes::Row;
use pericles::material::BondState;
use pericles::operator::PointSubset;
use pericles::operator::rows::Rows;
use pericles::parallel::{BLOCK, for_each_point};
use rayon::prelude::*;

use super::breaking::Entries;
use super::force::CorrespondenceForce;
use super::heat::Heat;
use super::tensor::{combination, determinant, in_space, product, symmetric, transpose, unit};

impl<const D: usize> CorrespondenceForce<D> {
    /// Returns the Cauchy stress σ = P Fᵀ/J and the strain of all own points, component-major with 2 D² components;
    /// see [`BondState::between`].
    fn tensors(&self, rows: &[Row], heat: &Heat) -> Vec<f64> {
        let n = self.cloud.len();
        let tensors = for_each_point(n, &|i| {
            let gradient = self.gradient(i, &self.shapes[i].inverse, &self.etas(i, rows));
            let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
            let solid = self.classes.solid(i).expanded(heat.factor(i));
            let state = solid.stress(&f, &self.history_of(i));
            let volume = determinant(&in_space(&f, state.across));
            let stress = product(&state.stress, &transpose(&f));
            let thermal = heat.factor(i) - 1.0;
            let strain = combination(1.0, &symmetric(&gradient), -thermal, &unit::<D>());
            [stress.map(|row| row.map(|entry| entry / volume)), strain]
        });
        let mut all = vec![0.0; 2 * D * D * n];
        for (i, tensors) in tensors.iter().enumerate() {
            for (slot, value) in tensors.iter().flatten().flatten().enumerate() {
                all[slot * n + i] = *value;
            }
        }
        all
    }

    /// Returns the Cauchy stress of own points, with the temperature of the last force evaluation.
    pub(super) fn cauchy_stresses(&self, u: Field<'_>) -> Vec<[[f64; 3]; 3]> {
        let tensors = self.tensors(&self.packed(u), &self.latest_heat());
        let n = self.cloud.len();
        let of_point = |i: usize| {
            std::array::from_fn(|a| {
                std::array::from_fn(|b| match a < D && b < D {
                    true => tensors[(a * D + b) * n + i],
                    false => 0.0,
                })
            })
        };
        (0..n).map(of_point).collect()
    }

    /// Returns the entries of the points `on` whose failure index exceeds `limit`.
    pub(super) fn over_stressed(
        &self,
        rows: &[Row],
        on: &PointSubset<'_>,
        heat: &Heat,
        limit: f64,
    ) -> Entries {
        let n = self.cloud.len();
        let own = self.tensors(rows, heat);
        let ghosts = self.cloud.domain().ghosts(&own);
        let (tensors, sites) = (Field::new(&own, &ghosts), self.bonds.list().sites());
        let tensor = |slot: usize, point: usize| tensors.entry(2 * D * D, slot, point);
        let of_block = |block: usize| {
            let first = block * BLOCK;
            let mut found = Entries::new();
            let Some(wanted) = Rows::of_block(on, first, BLOCK.min(n - first)) else {
                return found;
            };
            for i in (0..wanted.count()).map(|k| wanted.at(k)) {
                let here = self.bonds.list().site(i);
                self.bonds.for_each::<D>(i, self.bits(i), |bond| {
                    let state = || {
                        let eta = Self::eta(rows, here, &bond);
                        let (xi, eta) = heat.expanded(sites, [here, bond.site], bond.xi, eta);
                        let ends = [i, sites.point(bond.site)];
                        BondState::between::<D>(tensor, ends, [xi, eta])
                    };
                    let over = self.limits.failure_index(here, bond.site, state) > limit;
                    if over && self.bonds.list().may_break(bond.entry) {
                        found.push((i, bond.entry));
                    }
                });
            }
            found
        };
        let blocks: Vec<Entries> = (0..n.div_ceil(BLOCK))
            .into_par_iter()
            .map(of_block)
            .collect();
        blocks.concat()
    }
}
