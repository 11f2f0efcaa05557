//! Sums of several forces on a body.

use std::ops::Range;

use super::{
    BondAt, BondValues, BondView, Breakable, Capabilities, CoarseBreak, Force, InstructionSet,
    Inversion, LinearOperator, Linearity, LocalForce, LostYield, PointSubset, SplitForce,
};
use crate::archive::{Archive, Checkpointed};
use crate::domain::Field;
use crate::error::{PericlesError, Result};
use crate::neighbourhood::BondSet;
use crate::step_end::StepEnd;

/// The sum of one or more forces between the points of a body.
///
/// It has the capabilities that all of its forces have, and it can break if one of them can.
pub struct Forces {
    list: Vec<Box<dyn Force>>,
}

impl Forces {
    /// Sets `out` to the sum of what `part_into` computes for each force.
    fn sum_into(&self, out: &mut [f64], part_into: &dyn Fn(&dyn Force, &mut [f64])) {
        let mut part = vec![0.0; out.len()];
        out.fill(0.0);
        for force in self.iter() {
            part_into(force, &mut part);
            add(&part, out);
        }
    }

    /// Creates a sum of one force.
    pub fn new(force: Box<dyn Force>) -> Self {
        Self { list: vec![force] }
    }

    /// Adds a force.
    ///
    /// # Errors
    /// A force on another number of points, or in another dimension.
    pub fn add(&mut self, force: Box<dyn Force>) -> Result<()> {
        Self::check_body(&*force, self.points(), self.dimension())?;
        self.list.push(force);
        Ok(())
    }

    /// Checks that a force belongs to a body with this number of points and this dimension.
    pub(crate) fn check_body(
        force: &dyn Force,
        needed_points: usize,
        needed_dimension: usize,
    ) -> Result<()> {
        let (points, dimension) = (force.points(), force.dimension());
        if points == needed_points && dimension == needed_dimension {
            return Ok(());
        }
        Err(PericlesError::ForceOfAnotherBody {
            points,
            dimension,
            needed_points,
            needed_dimension,
        })
    }

    /// Returns the sum of all forces; a single force is returned directly.
    pub fn sum(&self) -> &dyn Force {
        match &self.list[..] {
            [one] => &**one,
            _ => self,
        }
    }

    /// Returns the sum of all forces for modification.
    pub fn sum_mut(&mut self) -> &mut dyn Force {
        if self.list.len() == 1 {
            return &mut *self.list[0];
        }
        self
    }

    /// Returns an iterator over the forces.
    pub fn iter(&self) -> impl Iterator<Item = &dyn Force> {
        self.list.iter().map(|force| &**force)
    }

    fn breaking(&self) -> impl Iterator<Item = &dyn Breakable> {
        self.iter()
            .filter_map(|force| force.capabilities().breaking)
    }

    /// Returns a capability of the sum if all forces have it.
    fn all<'a, T: ?Sized + 'a>(
        &'a self,
        own: &'a T,
        has: impl Fn(Capabilities<'a>) -> Option<&'a T>,
    ) -> Option<&'a T> {
        let all = self
            .list
            .iter()
            .all(|force| has(force.capabilities()).is_some());
        all.then_some(own)
    }
}

impl Force for Forces {
    fn points(&self) -> usize {
        self.list[0].points()
    }

    fn dimension(&self) -> usize {
        self.list[0].dimension()
    }

    fn add_force(&self, t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        for force in &self.list {
            force.add_force(t, u, on.clone(), out);
        }
    }

    fn add_energy_density(&self, t: f64, u: &[f64], out: &mut [f64]) {
        for force in &self.list {
            force.add_energy_density(t, u, out);
        }
    }

    fn energy(&self, t: f64, u: &[f64]) -> f64 {
        self.list.iter().map(|force| force.energy(t, u)).sum()
    }

    fn heating(&self, step: &StepEnd<'_>) -> f64 {
        self.list.iter().map(|force| force.heating(step)).sum()
    }

