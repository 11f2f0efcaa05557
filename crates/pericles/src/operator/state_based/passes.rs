//! [`TwoPass`] and [`Breakable`] for linear peridynamic solids.

use super::bond_work::{KEPT, Worked};
use super::bonds::difference;
use super::breaking::heated_limit;
use super::force::LinearSolidForce;
use super::kernels::{dilatation_change_rows, force_rows, square_rows, tangent_rows};
use super::kinematics::Kinematics;
use crate::domain::Field;
use crate::lanes::{F64x8, LANES, Row};
use crate::material::PairForce;
use crate::neighbourhood::{BondSet, Form};
use crate::operator::pool::Lent;
use crate::operator::{
    AtPoints, BondView, Breakable, CoarseBreak, InstructionSet, PointSubset, TwoPass,
};
use crate::parallel::for_each_chunk;
use crate::step_end::StepEnd;
use crate::thermal::{Expandable, ThermalExpansion};

impl<L: Kinematics, const D: usize> TwoPass for LinearSolidForce<L, D> {
    /// The dilatation θ; in heated bodies also the thermal pull.
    fn values_per_point(&self) -> usize {
        1 + usize::from(self.heat.is_some())
    }

    fn values_into(&self, t: f64, u: Field<'_>, on: &PointSubset<'_>, values: &mut [f64]) {
        let (dilatations, pulls) = values.split_at_mut(self.cloud.len());
        self.dilatations_into(u, on, dilatations);
        self.thermal_pulls_into(t, on, pulls);
    }

    fn value_changes_into(&self, _t: f64, u: Field<'_>, direction: Field<'_>, changes: &mut [f64]) {
        let (bonds, factors) = (self.view(), &self.states.dilatation[..]);
        let (u, direction) = (self.packed(u), self.packed(direction));
        let (changes, pulls) = changes.split_at_mut(self.cloud.len());
        pulls.fill(0.0);
        self.sweep::<1>(&PointSubset::All, changes, |intact, rows, out| {
            let set = self.instruction_set;
            dilatation_change_rows::<L, D>(set, &bonds, factors, &u, &direction, intact, rows, out);
        });
    }

    fn add_bond_force(&self, _t: f64, at: AtPoints<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        let bonds = self.view();
        let u = self.packed_with(at.u, at.values);
        self.sweep::<D>(on, out, |intact, rows, out| {
            force_rows::<L, D>(self.instruction_set, &bonds, &u, intact, rows, out);
        });
    }

    fn add_bond_tangent(&self, _t: f64, at: AtPoints<'_>, change: AtPoints<'_>, out: &mut [f64]) {
        let bonds = self.view();
        let u = self.packed_with(at.u, at.values);
        let direction = self.packed_with(change.u, change.values);
        self.sweep::<D>(&PointSubset::All, out, |intact, rows, out| {
            let set = self.instruction_set;
            tangent_rows::<L, D>(set, &bonds, &u, &direction, intact, rows, out);
        });
    }

    fn add_energy_density(&self, t: f64, at: AtPoints<'_>, out: &mut [f64]) {
        let bonds = self.view();
        let mut squares = vec![0.0; self.cloud.len()];
        let u = self.packed(at.u);
        self.sweep::<1>(&PointSubset::All, &mut squares, |intact, rows, out| {
            square_rows::<L, D>(self.instruction_set, &bonds, &u, intact, rows, out);
        });
        let stretches = self.stretches(t);
        for_each_chunk(out, &|first, out| {
            for (i, energy) in (first..).zip(out) {
                let stretch = stretches.as_ref().map(|stretches| stretches[i]);
                let theta = at.values.owned[i];
                *energy += self.energy_at(i, stretch, [theta, squares[i]]);
            }
        });
    }

