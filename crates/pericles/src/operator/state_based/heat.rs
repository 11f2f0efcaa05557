//! Thermal strain of linear peridynamic solids.
//!
//! The extensions of the bonds of a point are reduced by τ r with the thermal stretch τ of the point. With
//! M' = Σ ω r² over the intact bonds, its dilatation is then θ − D τ M'/m, and its force state has the
//! additional pull −τ (A D M'/m + B)/m at every bond. This is a number per point, so that the loops over
//! bonds are unchanged.

use crate::thermal::ThermalExpansion;

/// Data of a heated solid.
pub(super) struct Heat {
    pub expansion: ThermalExpansion,
    /// M' of own points, m⁵ for a dimensionless influence function.
    pub volume: Vec<f64>,
}

/// Returns the stretch at which a bond with the thermal stretch τ breaks: the ratio of its length to the
/// stress-free length is then 1 + `limit`.
pub(super) fn heated_limit(limit: f64, stretch: f64) -> f64 {
    limit + stretch * (1.0 + limit)
}
