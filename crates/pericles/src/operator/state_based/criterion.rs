//! Bond failure by stress and strain.
//!
//! The stress of a point follows from its own force state, σ_i = Σ_j t_ij (y/|y|) ⊗ y b V_j over its intact bonds. Its
//! trace is exact for a uniform dilatation at every point, free surfaces included, because the weighted volume is that
//! of the same bonds; broken bonds bear no stress. The strain is the symmetric part of the displacement gradient that
//! fits the intact bonds best, (Σ ω η ⊗ ξ)(Σ ω ξ ⊗ ξ)⁻¹, less the thermal stretch.
//!
//! Both tensors need the displacements of the neighbours of a point only, so that a step can end for a subset.

use rayon::prelude::*;

use super::bonds::difference;
use super::breaking::{BreakRule, direction, take_bonds};
use super::force::LinearSolidForce;
use super::kinematics::Kinematics;
use super::view::force_of_bond;
use crate::domain::Field;
use crate::lanes::LANES;
use crate::material::{BondPlace, BondState, PairForce};
use crate::operator::PointSubset;
use crate::operator::records::Records;
use crate::parallel::BLOCK;
use crate::solve::inverse;
use crate::step_end::StepEnd;

/// Force states of points, P and S: the pull of a bond of a point is P + S ψ.
pub(super) type ForceStates = [[f64; 2]];

impl<L: Kinematics, const D: usize> LinearSolidForce<L, D> {
    /// Returns whether bonds can break by stress or strain.
    pub(super) fn has_criteria(&self) -> bool {
        !self.classes.criteria().is_empty()
    }

    /// Returns the force states for these dilatations and thermal pulls, which are empty for a
    /// body that is not heated.
    pub(super) fn elastic_states(&self, dilatations: &[f64], pulls: &[f64]) -> Vec<[f64; 2]> {
        let states = &self.states;
        let of_point = |(i, theta): (usize, &f64)| {
            let (site, pull) = (self.bonds.form().site(i), pulls.get(i).copied());
            let pull = states.pressure[site] * theta + pull.unwrap_or(0.0);
            [pull, states.stiffness[site]]
        };
        dilatations.iter().enumerate().map(of_point).collect()
    }

    /// Returns stress and strain of the points `on`, 2 D² components; see [`BondState::between`].
    pub(super) fn tensors(
        &self,
        u: &Records,
        on: &PointSubset<'_>,
        stretches: Option<&[f64]>,
        states: &ForceStates,
    ) -> Vec<f64> {
        let n = self.cloud.len();
        let mut points = Vec::with_capacity(on.count(n));
        on.for_each(n, |i| points.push(i));
        let of_point = |&i: &usize| {
            let thermal = stretches.map_or(0.0, |stretches| stretches[i]);
            self.tensors_of(u, i, thermal, states)
        };
        let found: Vec<[[[f64; D]; D]; 2]> = points
            .par_iter()
            .with_min_len(BLOCK / 2)
            .map(of_point)
            .collect();
        let mut all = vec![0.0; 2 * D * D * n];
        for (i, tensors) in points.into_iter().zip(found) {
            for (slot, value) in tensors.iter().flatten().flatten().enumerate() {
                all[slot * n + i] = *value;
            }
        }
        all
    }

    /// Returns stress and strain of a point; no strain if its bonds do not span the space.
    fn tensors_of(
        &self,
        u: &Records,
        i: usize,
        thermal: f64,
        states: &ForceStates,
    ) -> [[[f64; D]; D]; 2] {
        let (bonds, here) = (self.view(), self.bonds.form().site(i));
        let [p, s] = states[i];
        let mut stress = [[0.0; D]; D];
        let (mut shape, mut moment) = ([[0.0; 3]; 3], [[0.0; D]; D]);
        for (entry, b) in self.bonds.intact_of(i) {
            let (xi, eta) = (bonds.vector::<D>(here, b), difference::<D>(u, here, b));
            let weight = bonds.weight_of(entry, [here, b], xi);
            let pull = [p, s * bonds.factor_of(entry)];
            let force = force_of_bond::<L, D>(weight, pull, xi, eta);
            let along = direction::<L, D>(xi, eta);
            for a in 0..D {
                for c in 0..D {
                    stress[a][c] += force[a] * along[c];
                    shape[a][c] += weight * (xi[a] * xi[c]);
                    moment[a][c] += weight * (eta[a] * xi[c]);
                }
            }
        }
        let size = (0..D).map(|c| shape[c][c]).sum::<f64>();
        for (c, row) in shape.iter_mut().enumerate().skip(D) {
            row[c] = size;
        }
        let mut strain = [[0.0; D]; D];
        if let Some(inverse) = inverse(&shape) {
            let entry =
                |a: usize, c: usize| (0..D).map(|k| moment[a][k] * inverse[k][c]).sum::<f64>();
            for a in 0..D {
                for c in 0..D {
                    strain[a][c] = 0.5 * (entry(a, c) + entry(c, a));
                }
                strain[a][a] -= thermal;
            }
        }
        [stress, strain]
    }

