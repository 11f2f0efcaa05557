//! Force operator of a surface.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::bonds::SurfaceBonds;
use super::breaking::{Breaking, Step};
use super::kernels::{Bonds, energy_rows, force_rows, tangent_rows};
use super::law::SurfaceLaw;
use pericles::Result;
use pericles::lanes::Row;
use pericles::neighbourhood::{BondSet, PointDissipation, each_once};
use pericles::operator::pool::{Lent, Pool};
use pericles::operator::records::pack;
use pericles::operator::rows::Rows;
use pericles::operator::{
    Breakable, Capabilities, CoarseBreak, Force, InstructionSet, LinearOperator, Linearity,
    LocalForce, PointSubset, SplitForce,
};
use pericles::parallel::{BLOCK, components_mut, for_each_block};
use pericles::space::PointCloud;
use pericles::{Archive, Checkpointed, StepEnd};

/// Force per area (N/m²) (K u)_i = Σ_j w_ij A_j f(η_ij), summed over the bonds of a surface.
///
/// Gathers per point over [`SurfaceBonds`], in parallel blocks. Displacements are packed into rows of four once
/// per evaluation, so a bond reads one row. A broken bond has weight zero. Memory: 12 bytes per directed bond,
/// 8 more if bonds can break, and 64 per point.
pub struct SurfaceForce<L: SurfaceLaw> {
    law: L,
    cloud: Arc<PointCloud>,
    bonds: SurfaceBonds,
    /// Reference positions, if the law uses chords.
    reference: Vec<Row>,
    breaking: Option<Breaking>,
    records: Pool<Vec<Row>>,
    instruction_set: InstructionSet,
}

impl<L: SurfaceLaw> SurfaceForce<L> {
    /// Creates the operator of a law; `limits` holds the squared critical |η| of every entry (m²) and is empty
    /// if bonds never break.
    pub(super) fn new(
        law: L,
        cloud: Arc<PointCloud>,
        bonds: SurfaceBonds,
        limits: Option<Vec<f64>>,
    ) -> Self {
        let n = cloud.len();
        let mut reference = Vec::new();
        if L::CHORD {
            reference = vec![Row::default(); n];
            pack::<3>(cloud.positions(), &mut reference);
        }
        Self {
            law,
            bonds,
            reference,
            breaking: limits.map(|limits| Breaking {
                limits,
                broken: Vec::new(),
                dissipated: 0.0,
                of_points: PointDissipation::default(),
                coarse: Vec::new(),
            }),
            records: Pool::new(1, move || vec![Row::default(); n]),
            cloud,
            instruction_set: InstructionSet::detect(),
        }
    }

    /// Selects another instruction set; for tests and benchmarks.
    pub fn with_instruction_set(mut self, set: InstructionSet) -> Self {
        if InstructionSet::available().contains(&set) {
            self.instruction_set = set;
        }
        self
    }

    /// The bonds.
    pub fn bonds(&self) -> &SurfaceBonds {
        &self.bonds
    }

    fn packed(&self, field: &[f64]) -> Lent<'_, Vec<Row>> {
        let mut records = self.records.take();
        pack::<3>(field, &mut records);
        records
    }

    fn sweep<const C: usize>(
        &self,
        on: &PointSubset<'_>,
        out: &mut [f64],
        rows: impl Fn(&Rows<'_>, &mut [&mut [f64]; C]) + Sync,
    ) {
        let n = self.points();
        // A vector of a zero-sized type allocates no memory.
        let mut nothing = vec![(); n.div_ceil(BLOCK)];
        for_each_block(
            components_mut::<C>(out, n),
            &mut nothing,
            self.bonds.cost(on),
            &|first, mut out, ()| {
                if let Some(wanted) = Rows::of_block(on, first, out[0].len()) {
                    rows(&wanted, &mut out);
                }
            },
        );
    }

    fn add_force_of(&self, bonds: &Bonds<'_>, u: &[f64], on: &PointSubset<'_>, out: &mut [f64]) {
        let u = self.packed(u);
        self.sweep::<3>(on, out, |rows, out| {
            force_rows(self.instruction_set, self.law, bonds, &u, rows, out);
        });
    }

    fn decide(&mut self, step: &StepEnd<'_>, on: &PointSubset<'_>, partners: Option<&[bool]>) {
        let step = Step {
            end: step,
            areas: self.cloud.volumes(),
            reference: &self.reference,
            partners,
        };
        if let Some(breaking) = &mut self.breaking {
            breaking.decide(self.law, &mut self.bonds, &step, on);
        }
    }
}