    /// ω² of a sum of stiffnesses is at most the sum of their ω².
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let square = |force: &dyn Force| force.frequency_bound(density).powi(2);
        self.iter().map(square).sum::<f64>().sqrt()
    }

    fn tangent_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.sum_into(out, &|force, part| {
            force.tangent_into(t, u, direction, part);
        });
    }

    fn secant_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.sum_into(out, &|force, part| {
            force.secant_into(t, u, direction, part);
        });
    }

    fn end_step(&mut self, step: &StepEnd<'_>, on: PointSubset<'_>, out: &mut [f64]) {
        for force in &mut self.list {
            force.end_step(step, on.clone(), out);
        }
    }

    fn capabilities(&self) -> Capabilities<'_> {
        let linear: Vec<_> = self
            .iter()
            .map(|force| force.capabilities().linear)
            .collect();
        let exact = linear.iter().all(|one| matches!(one, Linearity::Exact(_)));
        let rounded = !linear.iter().any(|one| matches!(one, Linearity::Nonlinear));
        Capabilities {
            dilatation: self
                .iter()
                .find_map(|force| force.capabilities().dilatation),
            stress: self.iter().find_map(|force| force.capabilities().stress),
            plastic: self.iter().find_map(|force| force.capabilities().plastic),
            thermal: self.iter().find_map(|force| force.capabilities().thermal),
            linear: match (exact, rounded) {
                (true, _) => Linearity::Exact(self),
                (false, true) => Linearity::Rounded,
                (false, false) => Linearity::Nonlinear,
            },
            breaking: self.breaking().next().map(|_| self as &dyn Breakable),
            local: self.all(self, |force| force.local),
            split: self.all(self, |force| force.split),
            bonds: self.all(self, |force| force.bonds),
            single_precision: self
                .iter()
                .any(|force| force.capabilities().single_precision),
            stencil: None,
            path_dependent: self.iter().any(|force| force.capabilities().path_dependent),
        }
    }

    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        self.breaking().next()?;
        Some(self)
    }

    fn split_mut(&mut self) -> Option<&mut dyn SplitForce> {
        self.capabilities().split?;
        Some(self)
    }

    /// Returns the sum of the largest errors, each relative to the largest force of its own operator.
    fn rounding(&self, u: &[f64]) -> Option<f64> {
        let errors = self.list.iter().filter_map(|force| force.rounding(u));
        errors.reduce(|sum, error| sum + error)
    }

    fn inversion(&self) -> Option<Inversion> {
        self.iter().find_map(|force| force.inversion())
    }

    fn lost_yield(&self) -> Option<LostYield> {
        self.iter().find_map(|force| force.lost_yield())
    }

    fn directed_bonds(&self) -> u64 {
        self.list.iter().map(|force| force.directed_bonds()).sum()
    }

    fn bytes(&self) -> usize {
        self.list.iter().map(|force| force.bytes()).sum()
    }

    fn values_between_passes(&self) -> usize {
        let values = self.list.iter().map(|force| force.values_between_passes());
        values.sum()
    }

    fn instruction_set(&self) -> InstructionSet {
        self.list[0].instruction_set()
    }

    fn use_instruction_set(&mut self, set: InstructionSet) {
        for force in &mut self.list {
            force.use_instruction_set(set);
        }
    }
}

impl Breakable for Forces {
    fn bonds(&self) -> &dyn BondSet {
        self
    }

    fn bonds_mut(&mut self) -> &mut dyn BondSet {
        self
    }

    fn can_break(&self) -> bool {
        self.breaking().any(|breaking| breaking.can_break())
    }

    fn dropped_points(&self) -> u64 {
        let dropped = self.breaking().map(|breaking| breaking.dropped_points());
        dropped.sum()
    }

    fn stiffening(&self) -> f64 {
        let all = self.breaking().map(|breaking| breaking.stiffening());
        all.fold(1.0, f64::max)
    }

    fn accumulates(&self) -> bool {
        self.breaking().any(|breaking| breaking.accumulates())
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        let breaking = self.breaking_each();
        breaking
            .flat_map(|breaking| breaking.take_coarse_breaks())
            .collect()
    }

    /// Sets the largest damage over all forces.
    fn damage_into(&self, out: &mut [f64]) {
        self.largest_damage(out, |breaking, part| breaking.damage_into(part));
    }

    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        for breaking in self.breaking() {
            breaking.mark_endangered(u, fraction, marks);
        }
    }
}

impl Forces {
    fn breaking_each(&mut self) -> impl Iterator<Item = &mut dyn Breakable> {
        let forces = self.list.iter_mut();
        forces.filter_map(|force| force.breaking_mut())
    }

    fn largest_damage(&self, out: &mut [f64], of_force: impl Fn(&dyn Breakable, &mut [f64])) {
        let mut part = vec![0.0; out.len()];
        out.fill(0.0);
        for breaking in self.breaking() {
            of_force(breaking, &mut part);
            for (out, damage) in out.iter_mut().zip(&part) {
                *out = out.max(*damage);
            }
        }
    }
}

/// The bonds of all forces.
impl BondSet for Forces {
    fn broken_bonds(&self) -> u64 {
        let broken = self
            .breaking()
            .map(|breaking| breaking.bonds().broken_bonds());
        broken.sum()
    }

    fn dissipated(&self) -> f64 {
        let dissipated = self
            .breaking()
            .map(|breaking| breaking.bonds().dissipated());
        dissipated.sum()
    }