    /// Returns the failure index of the bond of an entry from point i to a site.
    fn index_of(
        &self,
        tensors: Field<'_>,
        u: &Records,
        stretches: Option<&[f64]>,
        [i, b]: [usize; 2],
    ) -> f64 {
        let (a, sites) = (self.bonds.form().site(i), self.bonds.form().sites());
        self.classes.failure_index(a, b, || {
            let mut xi = self.view().vector::<D>(a, b);
            let mut eta = difference::<D>(u, a, b);
            if L::LINEAR {
                // The linearised motion of a bond is its extension along the reference direction.
                let (measure, square) = L::Measure::stretch_measure(xi, eta);
                eta = xi.map(|x| measure / square * x);
            }
            let j = sites.point(b);
            if let Some(stretches) = stretches {
                let thermal = 0.5 * (stretches[i] + stretches[j]);
                eta = std::array::from_fn(|c| eta[c] - thermal * xi[c]);
                xi = xi.map(|x| (1.0 + thermal) * x);
            }
            let tensor = |slot: usize, point: usize| tensors.entry(2 * D * D, slot, point);
            BondState::between::<D>(tensor, [i, j], [xi, eta], BondPlace::default())
        })
    }

    /// Returns the entries of a point whose failure index exceeds `limit`, one byte per group.
    fn beyond(
        &self,
        tensors: Field<'_>,
        u: &Records,
        stretches: Option<&[f64]>,
        i: usize,
        limit: f64,
    ) -> Option<Vec<u8>> {
        let groups = self.bonds.form().groups(i);
        let mut broken: Option<Vec<u8>> = None;
        for (entry, b) in self.bonds.intact_of(i) {
            if self.bonds.form().may_break(entry)
                && self.index_of(tensors, u, stretches, [i, b]) > limit
            {
                let broken = broken.get_or_insert_with(|| vec![0; groups.len()]);
                broken[entry / LANES - groups.start] |= 1 << (entry % LANES);
            }
        }
        broken
    }

    /// Returns the elastic force states at a displacement and the time of the last force evaluation.
    pub(super) fn latest_states(&self, u: Field<'_>) -> Vec<[f64; 2]> {
        let mut dilatations = vec![0.0; self.cloud.len()];
        self.dilatations_into(u, &PointSubset::All, &mut dilatations);
        let pulls = self.latest_stretches().map(|stretches| {
            let pull = |i: usize| self.thermal_pull(i, stretches[i]);
            (0..self.cloud.len()).map(pull).collect::<Vec<f64>>()
        });
        self.elastic_states(&dilatations, &pulls.unwrap_or_default())
    }

    /// Marks the points with a bond whose failure index exceeds `limit`.
    pub(super) fn mark_by_criterion(
        &self,
        u: Field<'_>,
        states: &ForceStates,
        limit: f64,
        marks: &mut [bool],
    ) {
        let u = &self.packed(u);
        let latest = self.latest_stretches();
        let stretches = latest.as_ref().map(|stretches| &stretches[..]);
        let own = self.tensors(u, &PointSubset::All, stretches, states);
        let ghosts = self.cloud.domain().ghosts(&own);
        let tensors = Field::new(&own, &ghosts);
        marks.par_iter_mut().enumerate().for_each(|(i, mark)| {
            *mark = *mark || self.beyond(tensors, u, stretches, i, limit).is_some();
        });
    }

    /// Breaks the bonds of the points `on` whose failure index exceeds one. `states` belong to the points `needed`.
    /// Returns whether a bond of this process may have broken.
    pub(super) fn break_by_criterion(
        &mut self,
        step: &StepEnd<'_>,
        u: Field<'_>,
        [on, needed]: [&PointSubset<'_>; 2],
        states: &ForceStates,
    ) -> bool {
        let n = self.cloud.len();
        let heated = self.stretches(step.t);
        let stretches = heated.as_ref().map(|stretches| &stretches[..]);
        let moved = step.ghost_velocities(self.cloud.domain());
        let rows = self.packed(u);
        let own = self.tensors(&rows, needed, stretches, states);
        let ghosts = self.cloud.domain().ghosts(&own);
        let tensors = Field::new(&own, &ghosts);
        let mut points = Vec::with_capacity(on.count(n));
        on.for_each(n, |i| points.push(i));
        let of_point = |&i: &usize| Some((i, self.beyond(tensors, &rows, stretches, i, 1.0)?));
        let found: Vec<(usize, Vec<u8>)> = points.par_iter().filter_map(of_point).collect();
        drop(rows);
        // In a sweep over a subset of points other processes report broken bonds to this one.
        let none = match on {
            PointSubset::All => found.is_empty(),
            _ => self.cloud.domain().all(found.is_empty()),
        };
        if none {
            return false;
        }
        let counts = self.broken_by_blocks();
        let mut blocks = self.bonds.take_blocks();
        let rule = BreakRule {
            stretches,
            ..self.rule(step, step.velocities(&moved), on)
        };
        let (bonds, u) = (self.view(), self.packed(u));
        for (i, broken) in found {
            let block = &mut blocks[i / BLOCK];
            let intact = &mut block.intact[self.bonds.form().groups_in_block(i)];
            take_bonds::<L, D>(&bonds, &rule, &u, i, intact, &broken, &mut block.tally);
        }
        self.clear_other_ends(&rule, &u, &mut blocks);
        drop(u);
        self.bonds.put_blocks(blocks);
        self.renew_volumes(counts);
        true
    }
}
