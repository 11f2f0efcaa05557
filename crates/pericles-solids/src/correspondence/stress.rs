//! Bond failure by stress.
//!
//! A bond breaks when the normal stress n·σ n in the direction n of the deformed bond exceeds the tensile
//! strength, where σ is the mean Cauchy stress of its end points. For bonds along the axis of the largest
//! principal stress this is the Rankine criterion, so that cracks open across that axis.

use pericles::domain::Field;
use pericles::lanes::Row;
use pericles::operator::PointSubset;
use pericles::operator::rows::Rows;
use pericles::parallel::{BLOCK, for_each_point};
use rayon::prelude::*;

use super::breaking::Entries;
use super::force::CorrespondenceForce;
use super::heat::Heat;
use super::tensor::{combination, determinant, in_space, product, transpose, unit};

impl<const D: usize> CorrespondenceForce<D> {
    /// Returns the Cauchy stress σ = P Fᵀ/J of all own points, component-major with D² components, Pa.
    fn cauchy_stresses(&self, rows: &[Row], heat: &Heat) -> Vec<f64> {
        let n = self.cloud.len();
        let stresses = for_each_point(n, &|i| {
            let gradient = self.gradient(i, &self.shapes[i].inverse, &self.etas(i, rows));
            let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
            let solid = self.classes.solid(i).expanded(heat.factor(i));
            let state = solid.stress(&f, &self.history_of(i));
            let volume = determinant(&in_space(&f, state.across));
            let stress = product(&state.stress, &transpose(&f));
            stress.map(|row| row.map(|entry| entry / volume))
        });
        let mut all = vec![0.0; D * D * n];
        for (i, stress) in stresses.iter().enumerate() {
            for a in 0..D {
                for b in 0..D {
                    all[(a * D + b) * n + i] = stress[a][b];
                }
            }
        }
        all
    }

    /// Returns the entries of the points `on` whose bonds exceed `fraction` of their tensile strength.
    pub(super) fn over_stressed(
        &self,
        rows: &[Row],
        on: &PointSubset<'_>,
        heat: &Heat,
        fraction: f64,
    ) -> Entries {
        let n = self.cloud.len();
        let own = self.cauchy_stresses(rows, heat);
        let ghosts = self.cloud.domain().ghosts(&own);
        let (stress, sites) = (Field::new(&own, &ghosts), self.bonds.list.sites());
        let of_block = |block: usize| {
            let first = block * BLOCK;
            let mut found = Entries::new();
            let Some(wanted) = Rows::of_block(on, first, BLOCK.min(n - first)) else {
                return found;
            };
            for i in (0..wanted.count()).map(|k| wanted.at(k)) {
                let here = self.bonds.list.site(i);
                self.bonds.for_each::<D>(i, self.bits(i), |bond| {
                    let eta = Self::eta(rows, here, &bond);
                    let along: [f64; D] = std::array::from_fn(|c| bond.xi[c] + eta[c]);
                    let j = sites.point(bond.site);
                    let (mut pull, mut square) = (0.0, 0.0);
                    for a in 0..D {
                        square += along[a] * along[a];
                        for b in 0..D {
                            let of = |point| stress.entry(D * D, a * D + b, point);
                            pull += 0.5 * (of(i) + of(j)) * (along[a] * along[b]);
                        }
                    }
                    let strength = self.limits.strength(here, bond.site);
                    if self.may_break(bond.entry) && pull > fraction * strength * square {
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