    /// The solid is softer than springs of the stiffness ω (k_i + k_j) V_i with k = (max(A D, 0) + g B)/m,
    /// which Gershgorin discs bound.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let bonds = self.view();
        let mut largest: f64 = 0.0;
        for i in 0..self.cloud.len() {
            let here = self.bonds.form().site(i);
            let row: f64 = self
                .bonds
                .intact_of(i)
                .map(|(entry, b)| {
                    let weight = bonds.weight_of(entry, [here, b], bonds.vector::<D>(here, b));
                    let factor = bonds.factor_of(entry);
                    let springs = [here, b].map(|site| self.states.spring::<D>(site, factor));
                    weight.abs() * (springs[0] + springs[1])
                })
                .sum();
            largest = largest.max(2.0 * row / density(i));
        }
        self.cloud.domain().max(largest).sqrt()
    }

    /// With thermal strain the force is affine: it does not vanish at rest.
    fn is_linear(&self) -> bool {
        L::LINEAR && self.heat.is_none()
    }

    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.bonds.form().for_each_neighbour(i, visit);
    }

    /// The critical stretch is evaluated in the pass over points, the bond energy afterwards, because it
    /// needs the dilatations of both ends.
    fn end_values_into(
        &mut self,
        step: &StepEnd<'_>,
        u: Field<'_>,
        on: &PointSubset<'_>,
        needed: &PointSubset<'_>,
        values: &mut [f64],
    ) {
        let all = matches!(on, PointSubset::All);
        let (values, pulls) = values.split_at_mut(self.cloud.len());
        if self.weakest.stretch.is_finite() {
            self.break_by_stretch(step, u, on, values);
            if !all {
                self.dilatations_into(u, needed, values);
            }
        } else {
            self.dilatations_into(u, needed, values);
        }
        if self.weakest.energy.is_finite() {
            self.break_by_energy(step, u, on, values);
            if !all {
                self.dilatations_into(u, needed, values);
            }
        }
        self.thermal_pulls_into(step.t, needed, pulls);
        if self.has_criteria() {
            let states = self.elastic_states(values, pulls);
            if self.break_by_criterion(step, u, [on, needed], &states) {
                self.dilatations_into(u, needed, values);
                self.thermal_pulls_into(step.t, needed, pulls);
            }
        }
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

    fn thermal(&self) -> Option<&ThermalExpansion> {
        self.heat.as_ref().map(|heat| &heat.expansion)
    }

    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        Some(self)
    }

    fn bonds(&self) -> Option<&dyn BondView> {
        Some(self)
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
}

impl<L: Kinematics, const D: usize> Breakable for LinearSolidForce<L, D> {
    fn bonds(&self) -> &dyn BondSet {
        &self.bonds
    }

    fn bonds_mut(&mut self) -> &mut dyn BondSet {
        &mut self.bonds
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        self.bonds.take_coarse_parts()
    }

    fn can_break(&self) -> bool {
        self.classes.can_break()
    }

    fn accumulates(&self) -> bool {
        self.weakest.energy.is_finite()
    }

    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        let ghosts = self.cloud.domain().ghosts(u);
        let u = Field::new(u, &ghosts);
        if self.has_criteria() {
            let states = self.latest_states(u);
            self.mark_by_criterion(u, &states, fraction, marks);
        }
        self.mark_by_limits(u, fraction, marks);
    }
}

impl<L: Kinematics, const D: usize> LinearSolidForce<L, D> {
    /// Returns rows of displacements; with failure by energy also of p.
    fn rows_of_limits(&self, u: Field<'_>) -> Lent<'_, Vec<Row>> {
        if self.influence.is_none() {
            return self.packed(u);
        }
        let mut dilatations = vec![0.0; self.cloud.len()];
        self.dilatations_into(u, &PointSubset::All, &mut dilatations);
        let ghosts = self.cloud.domain().ghosts(&dilatations);
        let (theta, sites) = (Field::new(&dilatations, &ghosts), self.bonds.form().sites());
        let pressure = &self.states.pressure;
        self.packed_beside(u, |site| {
            pressure[site] * theta.at::<1>(0, sites.point(site))
        })
    }

    /// Marks the points with a bond beyond a fraction of its critical stretch or energy. The work of a bond is that at the
    /// end of the last step plus the work along the straight path from there.
    pub(super) fn mark_by_limits(&self, u: Field<'_>, fraction: f64, marks: &mut [bool]) {
        let bonds = self.view();
        let worked = self
            .influence
            .as_ref()
            .map(|influence| Worked { bonds, influence });
        let u = self.rows_of_limits(u);
        let (stretches, sites) = (self.latest_stretches(), self.bonds.form().sites());
        let over = |i: usize, entry: usize, b: usize| {
            let a = self.bonds.form().site(i);
            let (xi, limits) = (bonds.vector::<D>(a, b), self.classes.limits(a, b));
            let thermal = stretches.as_ref().map_or(0.0, |stretches| {
                0.5 * [a, b]
                    .map(|site| stretches[sites.point(site)])
                    .iter()
                    .sum::<f64>()
            });
            let limit = heated_limit(fraction * limits.stretch, thermal);
            let (measure, square) = L::Measure::stretch_measure(xi, difference::<D>(&u, a, b));
            let worked = worked.as_ref().is_some_and(|worked| {
                let kept = |k: usize| self.work[entry / LANES * KEPT + k * LANES + entry % LANES];
                let stretch = L::exact_stretch(F64x8([measure / square; LANES])).0[0];
                let stiffness = &self.states.stiffness;
                let stiffness = bonds.factor_of(entry) * (stiffness[a] + stiffness[b]);
                let pull = stretch * stiffness + u[a][3] + u[b][3];
                let work = kept(0) + 0.5 * (pull + kept(1)) * (stretch - kept(2));
                // Compressed bonds never break.
                stretch > 0.0 && worked.bond_energy(entry, xi, work) > fraction * limits.energy
            });
            worked || measure > L::Measure::threshold(limit) * square
        };
        self.bonds.mark(marks, over);
    }
}
