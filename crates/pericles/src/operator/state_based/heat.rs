//! Thermal strain of linear peridynamic solids.
//!
//! The extensions of the bonds of a point are taken less τ r with the thermal stretch τ of the point itself. With M' = Σ ω r² over the bonds that are left, its dilatation is then θ − D τ M'/m and its force state pulls
//! at every bond with −τ (A D M'/m + B)/m beside the rest: a number of the point, with which the loops over bonds stay as they are.

use crate::thermal::ThermalExpansion;

/// What a heated solid keeps.
pub(super) struct Heat {
    pub expansion: ThermalExpansion,
    /// M' of own points, m⁵ for a dimensionless influence function.
    pub volume: Vec<f64>,
}

/// The stretch at which a bond with the thermal stretch τ breaks: its length over that without stress is then 1 + `limit`.
pub(super) fn heated_limit(limit: f64, stretch: f64) -> f64 {
    limit + stretch * (1.0 + limit)
}
