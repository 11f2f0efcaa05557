//! The force operator of a bond list: any body, any family.

use std::sync::Arc;

use rayon::prelude::*;

use super::kernels::{Bonds, BreakRule, accept_rows, energy_rows, force_rows, tangent_rows};
use crate::archive::{Archive, Saved};
use crate::error::Result;
use crate::family::{BondList, LANES};
use crate::material::{BondConstants, BondMaterial, PairForce};
use crate::operator::damage::{self, BlockDamage, Breaking, DamageMeasure};
use crate::operator::rows::Rows;
use crate::operator::{Accepted, ForceOperator, InstructionSet, LinearOperator, On, ZonedForce};
use crate::parallel::{BLOCK, components, components_mut, for_each_block, ordered_sum};
use crate::space::PointCloud;

/// f(x_i) = Σ_j c α κ V_j s n over the bonds of a list: force density, N/m³.
///
/// A gather per point over [`BondList`], in parallel blocks; every bond is computed at both ends, with the same bits but for the sign. Memory: 13 bytes
/// per family entry (12 stored, 1/8 + 1/8 masks, and padding of rows to eight) and 8·(D+1) per point.
pub struct BondForce<L: PairForce, const D: usize> {
    cloud: Arc<PointCloud>,
    bonds: BondList,
    reference: [Vec<f64>; D],
    unit: f64,
    stiffness: Vec<f64>,
    breakable: Option<Vec<u8>>,
    critical_stretch: f64,
    damage: DamageMeasure,
    blocks: Vec<BlockDamage>,
    instruction_set: InstructionSet,
    law: std::marker::PhantomData<L>,
}

impl<L: PairForce, const D: usize> BondForce<L, D> {
    /// The operator of a material on a body.
    pub fn new(
        cloud: Arc<PointCloud>,
        bonds: BondList,
        material: &BondMaterial,
        constants: &BondConstants,
        no_fail: &[u32],
        damage: DamageMeasure,
    ) -> Self {
        let breaking = Breaking {
            critical_stretch: constants.critical_stretch,
            no_fail,
        };
        let stiffness =
            |xi| constants.micromodulus * material.influence.alpha_of(xi, material.horizon);
        Self::with_stiffness(cloud, bonds, stiffness, breaking, damage)
    }

    /// An operator whose bonds have the stiffness c α given as a function of their reference vector ξ, m; missing components are zero.
    /// It must be the same for ξ and −ξ.
    ///
    /// # Panics
    /// If the cloud has another dimension than D.
    pub fn with_stiffness(
        cloud: Arc<PointCloud>,
        bonds: BondList,
        stiffness_of_bond: impl Fn([f64; 3]) -> f64,
        breaking: Breaking<'_>,
        damage: DamageMeasure,
    ) -> Self {
        Self::with_pair_stiffness(
            cloud,
            bonds,
            |_, _, xi| stiffness_of_bond(xi),
            breaking,
            damage,
        )
    }

    /// An operator whose bonds have the stiffness c α(i, j, ξ) given for each pair of points and the vector ξ from one to the other; it must be the same from both
    /// ends.
    ///
    /// # Panics
    /// If the cloud has another dimension than D.
    pub fn with_pair_stiffness(
        cloud: Arc<PointCloud>,
        bonds: BondList,
        stiffness_of_pair: impl Fn(usize, usize, [f64; 3]) -> f64,
        breaking: Breaking<'_>,
        damage: DamageMeasure,
    ) -> Self {
        let stiffness = |bonds: &BondList, i: usize, j: usize| {
            stiffness_of_pair(i, j, bonds.vector(&cloud, i, j)) * bonds.volume_factor(&cloud, i, j)
        };
        Self::with_weighted_stiffness(cloud.clone(), bonds, stiffness, breaking, damage)
    }

