//! Passes over points and bonds of correspondence materials.

use pericles::domain::Field;
use pericles::lanes::Row;
use pericles::operator::{
    AtPoints, BondView, Breakable, Inversion, PlasticView, PointSubset, StressView, TwoPass,
};
use pericles::parallel::for_each_chunk_of;
use pericles::{Expandable, StepEnd, ThermalExpansion};

use super::bonds::{SiteState, Values};
use super::control::Control;
use super::force::CorrespondenceForce;
use super::tensor::{combination, principal_axes, product, unit};

impl<const D: usize> TwoPass for CorrespondenceForce<D> {
    fn values_per_point(&self) -> usize {
        self.value_count()
    }

    fn values_into(&self, t: f64, u: Field<'_>, on: &PointSubset<'_>, values: &mut [f64]) {
        self.all_values(t, u, on, values);
    }

    /// Computes the change of the push. The control is constant, and the change of the dilatation is not used.
    fn value_changes_into(&self, t: f64, u: Field<'_>, direction: Field<'_>, changes: &mut [f64]) {
        let heat = self.heat_at(t);
        let (rows, moved) = (self.packed(u), self.packed(direction));
        self.set_values(&PointSubset::All, changes, &|i| {
            let shape = &self.shapes[i];
            let gradient = self.gradient(i, &shape.inverse, &self.etas(i, &rows));
            let change = self.gradient(i, &shape.inverse, &self.etas(i, &moved));
            let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
            let history = self.history_of(i);
            let solid = self.classes.solid(i).expanded(heat.factor(i));
            let stress = solid.stress_change(&f, &change, &history);
            let push = product(&stress, &shape.inverse);
            let push = push.map(|row| row.map(|entry| shape.share * entry));
            let state = SiteState {
                push: combination(1.0, &push, -1.0, &shape.control.times(&change)),
                control: Control::NONE,
            };
            (state, 0.0)
        });
    }

    fn add_bond_force(&self, _t: f64, at: AtPoints<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        let (rows, states) = (self.packed(at.u), self.states(at.values));
        self.add_bonds(on, out, &|here, bond, sum| {
            let eta = Self::eta(&rows, here, bond);
            states[here].add_force(&states[bond.site], bond, &eta, sum);
        });
    }

    fn add_bond_tangent(&self, _t: f64, at: AtPoints<'_>, change: AtPoints<'_>, out: &mut [f64]) {
        let (rows, states) = (self.packed(change.u), self.states(at.values));
        let mut changes = self.states(change.values);
        for (change, state) in changes.iter_mut().zip(states.iter()) {
            change.control = state.control;
        }
        self.add_bonds(&PointSubset::All, out, &|here, bond, sum| {
            let eta = Self::eta(&rows, here, bond);
            changes[here].add_force(&changes[bond.site], bond, &eta, sum);
        });
    }

    fn add_energy_density(&self, t: f64, at: AtPoints<'_>, out: &mut [f64]) {
        let (rows, heat) = (self.packed(at.u), self.heat_at(t));
        for_each_chunk_of(
            out,
            self.bonds.list().cost(&PointSubset::All),
            &|first, out| {
                for (i, energy) in (first..).zip(out) {
                    *energy += self.energy_of(i, &self.shapes[i], &rows, &heat);
                }
            },
        );
    }

    /// Bounds the undeformed body by springs ω (k_i + k_j) V_i, to which Gershgorin's theorem applies: with
    /// the smallest principal value of K, H : H ≤ Σ ω |F ξ − ξ|²/K_min, so that W ≤ ½ k Σ ω |η|² where k is
    /// the larger of the stiffest modulus over K_min and the largest principal value of Z.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let spring = |i: usize| {
            let shape = &self.shapes[i];
            let (values, _) = principal_axes(&shape.inverse);
            let largest = values.into_iter().fold(0.0, f64::max);
            let stiffest = self.classes.constants(i).stiffest();
            (shape.share * stiffest * largest).max(shape.control.largest())
        };
        let springs: Vec<f64> = (0..self.cloud.len()).map(spring).collect();
        let springs = self.bonds.list().sites().spread(&springs);
        let mut largest: f64 = 0.0;
        for i in 0..self.cloud.len() {
            let (here, mut row) = (self.bonds.list().site(i), 0.0);
            self.bonds.for_each::<D>(i, self.bits(i), |bond| {
                row += bond.weight.abs() * (springs[here] + springs[bond.site]);
            });
            largest = largest.max(2.0 * row / density(i));
        }
        self.cloud.domain().max(largest).sqrt()
    }

    fn neighbours(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        let sites = self.bonds.list().sites();
        let mut points: Vec<usize> = Vec::new();
        self.bonds.for_each::<D>(i, self.bits_at_start(i), |bond| {
            points.push(sites.point(bond.site));
        });
        // With periodic images a point may be a neighbour more than once.
        points.sort_unstable();
        points.dedup();
        points.into_iter().filter(|&j| j != i).for_each(visit);
    }

    /// Breaks bonds first; plastic flow is computed with the remaining bonds.
    fn end_values_into(
        &mut self,
        step: &StepEnd<'_>,
        u: Field<'_>,
        on: &PointSubset<'_>,
        needed: &PointSubset<'_>,
        values: &mut [f64],
    ) {
        if self.can_break() {
            self.break_bonds(step, u, on);
        }
        if !self.history.is_empty() {
            self.advance_history(step.t, u, on);
        }
        self.all_values(step.t, u, needed, values);
        let n = self.cloud.len();
        let dilatations = &values[Values::dilatation::<D>() * n..][..n];
        self.inverted = None;
        on.for_each(n, |i| {
            if dilatations[i] <= -1.0 && self.inverted.is_none() {
                self.inverted = Some((i, dilatations[i]));
            }
        });
    }

    fn inversion(&self) -> Option<Inversion> {
        self.inverted.map(|(point, dilatation)| Inversion {
            point,
            volume_ratio: 1.0 + dilatation,
        })
    }

    fn breaking(&self) -> Option<&dyn Breakable> {
        Some(self)
    }

    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        Some(self)
    }

    fn dilatation(&self) -> Option<usize> {
        Some(Values::dilatation::<D>())
    }

    fn is_path_dependent(&self) -> bool {
        !self.history.is_empty()
    }

    fn thermal(&self) -> Option<&ThermalExpansion> {
        self.expansion.as_ref()
    }

    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        Some(self)
    }

    fn plastic(&self) -> Option<&dyn PlasticView> {
        (!self.history.is_empty()).then_some(self)
    }

    fn stress(&self) -> Option<&dyn StressView> {
        Some(self)
    }

    fn bonds(&self) -> Option<&dyn BondView> {
        Some(self)
    }

    fn directed_bonds(&self) -> u64 {
        self.bonds.list().directed_bonds()
    }

    fn bytes(&self) -> usize {
        let sites = self.bonds.list().sites().len();
        self.bonds.bytes()
            + size_of_val(&self.shapes[..])
            + size_of_val(&self.history[..])
            + sites * (size_of::<Row>() + size_of::<SiteState<D>>())
    }
}

impl<const D: usize> CorrespondenceForce<D> {
    fn bits_at_start(&self, i: usize) -> &[u8] {
        &self.bonds.list().present()[self.bonds.list().groups(i)]
    }
}
