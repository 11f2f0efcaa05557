//! [`Expandable`] for bond lists.

use super::force::BondForce;
use super::heat::Heat;
use crate::error::Result;
use crate::lanes::Row;
use crate::operator::fast_law::FastLaw;
use crate::operator::pool::Lent;
use crate::thermal::{Expandable, ThermalExpansion};

impl<L: FastLaw, const D: usize> BondForce<L, D> {
    /// Rows that begin with τ of all sites at a time; none of a body that is not heated.
    pub(super) fn heat_at(&self, t: f64) -> Option<Lent<'_, Vec<Row>>> {
        let heat = self.heat.as_ref()?;
        Some(heat.rows(&heat.expansion.stretches(t), self.bonds.sites()))
    }

    /// The same at the time that forces were computed for last.
    pub(super) fn latest_heat(&self) -> Option<Lent<'_, Vec<Row>>> {
        let heat = self.heat.as_ref()?;
        Some(heat.rows(&heat.expansion.latest(), self.bonds.sites()))
    }
}

impl<L: FastLaw, const D: usize> Expandable for BondForce<L, D> {
    fn expand(&mut self, expansion: ThermalExpansion) -> Result<()> {
        let sites = self.bonds.sites().len();
        self.heat = Some(Heat::new(expansion, sites));
        Ok(())
    }
}
