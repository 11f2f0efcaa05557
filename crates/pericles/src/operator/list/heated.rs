//! [`Expandable`] for neighbour lists.

use super::force::BondForce;
use super::heat::Heat;
use crate::error::Result;
use crate::lanes::Row;
use crate::operator::fast_law::VectorLaw;
use crate::operator::pool::Lent;
use crate::thermal::{Expandable, ThermalExpansion};

impl<L: VectorLaw, const D: usize> BondForce<L, D> {
    /// Returns rows that begin with τ of each site at time t; `None` for a body without thermal expansion.
    pub(super) fn heat_at(&self, t: f64) -> Option<Lent<'_, Vec<Row>>> {
        let heat = self.heat.as_ref()?;
        Some(heat.rows(&heat.expansion.stretches(t), self.bonds.form().sites()))
    }

    /// Returns these rows at the time of the last force evaluation.
    pub(super) fn latest_heat(&self) -> Option<Lent<'_, Vec<Row>>> {
        let heat = self.heat.as_ref()?;
        Some(heat.rows(&heat.expansion.latest(), self.bonds.form().sites()))
    }
}

impl<L: VectorLaw, const D: usize> Expandable for BondForce<L, D> {
    fn expand(&mut self, expansion: ThermalExpansion) -> Result<()> {
        let sites = self.bonds.form().sites().len();
        self.heat = Some(Heat::new(expansion, sites));
        Ok(())
    }
}
