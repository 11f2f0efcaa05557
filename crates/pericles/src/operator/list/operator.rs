//! [`Force`] for neighbour lists.

use super::force::BondForce;
use super::kernels::{energy_rows, force_rows, tangent_rows};
use crate::neighbourhood::Form;
use crate::operator::fast_law::VectorLaw;
use crate::operator::{
    BondAt, BondValues, BondView, Breakable, Capabilities, Force, Growing, InstructionSet,
    LatticeSprings, LinearOperator, Linearity, PointSubset, SplitForce,
};
use crate::step_end::StepEnd;
use crate::thermal::Expandable;

impl<L: VectorLaw, const D: usize> Force for BondForce<L, D> {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        D
    }

    fn add_force(&self, t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        let heat = self.heat_at(t);
        let bonds = self.view().heated(heat.as_deref().map(Vec::as_slice));
        self.with_packed(u, &on, |u| {
            self.sweep::<D>(&on, out, |intact, rows, out| {
                force_rows::<L, D>(self.instruction_set, &bonds, u, intact, rows, out);
            });
        });
    }

    fn add_energy_density(&self, t: f64, u: &[f64], out: &mut [f64]) {
        let heat = self.heat_at(t);
        let bonds = self.view().heated(heat.as_deref().map(Vec::as_slice));
        self.with_packed(u, &PointSubset::All, |u| {
            self.sweep::<1>(&PointSubset::All, out, |intact, rows, out| {
                energy_rows::<L, D>(self.instruction_set, &bonds, u, intact, rows, out);
            });
        });
    }

    fn energy(&self, t: f64, u: &[f64]) -> f64 {
        let mut density = vec![0.0; self.points()];
        self.add_energy_density(t, u, &mut density);
        let volumes = self.cloud.volumes();
        let energy = |i: usize| density[i] * volumes[i];
        self.cloud.domain().sum(self.points(), energy)
    }

    /// ω² ≤ max_i (2/ρ_i) Σ_j k_ij/|ξ| by Gershgorin discs of D×D blocks.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let mut largest: f64 = 0.0;
        for i in 0..self.points() {
            let row: f64 = self
                .bonds
                .intact_of(i)
                .map(|(entry, b)| {
                    self.stiffness_of(entry, i, b).abs()
                        / self.bonds.form().length(self.bonds.form().site(i), b)
                })
                .sum();
            largest = largest.max(2.0 * row / density(i));
        }
        self.cloud.domain().max(largest).sqrt()
    }

    fn end_step(&mut self, step: &StepEnd<'_>, on: PointSubset<'_>, out: &mut [f64]) {
        if self.can_break() {
            self.decide(step, &on, None, out);
        } else {
            self.add_force(step.t, step.u, on, out);
        }
    }

    fn tangent_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        let heat = self.heat_at(t);
        let bonds = self.view().heated(heat.as_deref().map(Vec::as_slice));
        self.with_packed(u, &PointSubset::All, |u| {
            self.with_packed(direction, &PointSubset::All, |direction| {
                self.sweep::<D>(&PointSubset::All, out, |intact, rows, out| {
                    let set = self.instruction_set;
                    tangent_rows::<L, D>(set, &bonds, u, direction, intact, rows, out);
                });
            });
        });
    }

    fn directed_bonds(&self) -> u64 {
        self.bonds.form().directed_bonds()
    }

    fn bytes(&self) -> usize {
        Form::bytes(self.bonds.form()) + self.own_bytes()
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

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            // With thermal stretch or growth the force is affine: it does not vanish at rest.
            linear: match L::LINEAR && self.heat.is_none() && self.bonds.origin().is_empty() {
                true => Linearity::Exact(self),
                false => Linearity::Nonlinear,
            },
            breaking: Some(self),
            local: Some(self),
            split: Some(self),
            bonds: Some(self),
            single_precision: false,
            dilatation: None,
            stress: None,
            plastic: None,
            path_dependent: false,
            stencil: None,
            thermal: self.heat.as_ref().map(|heat| &heat.expansion),
        }
    }

    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        Some(self)
    }

    fn split_mut(&mut self) -> Option<&mut dyn SplitForce> {
        Some(self)
    }

    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        Some(self)
    }

    fn growing_mut(&mut self) -> Option<&mut dyn Growing> {
        Some(self)
    }
}

impl<L: VectorLaw, const D: usize> BondView for BondForce<L, D> {
    fn for_each_bond(&self, values: &BondValues, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let u = values.displacement();
        let (heat, sites) = (self.latest_heat(), self.bonds.form().sites());
        let bonds = self.view().heated(heat.as_deref().map(Vec::as_slice));
        let here = sites.of_point(i);
        for (entry, b) in self.bonds.intact_of(i) {
            let xi: [f64; D] = bonds.vector(here, b);
            let eta = u.difference::<D>([i, sites.point(b)]);
            let (free, pulled, scale) = bonds.relative::<L, D>(entry, [here, b], xi, eta);
            let stiffness = scale * self.stiffness_of(entry, i, b);
            let force = L::force(free, pulled).map(|force| stiffness * force);
            visit(BondAt::new(sites.point(b), xi, eta, force).of_small_strain(L::LINEAR));
        }
    }

    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let (bonds, sites) = (self.view(), self.bonds.form().sites());
        let here = sites.of_point(i);
        for (_, b) in self.bonds.intact_of(i) {
            let xi: [f64; D] = bonds.vector(here, b);
            visit(BondAt::undeformed(sites.point(b), xi));
        }
    }
}

impl<L: VectorLaw, const D: usize> LinearOperator for BondForce<L, D> {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.add_force(0.0, u, PointSubset::All, out);
    }

    fn half_bandwidth(&self) -> Option<usize> {
        let of_point = |i: usize| self.bonds.form().family(i).map(move |(_, j)| i.abs_diff(j));
        let is_band = D == 1 && self.bonds.form().sites().are_points();
        is_band.then(|| (0..self.points()).flat_map(of_point).max().unwrap_or(0))
    }
}
