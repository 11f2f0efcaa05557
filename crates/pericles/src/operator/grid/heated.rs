//! Thermal stretch of bonds on a lattice, as on a neighbour list.

use std::sync::Arc;

use super::force::GridForce;
use crate::domain::Field;
use crate::error::Result;
use crate::operator::fast_law::VectorLaw;
use crate::operator::{BondForm, Limit};
use crate::thermal::{Expandable, ThermalExpansion};

impl<L: VectorLaw, const D: usize> GridForce<L, D> {
    /// Returns τ of own points and ghosts at time t, if the body is heated.
    pub(super) fn stretches(&self, t: f64) -> Option<Arc<Vec<f64>>> {
        Some(self.expansion.as_ref()?.stretches(t))
    }

    /// Returns τ at the time of the last force evaluation.
    pub(super) fn latest_stretches(&self) -> Option<Arc<Vec<f64>>> {
        Some(self.expansion.as_ref()?.latest())
    }

    /// Returns values of own points and ghosts as a field.
    pub(super) fn field_of<'a>(&self, values: &'a [f64]) -> Field<'a> {
        let (own, ghosts) = values.split_at(self.cloud.len());
        Field::new(own, ghosts)
    }
}

impl<L: VectorLaw, const D: usize> Expandable for GridForce<L, D> {
    /// # Errors
    /// Forces in single precision.
    fn expand(&mut self, expansion: ThermalExpansion) -> Result<()> {
        if self.floats.is_some() {
            let features = Limit::THERMAL_EXPANSION.feature.into();
            let form = BondForm::FloatGrid;
            Limit::check(&[Limit::THERMAL_EXPANSION], form.name(), features)?;
        }
        self.expansion = Some(expansion);
        Ok(())
    }
}
