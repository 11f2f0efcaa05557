//! Bond failure of inelastic solids by stress and strain.

use super::super::criterion::ForceStates;
use super::super::kinematics::Kinematics;
use super::force::InelasticSolidForce;
use crate::domain::Field;
use crate::material::Inelasticity;
use crate::operator::PointSubset;
use crate::step_end::StepEnd;

impl<L: Kinematics, const D: usize> InelasticSolidForce<L, D> {
    /// Returns the force states at time t for values of the pass over points.
    pub(super) fn force_states(&self, t: f64, values: &[f64]) -> ForceStates {
        let n = self.solid.cloud.len();
        let at_time = self.reliefs_at(t);
        let mut relief = match &at_time {
            Some(reliefs) => reliefs.to_vec(),
            None => self.history.inelastic.clone(),
        };
        for i in 0..n {
            let site = self.solid.bonds.form().site(i);
            let factor = match &self.laws.of_material[self.solid.classes.of_point(site)] {
                Inelasticity::Elastic => 0.0,
                Inelasticity::Plastic(_) => values[2 * n + i],
                Inelasticity::Viscous(_) => self.solid.states.stiffness[site],
            };
            for (entry, _) in self.solid.bonds.form().family(i) {
                relief[entry] *= factor;
            }
        }
        ForceStates {
            of_points: (0..n).map(|i| [values[n + i], values[2 * n + i]]).collect(),
            relief,
        }
    }

    /// Breaks bonds of the points `on` by the stress at the end of the step, before the intact bonds relax and flow,
    /// and sets the dilatations of the points `needed`.
    pub(super) fn break_by_criterion(
        &mut self,
        step: &StepEnd<'_>,
        u: Field<'_>,
        [on, needed]: [&PointSubset<'_>; 2],
        values: &mut [f64],
    ) {
        let n = self.solid.cloud.len();
        self.states_into(step.t, u, needed, values);
        self.solid
            .add_thermal_pulls(step.t, needed, &mut values[n..2 * n]);
        let states = self.force_states(step.t, values);
        let before = self.solid.bonds.broken_by_blocks();
        let broke = self.breaking_solid(|solid, stored| {
            solid.break_by_criterion(step, u, [on, needed], &states, Some(stored))
        });
        if broke {
            self.solid.dilatations_into(u, needed, &mut values[..n]);
            self.renew_sums(step, u, &before);
        }
    }
}
