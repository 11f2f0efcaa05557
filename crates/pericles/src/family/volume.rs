//! Partial volumes of cells that the horizon cuts.

/// How much κ of a neighbour's volume counts, with Δx the mean size of the two cells.
///
/// Every correction is the mean of what the two ends of a bond see, so that both ends exert the same force on each other and momentum is
/// conserved to round-off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum VolumeCorrection {
    /// κ = 1 for |ξ| ≤ δ.
    None,
    /// κ = min(1, (δ + Δx/2 − |ξ|)/Δx) for |ξ| ≤ δ, as LAMMPS does.
    Linear,
    /// The same κ for all cells that reach into the horizon, |ξ| < δ + Δx/2.
    #[default]
    Extended,
}

impl VolumeCorrection {
    /// The factor κ of a bond of reference length r between cells of mean size `cell`.
    pub fn factor(self, r: f64, horizon: f64, cell: f64) -> f64 {
        let partial = ((horizon + 0.5 * cell - r) / cell).clamp(0.0, 1.0);
        match self {
            Self::None => 1.0,
            Self::Linear | Self::Extended => partial,
        }
    }

    /// The largest length of a bond: δ, or δ + Δx/2 for the extended correction. Lengths within 1e-9 of δ count as inside, because
    /// horizons are mostly whole multiples of the spacing.
    pub fn reach(self, horizon: f64, cell: f64) -> f64 {
        match self {
            Self::None | Self::Linear => horizon * (1.0 + 1e-9),
            // At |ξ| = δ + Δx/2 the factor is zero: leave such bonds out.
            Self::Extended => (horizon + 0.5 * cell) * (1.0 - 1e-9),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn partial_volumes() {
        let kappa = |correction: VolumeCorrection, r| correction.factor(r, 3.0, 1.0);
        assert_eq!(kappa(VolumeCorrection::None, 3.0), 1.0);
        assert_eq!(kappa(VolumeCorrection::Linear, 2.4), 1.0);
        assert_eq!(kappa(VolumeCorrection::Linear, 3.0), 0.5);
        assert_eq!(kappa(VolumeCorrection::Extended, 3.25), 0.25);
        assert!(VolumeCorrection::Linear.reach(3.0, 1.0) < 3.1);
        assert!(VolumeCorrection::Extended.reach(3.0, 1.0) > 3.49);
    }
}
