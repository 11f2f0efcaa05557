//! Thermal expansion of correspondence forces ([`Expandable`]).

use pericles::{Expandable, Result, ThermalExpansion};

use super::force::CorrespondenceForce;
use super::heat::Heat;

impl<const D: usize> CorrespondenceForce<D> {
    pub(super) fn heat_at(&self, t: f64) -> Heat {
        let expansion = self.expansion.as_ref();
        Heat(expansion.map(|expansion| expansion.stretches(t)))
    }

    /// Returns the thermal stretches at the time of the last force evaluation.
    pub(super) fn latest_heat(&self) -> Heat {
        Heat(self.expansion.as_ref().map(ThermalExpansion::latest))
    }
}

impl<const D: usize> Expandable for CorrespondenceForce<D> {
    fn expand(&mut self, expansion: ThermalExpansion) -> Result<()> {
        self.expansion = Some(expansion);
        Ok(())
    }
}