    /// An operator whose bonds have the stiffness c α κ(i, j), partial volumes included, given for each pair of points; it must be the same from both ends.
    ///
    /// # Panics
    /// If the cloud has another dimension than D.
    pub fn with_weighted_stiffness(
        cloud: Arc<PointCloud>,
        bonds: BondList,
        stiffness_of_pair: impl Fn(&BondList, usize, usize) -> f64,
        breaking: Breaking<'_>,
        damage: DamageMeasure,
    ) -> Self {
        assert_eq!(cloud.dimension(), D, "an operator of the cloud's dimension");
        let n = cloud.len();
        let mut stiffness = vec![0.0; bonds.neighbours().len()];
        for i in 0..n {
            for (entry, j) in bonds.family(i) {
                stiffness[entry] = stiffness_of_pair(&bonds, i, j) * cloud.volumes()[j];
            }
        }
        // Integer coordinates make bonds of equal offset equal to the last bit.
        let (reference, unit) = match cloud.lattice() {
            Some(lattice) => (
                std::array::from_fn(|c| {
                    lattice
                        .node
                        .iter()
                        .map(|&node| f64::from(lattice.coordinates(node)[c]))
                        .collect()
                }),
                lattice.spacing,
            ),
            None => (std::array::from_fn(|c| cloud.axis(c).to_vec()), 1.0),
        };
        let breakable = (!breaking.no_fail.is_empty()).then(|| {
            let mut held = vec![false; n];
            for &i in breaking.no_fail {
                held[i as usize] = true;
            }
            let mut breakable = vec![0u8; bonds.geometric().len()];
            for i in (0..n).filter(|&i| !held[i]) {
                for (entry, j) in bonds.family(i) {
                    if !held[j] {
                        breakable[entry / LANES] |= 1 << (entry % LANES);
                    }
                }
            }
            breakable
        });
        let blocks = (0..n.div_ceil(BLOCK))
            .map(|b| {
                let (from, to) = (b * BLOCK, ((b + 1) * BLOCK).min(n));
                BlockDamage::new(bonds.present()[bonds.start()[from]..bonds.start()[to]].to_vec())
            })
            .collect();
        Self {
            cloud,
            bonds,
            reference,
            unit,
            stiffness,
            breakable,
            critical_stretch: breaking.critical_stretch,
            damage,
            blocks,
            instruction_set: InstructionSet::detect(),
            law: std::marker::PhantomData,
        }
    }

    /// Runs the loops with another instruction set; for tests and benchmarks.
    pub fn with_instruction_set(mut self, set: InstructionSet) -> Self {
        if InstructionSet::available().contains(&set) {
            self.instruction_set = set;
        }
        self
    }

    /// The families.
    pub fn bonds(&self) -> &BondList {
        &self.bonds
    }

    /// Whether an entry's bond is still there.
    pub fn is_intact(&self, i: usize, entry: usize) -> bool {
        let block = i / BLOCK;
        let group = entry / LANES - self.bonds.start()[block * BLOCK];
        self.blocks[block].intact[group] >> (entry % LANES) & 1 == 1
    }