impl<L: SurfaceLaw> Force for SurfaceForce<L> {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        3
    }

    fn add_force(&self, _t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        self.add_force_of(&Bonds::new(&self.bonds, &self.reference), u, &on, out);
    }

    fn add_energy_density(&self, _t: f64, u: &[f64], out: &mut [f64]) {
        let u = self.packed(u);
        let bonds = Bonds::new(&self.bonds, &self.reference);
        self.sweep::<1>(&PointSubset::All, out, |rows, out| {
            energy_rows(self.instruction_set, self.law, &bonds, &u, rows, out);
        });
    }

    fn energy(&self, t: f64, u: &[f64]) -> f64 {
        let mut density = vec![0.0; self.points()];
        self.add_energy_density(t, u, &mut density);
        let volumes = self.cloud.volumes();
        let energy = |i: usize| density[i] * volumes[i];
        self.cloud.domain().sum(self.points(), energy)
    }

    /// Gershgorin bound ω² ≤ max_i (2/ρ_i) Σ_j |w_ij| A_j for p = 2; zero for p > 2, where the tangent vanishes
    /// at rest.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let row = |i: usize| -> f64 {
            self.bonds
                .row(i)
                .map(|(entry, _)| self.bonds.weights()[entry].abs())
                .sum()
        };
        let largest =
            (0..self.points()).fold(0.0_f64, |largest, i| largest.max(2.0 * row(i) / density(i)));
        (largest * self.law.stiffness_at_rest()).sqrt()
    }

    fn end_step(&mut self, step: &StepEnd<'_>, on: PointSubset<'_>, out: &mut [f64]) {
        self.decide(step, &on, None);
        self.add_force(step.t, step.u, on, out);
    }

    fn tangent_into(&self, _t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        if self.law.is_linear() {
            return self.apply_into(direction, out);
        }
        let (u, direction) = (self.packed(u), self.packed(direction));
        let bonds = Bonds::new(&self.bonds, &self.reference);
        self.sweep::<3>(&PointSubset::All, out, |rows, out| {
            tangent_rows(
                self.instruction_set,
                self.law,
                &bonds,
                &u,
                &direction,
                rows,
                out,
            );
        });
    }

    fn directed_bonds(&self) -> u64 {
        self.bonds.directed()
    }

    fn bytes(&self) -> usize {
        self.bonds.bytes()
            + size_of_val(&self.reference[..])
            + self
                .breaking
                .as_ref()
                .map_or(0, |breaking| size_of_val(&breaking.limits[..]))
            + self.points() * size_of::<Row>()
    }

    fn instruction_set(&self) -> InstructionSet {
        self.instruction_set
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            linear: match self.law.is_linear() {
                true => Linearity::Exact(self),
                false => Linearity::Nonlinear,
            },
            breaking: Some(self),
            local: Some(self),
            split: Some(self),
            ..Capabilities::default()
        }
    }

    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        Some(self)
    }

    fn split_mut(&mut self) -> Option<&mut dyn SplitForce> {
        Some(self)
    }
}

impl<L: SurfaceLaw> Breakable for SurfaceForce<L> {
    fn bonds(&self) -> &dyn BondSet {
        self
    }

    fn bonds_mut(&mut self) -> &mut dyn BondSet {
        self
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        let breaking = self.breaking.as_mut();
        breaking.map_or(Vec::new(), |breaking| {
            each_once(std::mem::take(&mut breaking.coarse))
        })
    }

    fn can_break(&self) -> bool {
        self.breaking.is_some()
    }

    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        if let Some(breaking) = &self.breaking {
            breaking.mark_endangered(&self.bonds, u, fraction, marks);
        }
    }
}

