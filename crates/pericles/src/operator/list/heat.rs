//! Thermal stretch of listed bonds.
//!
//! A heated bond is a bond whose length without stress is (1 + τ)|ξ| with the mean τ of its ends: its force is c α κ V (1 + τ) times the pair force of the vectors (1 + τ) ξ and η − τ ξ, the gradient of (1 + τ) times
//! their energy. For the stretch s of a bond this is c α κ V (s − τ) n. It breaks where its length over that without stress exceeds the critical stretch.

use super::force::BondForce;
use crate::error::Result;
use crate::lanes::Row;
use crate::operator::fast_law::FastLaw;
use crate::operator::pool::{Lent, Pool};
use crate::space::Sites;
use crate::thermal::{Expandable, ThermalExpansion};

/// The thermal stretches of sites.
pub(super) struct Heat {
    pub expansion: ThermalExpansion,
    rows: Pool<Vec<Row>>,
}

impl Heat {
    fn rows(&self, stretches: &[f64], sites: &Sites) -> Lent<'_, Vec<Row>> {
        let mut rows = self.rows.take();
        for (site, row) in rows.iter_mut().enumerate() {
            row[0] = stretches[sites.point(site)];
        }
        rows
    }
}

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
        self.heat = Some(Heat {
            expansion,
            rows: Pool::new(1, move || vec![Row::default(); sites]),
        });
        Ok(())
    }
}