    fn view(&self) -> Bonds<'_, D> {
        Bonds {
            reference: std::array::from_fn(|c| &self.reference[c][..]),
            unit: self.unit,
            start: self.bonds.start(),
            neighbours: self.bonds.neighbours(),
            stiffness: &self.stiffness,
            partners: None,
        }
    }

    /// Runs a read-only loop over all blocks.
    fn sweep<const C: usize>(
        &self,
        on: &On<'_>,
        out: &mut [f64],
        rows: impl Fn(&[u8], &Rows<'_>, &mut [&mut [f64]; C]) + Sync,
    ) {
        let n = self.points();
        // A vector of nothing: the blocks' state is only read, and no memory is taken.
        let mut nothing = vec![(); self.blocks.len()];
        for_each_block(
            components_mut::<C>(out, n),
            &mut nothing,
            &|first, mut out, ()| {
                if let Some(wanted) = Rows::of_block(on, first, out[0].len()) {
                    rows(&self.blocks[first / BLOCK].intact, &wanted, &mut out);
                }
            },
        );
    }

    fn decide<const FORCE: bool>(
        &mut self,
        u: &[f64],
        step: Option<(&[f64], f64)>,
        on: &On<'_>,
        partners: Option<&[bool]>,
        out: &mut [f64],
    ) {
        let n = self.points();
        let whole = matches!(on, On::All) && partners.is_none();
        let mut blocks = std::mem::take(&mut self.blocks);
        let bonds = Bonds {
            partners,
            ..self.view()
        };
        let rule = BreakRule {
            threshold: L::threshold(self.critical_stretch),
            breakable: self.breakable.as_deref(),
            volumes: self.cloud.volumes(),
            step: step.map(|(velocity, dt)| (components::<D>(velocity, n), dt)),
            note_events: !whole,
        };
        let u = components::<D>(u, n);
        for_each_block(
            components_mut::<D>(out, n),
            &mut blocks,
            &|first, mut out, block| {
                if let Some(wanted) = Rows::of_block(on, first, n.min(first + BLOCK) - first) {
                    accept_rows::<L, D, FORCE>(
                        self.instruction_set,
                        &bonds,
                        &rule,
                        &u,
                        &mut block.intact,
                        &wanted,
                        &mut out,
                        &mut block.tally,
                    );
                }
            },
        );
        self.blocks = blocks;
        if !whole {
            self.tell_the_other_ends();
        }
    }

    /// Clears the second copy of bonds that broke in a sweep over some of the points only, and books its half of the energy.
    fn tell_the_other_ends(&mut self) {
        for b in 0..self.blocks.len() {
            let events = std::mem::take(&mut self.blocks[b].tally.events);
            for event in events {
                let here = event.point as usize;
                let j = self.bonds.neighbours()[event.entry] as usize;
                let Some((back, _)) = self.bonds.family(j).find(|&(_, other)| other == here) else {
                    continue;
                };
                let block = j / BLOCK;
                let group = back / LANES - self.bonds.start()[block * BLOCK];
                self.blocks[block].break_other_end(group, back % LANES, &event);
            }
        }
    }
}

impl<L: PairForce, const D: usize> ForceOperator for BondForce<L, D> {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        D
    }

    fn add_force(&self, _t: f64, u: &[f64], on: On<'_>, out: &mut [f64]) {
        let (bonds, u) = (self.view(), components::<D>(u, self.points()));
        self.sweep::<D>(&on, out, |intact, rows, out| {
            force_rows::<L, D>(self.instruction_set, &bonds, &u, intact, rows, out);
        });
    }

    fn add_energy_density(&self, _t: f64, u: &[f64], out: &mut [f64]) {
        let (bonds, u) = (self.view(), components::<D>(u, self.points()));
        self.sweep::<1>(&On::All, out, |intact, rows, out| {
            energy_rows::<L, D>(self.instruction_set, &bonds, &u, intact, rows, out);
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
                    self.stiffness[entry].abs() / self.bonds.length(&self.cloud, i, j)
                })
                .sum();
            largest = largest.max(2.0 * row / density(i));
        }
        largest.sqrt()
    }

    fn accept_and_force(&mut self, accepted: Accepted<'_>, on: On<'_>, out: &mut [f64]) {
        if self.can_break() {
            let step = Some((accepted.mean_velocity, accepted.dt));
            self.decide::<true>(accepted.u, step, &on, None, out);
        } else {
            self.add_force(accepted.t, accepted.u, on, out);
        }
    }

    fn advance_history(&mut self, _t: f64, u: &[f64], on: On<'_>) {
        if self.can_break() {
            // No force is written: any array of the right shape will do for the loop's slices.
            let mut unused = vec![0.0; D * self.points()];
            self.decide::<false>(u, None, &on, None, &mut unused);
        }
    }

    fn tangent_into(&self, _t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        let n = self.points();
        let (bonds, u) = (self.view(), components::<D>(u, n));
        let direction = components::<D>(direction, n);
        self.sweep::<D>(&On::All, out, |intact, rows, out| {
            tangent_rows::<L, D>(
                self.instruction_set,
                &bonds,
                &u,
                &direction,
                intact,
                rows,
                out,
            );
        });
    }

    fn dissipated(&self) -> f64 {
        damage::dissipated(&self.blocks)
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

    fn directed_bonds(&self) -> u64 {
        self.bonds.directed_bonds()
    }

    fn bytes(&self) -> usize {
        self.bonds.bytes()
            + size_of_val(&self.stiffness[..])
            + self.bonds.geometric().len()
            + self.breakable.as_ref().map_or(0, Vec::len)
            + self.points() * (D + 1) * size_of::<f64>()
    }

    fn instruction_set(&self) -> InstructionSet {
        self.instruction_set
    }

    fn as_linear(&self) -> Option<&dyn LinearOperator> {
        L::LINEAR.then_some(self as &dyn LinearOperator)
    }

    fn as_zoned(&self) -> Option<&dyn ZonedForce> {
        Some(self)
    }

    fn as_zoned_mut(&mut self) -> Option<&mut dyn ZonedForce> {
        Some(self)
    }
}

