//! Thermal expansion of correspondence materials: the stress-free state of a point is stretched by 1 + τ ([`Solid::expanded`](super::Solid::expanded)).

use std::sync::Arc;

use pericles::space::Sites;
use pericles::{Expandable, Result, ThermalExpansion};

use super::force::CorrespondenceForce;

/// Thermal stretches τ of own points and ghosts at a time; none of a body that is not heated.
pub(super) struct Heat(Option<Arc<Vec<f64>>>);

impl Heat {
    /// 1 + τ of a point.
    #[inline(always)]
    pub fn factor(&self, i: usize) -> f64 {
        self.0.as_ref().map_or(1.0, |stretches| 1.0 + stretches[i])
    }

    /// (1 + τ) ξ and η − τ ξ of a bond between two sites with the mean τ of its ends: the bond as its critical stretch sees it.
    #[inline(always)]
    pub fn expanded<const D: usize>(
        &self,
        sites: &Sites,
        ends: [usize; 2],
        xi: [f64; D],
        eta: [f64; D],
    ) -> ([f64; D], [f64; D]) {
        let Some(stretches) = &self.0 else {
            return (xi, eta);
        };
        let [here, there] = ends.map(|site| stretches[sites.point(site)]);
        let stretch = 0.5 * (here + there);
        let pulled = std::array::from_fn(|c| eta[c] - stretch * xi[c]);
        (xi.map(|x| (1.0 + stretch) * x), pulled)
    }
}

impl<const D: usize> CorrespondenceForce<D> {
    pub(super) fn heat_at(&self, t: f64) -> Heat {
        let expansion = self.expansion.as_ref();
        Heat(expansion.map(|expansion| expansion.stretches(t)))
    }

    /// At the time that forces were computed for last.
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
