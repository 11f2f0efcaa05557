//! [`ForceOperator`] for bond lists.

use rayon::prelude::*;

use super::force::BondForce;
use super::kernels::{energy_rows, force_rows, tangent_rows};
use crate::lanes::LANES;
use crate::operator::fast_law::FastLaw;
use crate::operator::{
    Accepted, BondAt, BondView, CoarseBreak, ForceOperator, InstructionSet, LatticeSprings,
    LinearOperator, On, ZonedForce, damage,
};
use crate::parallel::{BLOCK, components, ordered_sum};

impl<L: FastLaw, const D: usize> ForceOperator for BondForce<L, D> {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        D
    }

    fn add_force(&self, _t: f64, u: &[f64], on: On<'_>, out: &mut [f64]) {
        let bonds = self.view();
        self.with_packed(u, &on, |u| {
            self.sweep::<D>(&on, out, |intact, rows, out| {
                force_rows::<L, D>(self.instruction_set, &bonds, u, intact, rows, out);
            });
        });
    }

    fn add_energy_density(&self, _t: f64, u: &[f64], out: &mut [f64]) {
        let bonds = self.view();
        self.with_packed(u, &On::All, |u| {
            self.sweep::<1>(&On::All, out, |intact, rows, out| {
                energy_rows::<L, D>(self.instruction_set, &bonds, u, intact, rows, out);
            });
        });
    }

    fn energy(&self, t: f64, u: &[f64]) -> f64 {
        let mut density = vec![0.0; self.points()];
        self.add_energy_density(t, u, &mut density);
        ordered_sum(self.points(), |i| density[i] * self.cloud.volumes()[i])
    }

    /// ω² ≤ max_i (2/ρ_i) Σ_j k_ij/|ξ|, by Gershgorin's discs of 3×3 blocks.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let mut largest: f64 = 0.0;
        for i in 0..self.points() {
            let row: f64 = self
                .bonds
                .family(i)
                .filter(|&(entry, _)| self.is_intact(i, entry))
                .map(|(entry, j)| {
                    self.stiffness_of(entry, i, j).abs() / self.bonds.length(&self.cloud, i, j)
                })
                .sum();
            largest = largest.max(2.0 * row / density(i));
        }
        largest.sqrt()
    }

    fn accept_and_force(&mut self, accepted: Accepted<'_>, on: On<'_>, out: &mut [f64]) {
        if self.can_break() {
            let step = Some((accepted.mean_velocity, accepted.dt));
            self.decide(accepted.u, step, &on, None, out);
        } else {
            self.add_force(accepted.t, accepted.u, on, out);
        }
    }

    fn advance_history(&mut self, _t: f64, u: &[f64], on: On<'_>) {
        if self.can_break() {
            // The force of the same sweep is not wanted.
            let mut unused = vec![0.0; D * self.points()];
            self.decide(u, None, &on, None, &mut unused);
        }
    }

    fn tangent_into(&self, _t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        let bonds = self.view();
        self.with_packed(u, &On::All, |u| {
            self.with_packed(direction, &On::All, |direction| {
                self.sweep::<D>(&On::All, out, |intact, rows, out| {
                    let set = self.instruction_set;
                    tangent_rows::<L, D>(set, &bonds, u, direction, intact, rows, out);
                });
            });
        });
    }

    fn dissipated(&self) -> f64 {
        damage::dissipated(&self.blocks)
    }

    fn dissipate(&mut self, energy: f64) {
        damage::dissipate(&mut self.blocks, energy);
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        damage::take_coarse_breaks(&mut self.blocks)
    }

    fn broken_bonds(&self) -> u64 {
        damage::broken_bonds(&self.blocks)
    }

    fn can_break(&self) -> bool {
        self.critical_stretch.is_finite()
    }

    fn damage_into(&self, out: &mut [f64]) {
        out.par_iter_mut()
            .enumerate()
            .with_min_len(BLOCK)
            .for_each(|(i, damage)| {
                let (mut whole, mut left) = (0.0, 0.0);
                for (entry, j) in self.bonds.family(i) {
                    let present = self.bonds.present()[entry / LANES] >> (entry % LANES) & 1 == 1;
                    if !(present || self.damage.count_precut) {
                        continue;
                    }
                    let weight = if self.damage.count {
                        1.0
                    } else {
                        self.bonds.volume_factor(&self.cloud, i, j) * self.cloud.volumes()[j]
                    };
                    whole += weight;
                    if self.is_intact(i, entry) {
                        left += weight;
                    }
                }
                *damage = if whole > 0.0 { 1.0 - left / whole } else { 0.0 };
            });
    }

    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize)) {
        for i in 0..self.points() {
            let family = self.bonds.family(i);
            for (_, j) in family.filter(|&(entry, j)| j > i && self.is_intact(i, entry)) {
                visit(i, j);
            }
        }
    }

    fn directed_bonds(&self) -> u64 {
        self.bonds.directed_bonds()
    }

    fn bytes(&self) -> usize {
        self.bonds.bytes()
            + self.bonds.geometric().len()
            + self.breakable.as_ref().map_or(0, Vec::len)
            + self.own_bytes()
    }

    fn instruction_set(&self) -> InstructionSet {
        self.instruction_set
    }

    fn use_instruction_set(&mut self, set: InstructionSet) {
        if InstructionSet::available().contains(&set) {
            self.instruction_set = set;
        }
    }

    fn lattice_springs(&self) -> Option<LatticeSprings> {
        self.springs_of_offsets()
    }

    fn as_linear(&self) -> Option<&dyn LinearOperator> {
        L::LINEAR.then_some(self as &dyn LinearOperator)
    }

    fn as_bonds(&self) -> Option<&dyn BondView> {
        Some(self)
    }

    fn as_zoned(&self) -> Option<&dyn ZonedForce> {
        Some(self)
    }

    fn as_zoned_mut(&mut self) -> Option<&mut dyn ZonedForce> {
        Some(self)
    }
}

impl<L: FastLaw, const D: usize> BondView for BondForce<L, D> {
    fn for_each_bond(&self, u: &[f64], i: usize, visit: &mut dyn FnMut(BondAt)) {
        let (bonds, u) = (self.view(), components::<D>(u, self.points()));
        let spatial =
            |vector: [f64; D]| std::array::from_fn(|c| vector.get(c).copied().unwrap_or(0.0));
        for (entry, j) in self.bonds.family(i) {
            if !self.is_intact(i, entry) {
                continue;
            }
            let xi: [f64; D] = bonds.vector(i, j);
            let eta: [f64; D] = std::array::from_fn(|c| u[c][j] - u[c][i]);
            let stiffness = self.stiffness_of(entry, i, j);
            visit(BondAt {
                neighbour: j,
                xi: spatial(xi),
                eta: spatial(eta),
                force: spatial(L::force(xi, eta).map(|force| stiffness * force)),
            });
        }
    }
}

impl<L: FastLaw, const D: usize> LinearOperator for BondForce<L, D> {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.add_force(0.0, u, On::All, out);
    }

    fn half_bandwidth(&self) -> Option<usize> {
        let of_point = |i: usize| self.bonds.family(i).map(move |(_, j)| i.abs_diff(j));
        (D == 1).then(|| (0..self.points()).flat_map(of_point).max().unwrap_or(0))
    }
}