impl<L: PairForce, const D: usize> ZonedForce for BondForce<L, D> {
    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        let present = self.bonds.present();
        for (entry, j) in self.bonds.family(i) {
            if present[entry / LANES] >> (entry % LANES) & 1 == 1 {
                visit(j);
            }
        }
    }

    fn add_force_from(&self, _t: f64, u: &[f64], on: On<'_>, partners: &[bool], out: &mut [f64]) {
        let u = components::<D>(u, self.points());
        let bonds = Bonds {
            partners: Some(partners),
            ..self.view()
        };
        self.sweep::<D>(&on, out, |intact, rows, out| {
            force_rows::<L, D>(self.instruction_set, &bonds, &u, intact, rows, out);
        });
    }

    fn accept_and_force_from(
        &mut self,
        accepted: Accepted<'_>,
        on: On<'_>,
        partners: &[bool],
        out: &mut [f64],
    ) {
        if self.can_break() {
            let step = Some((accepted.mean_velocity, accepted.dt));
            self.decide::<true>(accepted.u, step, &on, Some(partners), out);
        } else {
            self.add_force_from(accepted.t, accepted.u, on, partners, out);
        }
    }

    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        if !self.can_break() {
            return;
        }
        let threshold = L::threshold(fraction * self.critical_stretch);
        let u = components::<D>(u, self.points());
        let difference = |field: [&[f64]; D], i: usize, j: usize| -> [f64; D] {
            std::array::from_fn(|c| field[c][j] - field[c][i])
        };
        let over = |i: usize, j: usize| {
            let xi = difference(self.view().reference, i, j).map(|x| x * self.unit);
            let (measure, square) = L::stretch_measure(xi, difference(u, i, j));
            measure > threshold * square
        };
        let may_break = |entry: usize| {
            self.breakable
                .as_ref()
                .is_none_or(|bits| bits[entry / LANES] >> (entry % LANES) & 1 == 1)
        };
        marks
            .par_iter_mut()
            .enumerate()
            .with_min_len(BLOCK)
            .for_each(|(i, mark)| {
                *mark |= self
                    .bonds
                    .family(i)
                    .any(|(entry, j)| self.is_intact(i, entry) && may_break(entry) && over(i, j));
            });
    }
}

impl<L: PairForce, const D: usize> LinearOperator for BondForce<L, D> {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.add_force(0.0, u, On::All, out);
    }
}

impl<L: PairForce, const D: usize> Saved for BondForce<L, D> {
    fn save(&self, archive: &mut Archive) {
        damage::save(&self.blocks, "operator", archive);
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        damage::restore(&mut self.blocks, "operator", archive)
    }
}
