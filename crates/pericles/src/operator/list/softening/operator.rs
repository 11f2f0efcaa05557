//! [`Force`] for softening bonds.

use super::force::SofteningForce;
use super::gate::Gate;
use super::kernels::{Change, Softened, energy_rows, force_rows, tangent_rows};
use crate::operator::fast_law::VectorLaw;
use crate::operator::heating::heating_of;
use crate::operator::{
    BondAt, BondValues, BondView, Breakable, Capabilities, Force, Growing, InstructionSet,
    LatticeSprings, PointSubset,
};
use crate::step_end::StepEnd;
use crate::thermal::Expandable;

impl<L: VectorLaw, const D: usize> SofteningForce<L, D> {
    fn add_energy_density_of(&self, kept: &Softened<'_>, (t, u): (f64, &[f64]), out: &mut [f64]) {
        let list = &self.list;
        let heat = list.heat_at(t);
        let bonds = list.view().heated(heat.as_deref().map(Vec::as_slice));
        list.with_packed(u, &PointSubset::All, |u| {
            list.sweep::<1>(&PointSubset::All, out, |intact, rows, out| {
                energy_rows::<L, D>(list.instruction_set, &bonds, kept, u, intact, rows, out);
            });
        });
    }

    /// Sets `out` to the derivative of the force density at `u` in a direction, with or without the change of the damage.
    fn derivative_into(
        &self,
        t: f64,
        [u, direction]: [&[f64]; 2],
        is_softening: bool,
        out: &mut [f64],
    ) {
        let (list, kept) = (&self.list, self.kept());
        let heat = list.heat_at(t);
        let bonds = list.view().heated(heat.as_deref().map(Vec::as_slice));
        let change = Change {
            kept: &kept,
            is_softening,
        };
        list.with_packed(u, &PointSubset::All, |u| {
            list.with_packed(direction, &PointSubset::All, |direction| {
                list.sweep::<D>(&PointSubset::All, out, |intact, rows, out| {
                    let set = list.instruction_set;
                    tangent_rows::<L, D>(set, &bonds, &change, u, direction, intact, rows, out);
                });
            });
        });
    }

    fn energy_of(&self, kept: &Softened<'_>, t: f64, u: &[f64]) -> f64 {
        let mut density = vec![0.0; self.points()];
        self.add_energy_density_of(kept, (t, u), &mut density);
        let volumes = self.list.cloud.volumes();
        let energy = |i: usize| density[i] * volumes[i];
        self.list.cloud.domain().sum(self.points(), energy)
    }
}

impl<L: VectorLaw, const D: usize> Force for SofteningForce<L, D> {
    fn points(&self) -> usize {
        self.list.points()
    }

    fn dimension(&self) -> usize {
        D
    }

    fn add_force(&self, t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        let (list, kept) = (&self.list, self.kept());
        let heat = list.heat_at(t);
        let bonds = list.view().heated(heat.as_deref().map(Vec::as_slice));
        list.with_packed(u, &on, |u| {
            list.sweep::<D>(&on, out, |intact, rows, out| {
                force_rows::<L, D>(list.instruction_set, &bonds, &kept, u, intact, rows, out);
            });
        });
    }

    fn add_energy_density(&self, t: f64, u: &[f64], out: &mut [f64]) {
        self.add_energy_density_of(&self.kept(), (t, u), out);
    }

    fn energy(&self, t: f64, u: &[f64]) -> f64 {
        self.energy_of(&self.kept(), t, u)
    }

    /// Dissipated energy is counted as the energy of lost stiffness; the remaining energy changes with the temperature at
    /// the stiffness before the step.
    fn heating(&self, step: &StepEnd<'_>) -> f64 {
        let frozen = Softened {
            is_frozen: true,
            ..self.kept()
        };
        heating_of(self.list.capabilities().thermal, step, &|t, u| {
            self.energy_of(&frozen, t, u)
        })
    }

    /// Softening does not increase the stiffness of a bond.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        self.list.frequency_bound(density)
    }

    fn end_step(&mut self, step: &StepEnd<'_>, on: PointSubset<'_>, out: &mut [f64]) {
        self.advance(step, &on, out);
    }

    fn tangent_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.derivative_into(t, [u, direction], true, out);
    }

    fn secant_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.derivative_into(t, [u, direction], false, out);
    }

    fn directed_bonds(&self) -> u64 {
        self.list.directed_bonds()
    }

    fn bytes(&self) -> usize {
        let gate = self.gate.as_ref().map_or(0, Gate::bytes);
        self.list.bytes() + size_of_val(&self.largest[..]) + gate
    }

    fn instruction_set(&self) -> InstructionSet {
        self.list.instruction_set()
    }

    fn use_instruction_set(&mut self, set: InstructionSet) {
        self.list.use_instruction_set(set);
    }

    fn lattice_springs(&self) -> Option<LatticeSprings> {
        self.list.lattice_springs()
    }

    /// Both ends of a bond must update its largest stretch at the same time, so the force is evaluated on the
    /// whole body.
    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            breaking: Some(self),
            bonds: Some(self),
            path_dependent: true,
            thermal: self.list.capabilities().thermal,
            ..Capabilities::default()
        }
    }

    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        Some(self)
    }

    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        self.list.expandable_mut()
    }

    /// The stiffness of the family of a point, to which strengths refer, must not change.
    fn growing_mut(&mut self) -> Option<&mut dyn Growing> {
        match self.gate {
            None => Some(&mut self.list),
            Some(_) => None,
        }
    }
}

/// Bonds have the damage at the end of the last step.
impl<L: VectorLaw, const D: usize> BondView for SofteningForce<L, D> {
    fn for_each_bond(&self, values: &BondValues, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let u = values.displacement();
        let list = &self.list;
        let (heat, sites) = (list.latest_heat(), list.bonds.form().sites());
        let bonds = list.view().heated(heat.as_deref().map(Vec::as_slice));
        let here = sites.of_point(i);
        for (entry, b) in list.bonds.intact_of(i) {
            let xi: [f64; D] = bonds.vector(here, b);
            let eta = u.difference::<D>([i, sites.point(b)]);
            let (free, pulled, scale) = bonds.relative::<L, D>(entry, [here, b], xi, eta);
            let stiffness = scale * self.retained(i, entry, b) * list.stiffness_of(entry, i, b);
            let force = L::force(free, pulled).map(|force| stiffness * force);
            visit(BondAt::new(sites.point(b), xi, eta, force).of_small_strain(L::LINEAR));
        }
    }

    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt)) {
        self.list.for_each_undeformed(i, visit);
    }
}
