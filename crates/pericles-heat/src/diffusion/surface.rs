//! Correction of incomplete families.

use pericles::space::PointCloud;

/// Returns the factor of each point with which the energy of unit gradients, averaged over the axes, is that of the
/// continuum. `moment(i)` is Σ_j κ_ij |ξ|² V_j for unit conductivity; a complete family has 2 d.
pub(super) fn factors(cloud: &PointCloud, moments: &[f64]) -> Vec<f64> {
    /// Deviations within rounding are complete families.
    const ROUNDING: f64 = 1e-10;
    let complete = 2.0 * cloud.dimension() as f64;
    let factor = |moment: &f64| match complete / moment {
        factor if !factor.is_finite() || (factor - 1.0).abs() < ROUNDING => 1.0,
        factor => factor,
    };
    moments.iter().map(factor).collect()
}
