//! Loads of a system.

use super::System;
use crate::boundary::{Load, PointValues, PrescribedMotion, ProportionalLoading};
use crate::error::Result;
use crate::parallel::PointSubset;

impl System {
    /// Adds a load.
    ///
    /// # Errors
    /// Points that the body does not have; values that are not one per loaded point and axis.
    pub fn add_load(&mut self, load: Load) -> Result<()> {
        load.check(self.dimension(), self.points())?;
        self.loads.push(load);
        Ok(())
    }

    /// The loads.
    pub fn loads(&self) -> &[Load] {
        &self.loads
    }

    /// Makes all loads multiples of their values at a reference time, for schemes that search the load of a state.
    pub fn load_proportionally(&mut self, loading: ProportionalLoading) {
        self.loading = Some(loading);
    }

    /// The factor of proportional loading.
    pub fn load_factor(&self) -> Option<f64> {
        self.loading.map(|loading| loading.factors[1])
    }

    /// Resultant force (N) of a load, given by its index, at time t.
    pub fn load_resultant(&self, load: usize, t: f64) -> [f64; 3] {
        let (t, factor) = ProportionalLoading::of(self.loading, t);
        self.loads[load]
            .resultant(t, &self.cloud)
            .map(|force| factor * force)
    }

    /// Computes loads at time t, N/m³.
    pub fn load_density_into(&self, t: f64, out: &mut [f64]) {
        self.zero(&PointSubset::All, out);
        self.add_loads(t, &PointSubset::All, out);
    }

    /// The values of loads and prescribed motions that are computed for all points at once.
    fn point_values(&self) -> impl Iterator<Item = &dyn PointValues> {
        let loads = self.loads.iter().filter_map(Load::values);
        loads.chain(self.motions.iter().flat_map(PrescribedMotion::values))
    }

    /// Returns whether an evaluation of a load or prescribed motion may fail.
    pub(crate) fn can_fail(&self) -> bool {
        self.point_values().any(|values| values.can_fail())
    }

    /// Returns whether an evaluation of a load or prescribed motion has failed.
    pub(crate) fn has_failed(&self) -> bool {
        self.point_values().any(|values| values.has_failed())
    }

    pub(super) fn add_loads(&self, t: f64, on: &PointSubset<'_>, out: &mut [f64]) {
        let at = ProportionalLoading::of(self.loading, t);
        for load in &self.loads {
            load.add_force(at, on, self.points(), self.dimension(), out);
        }
        self.hold_inactive(out);
    }
}
