//! [`Expandable`] for linear peridynamic solids.

use std::sync::Arc;

use super::force::LinearSolidForce;
use super::heat::Heat;
use super::kinematics::Kinematics;
use crate::error::{PericlesError, Result};
use crate::lanes::dot;
use crate::operator::PointSubset;
use crate::parallel::{BLOCK, for_each_point};
use crate::thermal::{Expandable, ThermalExpansion};

impl<L: Kinematics, const D: usize> LinearSolidForce<L, D> {
    /// Returns τ of own points and ghosts at time t, if the body is heated.
    pub(super) fn stretches(&self, t: f64) -> Option<Arc<Vec<f64>>> {
        Some(self.heat.as_ref()?.expansion.stretches(t))
    }

    /// Returns τ at the time of the last force evaluation.
    pub(super) fn latest_stretches(&self) -> Option<Arc<Vec<f64>>> {
        Some(self.heat.as_ref()?.expansion.latest())
    }

    /// Returns the contribution of the thermal stretch of a point to p, the pull of its force state that is
    /// the same for all bonds.
    pub(super) fn thermal_pull(&self, i: usize, stretch: f64) -> f64 {
        let heat = self.heat.as_ref();
        heat.map_or(0.0, |heat| {
            heat.pull(&self.states, [i, self.bonds.form().site(i)], stretch)
        })
    }

    /// Adds the thermal pulls of the points `on` to one value per point.
    pub(super) fn add_thermal_pulls(&self, t: f64, on: &PointSubset<'_>, pulls: &mut [f64]) {
        if let Some(heat) = &self.heat {
            heat.add_pulls(t, &self.states, |i| self.bonds.form().site(i), on, pulls);
        }
    }

    /// Sets the thermal pulls of the points `on` of a heated body; no effect for other bodies.
    pub(super) fn thermal_pulls_into(&self, t: f64, on: &PointSubset<'_>, pulls: &mut [f64]) {
        if self.heat.is_some() {
            on.for_each(pulls.len(), |i| pulls[i] = 0.0);
            self.add_thermal_pulls(t, on, pulls);
        }
    }

    /// Returns the energy density of a point with the dilatation θ and the sum Σ g ω e² of total extensions, J/m³.
    pub(super) fn energy_at(
        &self,
        i: usize,
        stretch: Option<f64>,
        [theta, squares]: [f64; 2],
    ) -> f64 {
        let place = [i, self.bonds.form().site(i)];
        match (&self.heat, stretch) {
            (Some(heat), Some(stretch)) => {
                heat.energy_density(&self.states, place, stretch, [theta, squares])
            }
            _ => self.states.energy_density(place, theta, squares),
        }
    }

    /// Returns the number of broken directed bonds per block, for heated bodies only.
    pub(super) fn broken_by_blocks(&self) -> Option<Vec<u64>> {
        self.heat.as_ref()?;
        Some(self.bonds.broken_by_blocks())
    }

    /// Updates M' in all blocks in which the number of broken bonds differs from `before`; in all blocks if
    /// `None`.
    pub(super) fn renew_volumes(&mut self, before: Option<Vec<u64>>) {
        let Some(mut heat) = self.heat.take() else {
            return;
        };
        let now = self.bonds.broken_by_blocks();
        let changed = |i: usize| {
            let block = i / BLOCK;
            let known = before
                .as_ref()
                .is_some_and(|before| before[block] == now[block]);
            !known || heat.volume.is_empty()
        };
        if before.as_ref() != Some(&now) {
            heat.volume = for_each_point(self.cloud.len(), &|i| match changed(i) {
                true => self.volume_left(i),
                false => heat.volume[i],
            });
        }
        self.heat = Some(heat);
    }

    /// Returns Σ ω r² over the intact bonds of a point.
    fn volume_left(&self, i: usize) -> f64 {
        let (bonds, here) = (self.view(), self.bonds.form().site(i));
        let of_bond = |(entry, b): (usize, usize)| {
            let xi = bonds.vector::<D>(here, b);
            bonds.weight_of(entry, [here, b], xi) * dot(xi, xi)
        };
        self.bonds.intact_of(i).map(of_bond).sum()
    }
}

impl<L: Kinematics, const D: usize> Expandable for LinearSolidForce<L, D> {
    /// # Errors
    /// Surface correction, or failure by bond energy.
    fn expand(&mut self, expansion: ThermalExpansion) -> Result<()> {
        let reject = |reason| {
            let form = "list";
            Err(PericlesError::FormNotUsable { form, reason })
        };
        if self.is_corrected() {
            return reject(
                "the surface correction of state-based materials does not include thermal strain; omit `surface_correction`",
            );
        }
        if self.weakest.energy.is_finite() {
            return reject(
                "failure by bond energy does not include thermal strain; use failure = \"stretch\"",
            );
        }
        self.heat = Some(Heat {
            expansion,
            volume: Vec::new(),
        });
        self.renew_volumes(None);
        Ok(())
    }
}