impl<L: SurfaceLaw> BondSet for SurfaceForce<L> {
    fn broken_bonds(&self) -> u64 {
        self.breaking
            .as_ref()
            .map_or(0, |breaking| breaking.broken.len() as u64 / 2)
    }

    fn dissipated(&self) -> f64 {
        self.breaking
            .as_ref()
            .map_or(0.0, |breaking| breaking.dissipated)
    }

    fn dissipate(&mut self, i: usize, energy: f64) {
        if let Some(breaking) = &mut self.breaking {
            breaking.dissipated += energy;
            breaking.of_points.add(i, energy);
        }
    }

    fn follow_dissipation(&mut self) {
        if let Some(breaking) = &mut self.breaking {
            breaking.of_points.follow();
        }
    }

    fn take_dissipated(&mut self, out: &mut [f64]) {
        if let Some(breaking) = &mut self.breaking {
            breaking.of_points.take_into(out);
        }
    }

    /// Fraction of the area within the horizon whose bonds are broken.
    fn damage_into(&self, out: &mut [f64]) {
        if self.breaking.is_none() {
            return out.fill(0.0);
        }
        let areas = self.cloud.volumes();
        out.par_iter_mut()
            .enumerate()
            .with_min_len(BLOCK)
            .for_each(|(i, damage)| {
                let (mut whole, mut left) = (0.0, 0.0);
                for (entry, j) in self.bonds.row(i) {
                    whole += areas[j];
                    if self.bonds.weights()[entry] != 0.0 {
                        left += areas[j];
                    }
                }
                *damage = if whole > 0.0 { 1.0 - left / whole } else { 0.0 };
            });
    }

    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize)) {
        // The weight of a broken bond was set to zero.
        let weights = self.bonds.weights();
        for i in 0..self.points() {
            let row = self.bonds.row(i);
            for (_, j) in row.filter(|&(entry, j)| j > i && weights[entry] != 0.0) {
                visit(i, j);
            }
        }
    }

    fn for_each_intact_of(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        let weights = self.bonds.weights();
        let row = self.bonds.row(i);
        let intact = row.filter(|&(entry, _)| weights[entry] != 0.0);
        intact.for_each(|(_, j)| visit(j));
    }

    fn for_each_change_count(&self, visit: &mut dyn FnMut(Range<usize>, u64)) {
        visit(0..self.points(), BondSet::broken_bonds(self));
    }
}

impl<L: SurfaceLaw> SplitForce for SurfaceForce<L> {
    fn add_force_from(
        &self,
        _t: f64,
        u: &[f64],
        on: PointSubset<'_>,
        partners: &[bool],
        out: &mut [f64],
    ) {
        let bonds = Bonds::new(&self.bonds, &self.reference).to(partners);
        self.add_force_of(&bonds, u, &on, out);
    }

    fn end_step_from(
        &mut self,
        step: &StepEnd<'_>,
        on: PointSubset<'_>,
        partners: &[bool],
        out: &mut [f64],
    ) {
        self.decide(step, &on, Some(partners));
        self.add_force_from(step.t, step.u, on, partners, out);
    }
}

impl<L: SurfaceLaw> LinearOperator for SurfaceForce<L> {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.add_force(0.0, u, PointSubset::All, out);
    }
}

impl<L: SurfaceLaw> Checkpointed for SurfaceForce<L> {
    fn save(&self, archive: &mut Archive) {
        let Self {
            breaking,
            // Rebuilt from `breaking`.
            bonds: _,
            law: _,
            cloud: _,
            reference: _,
            records: _,
            instruction_set: _,
        } = self;
        if let Some(breaking) = breaking {
            breaking.save(archive);
        }
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        match &mut self.breaking {
            Some(breaking) => breaking.restore(&mut self.bonds, archive),
            None => Ok(()),
        }
    }
}

impl<L: SurfaceLaw> LocalForce for SurfaceForce<L> {
    fn bonded(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.bonds.row(i).for_each(|(_, j)| visit(j));
    }
}
