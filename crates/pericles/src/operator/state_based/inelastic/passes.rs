//! [`TwoPass`], [`Breakable`] and [`BondView`] for inelastic solids.

use super::super::kernels::dilatation_change_rows;
use super::super::kinematics::Kinematics;
use super::force::InelasticSolidForce;
use super::kernels::{force_rows, square_rows};
use super::tangent::{Along, change_rows, tangent_rows};
use crate::domain::Field;
use crate::neighbourhood::BondSet;
use crate::operator::{
    AtPoints, BondAt, BondValues, BondView, Breakable, CoarseBreak, InstructionSet, PlasticView,
    PointSubset, TwoPass,
};
use crate::parallel::for_each_chunk;
use crate::step_end::StepEnd;
use crate::thermal::{Expandable, ThermalExpansion};

impl<L: Kinematics, const D: usize> TwoPass for InelasticSolidForce<L, D> {
    /// The dilatation θ, P and S: the force state of a point has the pull P + S ψ − G R at a bond, where R is
    /// the contribution of the inelastic stretch at the end of the last step.
    fn values_per_point(&self) -> usize {
        3
    }

    fn values_into(&self, t: f64, u: Field<'_>, on: &PointSubset<'_>, values: &mut [f64]) {
        let n = self.solid.cloud.len();
        self.solid.dilatations_into(u, on, &mut values[..n]);
        self.states_into(t, u, on, values);
        self.solid.add_thermal_pulls(t, on, &mut values[n..2 * n]);
    }

    fn value_changes_into(&self, t: f64, u: Field<'_>, direction: Field<'_>, changes: &mut [f64]) {
        let (solid, n) = (&self.solid, self.solid.cloud.len());
        let (bonds, factors) = (solid.view(), &solid.states.dilatation[..]);
        let mut thetas = vec![0.0; n];
        solid.dilatations_into(u, &PointSubset::All, &mut thetas);
        let (u, direction) = (solid.packed(u), solid.packed(direction));
        let set = solid.instruction_set;
        solid.sweep::<1>(&PointSubset::All, &mut changes[..n], |intact, rows, out| {
            dilatation_change_rows::<L, D>(set, &bonds, factors, &u, &direction, intact, rows, out);
        });
        let points = self.points(t);
        let along = Along {
            u: &u,
            direction: &direction,
        };
        solid.sweep::<3>(&PointSubset::All, changes, |intact, rows, out| {
            change_rows::<L, D>(set, &bonds, &points, &thetas, &along, intact, rows, out);
        });
    }

    fn add_bond_force(&self, t: f64, at: AtPoints<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        let (solid, at_time) = (&self.solid, self.reliefs_at(t));
        let (bonds, states) = (solid.view(), self.state_rows(at.values, false));
        let reliefs = self.reliefs(&at_time, &states);
        let u = self.packed_with(at.u, at.values);
        solid.sweep::<D>(on, out, |intact, rows, out| {
            let set = solid.instruction_set;
            force_rows::<L, D>(set, &bonds, &reliefs, &u, intact, rows, out);
        });
    }

    fn add_bond_tangent(&self, t: f64, at: AtPoints<'_>, change: AtPoints<'_>, out: &mut [f64]) {
        let (solid, at_time) = (&self.solid, self.reliefs_at(t));
        let (bonds, states) = (solid.view(), self.state_rows(at.values, false));
        let changes = self.state_rows(change.values, true);
        let reliefs = self.reliefs(&at_time, &states);
        let u = self.packed_with(at.u, at.values);
        let direction = self.packed_with(change.u, change.values);
        let along = Along {
            u: &u,
            direction: &direction,
        };
        solid.sweep::<D>(&PointSubset::All, out, |intact, rows, out| {
            let set = solid.instruction_set;
            tangent_rows::<L, D>(set, &bonds, &reliefs, &changes, &along, intact, rows, out);
        });
    }

    /// The free energy with the inelastic stretches at the end of the last step.
    fn add_energy_density(&self, t: f64, at: AtPoints<'_>, out: &mut [f64]) {
        let solid = &self.solid;
        let (bonds, points) = (solid.view(), self.points(t));
        let mut squares = vec![0.0; solid.cloud.len()];
        let u = solid.packed(at.u);
        solid.sweep::<1>(&PointSubset::All, &mut squares, |intact, rows, out| {
            let set = solid.instruction_set;
            square_rows::<L, D>(set, &bonds, &points, &u, intact, rows, out);
        });
        let stretches = solid.stretches(t);
        for_each_chunk(out, &|first, out| {
            for (i, energy) in (first..).zip(out) {
                let stretch = stretches.as_ref().map(|stretches| stretches[i]);
                let law =
                    &self.laws.of_material[solid.classes.of_point(solid.bonds.form().site(i))];
                let inelastic = self.history.inelastic_sum(law, i);
                let sums = [at.values.owned[i], squares[i], inelastic];
                *energy += solid.energy_at(i, stretch, sums);
            }
        });
    }