    fn dissipate(&mut self, i: usize, energy: f64) {
        let mut breaking = self.breaking_each();
        if let Some(first) = breaking.find(|breaking| breaking.can_break()) {
            first.bonds_mut().dissipate(i, energy);
        }
    }

    fn follow_dissipation(&mut self) {
        for breaking in self.breaking_each() {
            breaking.bonds_mut().follow_dissipation();
        }
    }

    fn take_dissipated(&mut self, out: &mut [f64]) {
        for breaking in self.breaking_each() {
            breaking.bonds_mut().take_dissipated(out);
        }
    }

    /// Sets the largest damage over all forces.
    fn damage_into(&self, out: &mut [f64]) {
        self.largest_damage(out, |breaking, part| breaking.bonds().damage_into(part));
    }

    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize)) {
        for breaking in self.breaking() {
            breaking.bonds().for_each_intact(visit);
        }
    }

    fn for_each_intact_of(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        for breaking in self.breaking() {
            breaking.bonds().for_each_intact_of(i, visit);
        }
    }

    fn for_each_change_count(&self, visit: &mut dyn FnMut(Range<usize>, u64)) {
        for breaking in self.breaking() {
            breaking.bonds().for_each_change_count(visit);
        }
    }
}

impl LocalForce for Forces {
    fn bonded(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        let mut reached = Vec::new();
        for local in self.iter().filter_map(|force| force.capabilities().local) {
            local.bonded(i, &mut |j| reached.push(j));
        }
        reached.sort_unstable();
        reached.dedup();
        reached.into_iter().for_each(visit);
    }

    fn range_in_bonds(&self) -> u32 {
        let local = self.iter().filter_map(|force| force.capabilities().local);
        local.map(LocalForce::range_in_bonds).max().unwrap_or(1)
    }
}

impl SplitForce for Forces {
    fn add_force_from(
        &self,
        t: f64,
        u: &[f64],
        on: PointSubset<'_>,
        partners: &[bool],
        out: &mut [f64],
    ) {
        for split in self.iter().filter_map(|force| force.capabilities().split) {
            split.add_force_from(t, u, on.clone(), partners, out);
        }
    }

    fn end_step_from(
        &mut self,
        step: &StepEnd<'_>,
        on: PointSubset<'_>,
        partners: &[bool],
        out: &mut [f64],
    ) {
        let forces = self.list.iter_mut();
        for split in forces.filter_map(|force| force.split_mut()) {
            split.end_step_from(step, on.clone(), partners, out);
        }
    }
}

impl BondView for Forces {
    fn values_at(&self, u: Field<'_>) -> BondValues {
        let views = self.iter().filter_map(|force| force.capabilities().bonds);
        BondValues {
            parts: views.map(|bonds| bonds.values_at(u)).collect(),
            ..BondValues::default()
        }
    }

    fn for_each_bond(&self, values: &BondValues, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let views = self.iter().filter_map(|force| force.capabilities().bonds);
        for (bonds, values) in views.zip(&values.parts) {
            bonds.for_each_bond(values, i, visit);
        }
    }

    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt)) {
        for bonds in self.iter().filter_map(|force| force.capabilities().bonds) {
            bonds.for_each_undeformed(i, visit);
        }
    }
}

impl LinearOperator for Forces {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.add_force(0.0, u, PointSubset::All, out);
    }

    fn half_bandwidth(&self) -> Option<usize> {
        let width = |force: &dyn Force| match force.capabilities().linear {
            Linearity::Exact(linear) => linear.half_bandwidth(),
            _ => None,
        };
        self.iter()
            .map(width)
            .try_fold(0, |most, width| Some(most.max(width?)))
    }
}

/// Arrays of the k-th of several forces have the prefix `force/k/`; arrays of a single force have no prefix.
impl Checkpointed for Forces {
    fn save(&self, archive: &mut Archive) {
        if let [one] = &self.list[..] {
            return one.save(archive);
        }
        for (k, force) in self.list.iter().enumerate() {
            let mut own = Archive::default();
            force.save(&mut own);
            archive.put_all(&format!("force/{k}/"), own);
        }
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        if let [one] = &mut self.list[..] {
            return one.restore(archive);
        }
        for (k, force) in self.list.iter_mut().enumerate() {
            let prefix = format!("force/{k}/");
            let mut own = Archive::default();
            for (name, values) in archive.arrays() {
                if let Some(name) = name.strip_prefix(&prefix) {
                    own.put(name, values.clone());
                }
            }
            force.restore(&own)?;
        }
        Ok(())
    }
}

fn add(part: &[f64], out: &mut [f64]) {
    for (out, part) in out.iter_mut().zip(part) {
        *out += part;
    }
}
