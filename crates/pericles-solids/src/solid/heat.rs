//! What the temperature and the place of points determine: thermal stretches, and factors of yield stress and stiffness.

use std::sync::Arc;

use pericles::space::Sites;

/// Thermal stretches and factors of points at a time.
pub(super) struct Heat {
    /// Thermal stretches τ of own points and ghosts; `None` for a body without thermal expansion.
    pub stretches: Option<Arc<Vec<f64>>>,
    /// Yield stresses of own points relative to those of their materials, if they vary within a material.
    pub yields: Option<Arc<Vec<f64>>>,
}

/// Yield stress and hardening modulus of a point relative to those of its material, for unchanged elastic moduli.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YieldScale {
    /// Factor of the yield stress.
    pub stress: f64,
    /// Factor of the hardening modulus.
    pub hardening: f64,
}

impl YieldScale {
    /// The constants of the material.
    pub const ONE: Self = Self {
        stress: 1.0,
        hardening: 1.0,
    };
}

impl Heat {
    /// Returns τ of a point.
    #[inline(always)]
    pub fn stretch(&self, i: usize) -> f64 {
        self.stretches
            .as_ref()
            .map_or(0.0, |stretches| stretches[i])
    }

    /// Returns the factors of a point whose stiffness is multiplied by `stiffness`: the elastic law and the force state are
    /// those of the material, multiplied by it, so that the yield stress is divided by it before.
    #[inline(always)]
    pub fn yield_scale(&self, i: usize, stiffness: f64) -> YieldScale {
        YieldScale {
            stress: self.yields.as_ref().map_or(1.0, |yields| yields[i]) / stiffness,
            hardening: 1.0 / stiffness,
        }
    }

    /// Returns (1 + τ) ξ and η − τ ξ of a bond between two sites with the mean τ of its end points. The
    /// critical stretch refers to these vectors.
    #[inline(always)]
    pub fn expanded<const D: usize>(
        &self,
        sites: &Sites,
        ends: [usize; 2],
        xi: [f64; D],
        eta: [f64; D],
    ) -> ([f64; D], [f64; D]) {
        let Some(stretches) = &self.stretches else {
            return (xi, eta);
        };
        let [here, there] = ends.map(|site| stretches[sites.point(site)]);
        let stretch = 0.5 * (here + there);
        let pulled = std::array::from_fn(|c| eta[c] - stretch * xi[c]);
        (xi.map(|x| (1.0 + stretch) * x), pulled)
    }
}