    /// Viscosity and plasticity reduce the stiffness: the bound of the elastic solid holds.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        self.solid.frequency_bound(density)
    }

    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        TwoPass::neighbours(&self.solid, i, visit);
    }

    /// Bonds break before the intact ones relax and flow. A point that loses bonds is then on its yield
    /// surface at the end of the step: for influence functions other than the constant one, lost bonds can
    /// leave a force state outside of it.
    fn end_values_into(
        &mut self,
        step: &StepEnd<'_>,
        u: Field<'_>,
        on: &PointSubset<'_>,
        needed: &PointSubset<'_>,
        values: &mut [f64],
    ) {
        let n = self.solid.cloud.len();
        self.break_bonds(step, u, [on, needed], &mut values[..n]);
        if self.solid.has_criteria() {
            self.break_by_criterion(step, u, [on, needed], values);
        }
        self.advance(step, u, on);
        self.states_into(step.t, u, needed, values);
        let pulls = &mut values[n..2 * n];
        self.solid.add_thermal_pulls(step.t, needed, pulls);
    }

    fn breaking(&self) -> Option<&dyn Breakable> {
        Some(self)
    }

    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        Some(self)
    }

    fn dilatation(&self) -> Option<usize> {
        Some(0)
    }

    fn is_path_dependent(&self) -> bool {
        true
    }

    fn thermal(&self) -> Option<&ThermalExpansion> {
        self.solid.thermal()
    }

    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        Some(&mut self.solid)
    }

    fn plastic(&self) -> Option<&dyn PlasticView> {
        self.laws.yields().then_some(self)
    }

    fn bonds(&self) -> Option<&dyn BondView> {
        Some(self)
    }

    fn directed_bonds(&self) -> u64 {
        self.solid.directed_bonds()
    }

    fn bytes(&self) -> usize {
        self.solid.bytes() + self.own_bytes()
    }

    fn instruction_set(&self) -> InstructionSet {
        self.solid.instruction_set
    }

    fn use_instruction_set(&mut self, set: InstructionSet) {
        self.solid.use_instruction_set(set);
    }
}

/// As for the elastic solid; energy dissipated by inelastic stretches is added to that of breaking bonds.
impl<L: Kinematics, const D: usize> Breakable for InelasticSolidForce<L, D> {
    fn bonds(&self) -> &dyn BondSet {
        &self.solid.bonds
    }

    fn bonds_mut(&mut self) -> &mut dyn BondSet {
        &mut self.solid.bonds
    }

    fn can_break(&self) -> bool {
        self.solid.can_break()
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        self.solid.take_coarse_breaks()
    }

    /// Force states are those for the history at the end of the last step.
    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        let u = Field::new(u, &[]);
        self.solid.mark_by_limits(u, fraction, marks);
        if self.solid.has_criteria() {
            let t = self.history.time.iter().copied().fold(0.0, f64::max);
            let mut values = vec![0.0; 3 * self.solid.cloud.len()];
            self.values_into(t, u, &PointSubset::All, &mut values);
            let states = self.force_states(t, &values);
            self.solid.mark_by_criterion(u, &states, fraction, marks);
        }
    }
}

impl<L: Kinematics, const D: usize> PlasticView for InelasticSolidForce<L, D> {
    fn plastic_strain_into(&self, out: &mut [f64]) {
        out.copy_from_slice(self.plastic_strain());
    }
}

/// Bonds have the inelastic stretches at the end of the last step.
impl<L: Kinematics, const D: usize> BondView for InelasticSolidForce<L, D> {
    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt)) {
        self.solid.for_each_undeformed(i, visit);
    }

    fn values_at(&self, u: Field<'_>) -> BondValues {
        self.solid.values_at(u)
    }

    fn for_each_bond(&self, values: &BondValues, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let (bonds, stiffness) = (self.solid.bonds.form(), &self.solid.states.stiffness);
        let relief = |i: usize, entry: usize| {
            let back = self.history.opposite[entry] as usize;
            let [forth, back] = [entry, back].map(|entry| self.history.inelastic[entry]);
            let (here, there) = (bonds.site(i), bonds.neighbour(entry));
            stiffness[here] * forth + stiffness[there] * back
        };
        self.solid.visit_bonds(values, i, &relief, visit);
    }
}
