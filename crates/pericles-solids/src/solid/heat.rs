//! Thermal stretches of points.

use std::sync::Arc;

use pericles::space::Sites;

/// Thermal stretches τ of own points and ghosts at a time; `None` for a body without thermal expansion.
pub(super) struct Heat(pub Option<Arc<Vec<f64>>>);

impl Heat {
    /// Returns τ of a point.
    #[inline(always)]
    pub fn stretch(&self, i: usize) -> f64 {
        self.0.as_ref().map_or(0.0, |stretches| stretches[i])
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
        let Some(stretches) = &self.0 else {
            return (xi, eta);
        };
        let [here, there] = ends.map(|site| stretches[sites.point(site)]);
        let stretch = 0.5 * (here + there);
        let pulled = std::array::from_fn(|c| eta[c] - stretch * xi[c]);
        (xi.map(|x| (1.0 + stretch) * x), pulled)
    }
}
