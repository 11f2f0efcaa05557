//! Volume correction of cells cut by the horizon.

/// Fraction κ of a neighbour's volume that counts; Δx is the mean size of the two cells.
///
/// The factor of a bond is the mean of the values of its two ends, so that both ends exert the same force on each
/// other and momentum is conserved to round-off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum VolumeCorrection {
    /// κ = 1 for |ξ| ≤ δ.
    None,
    /// κ = min(1, (δ + Δx/2 − |ξ|)/Δx) for |ξ| ≤ δ, as in LAMMPS.
    Linear,
    /// The same κ for all cells that overlap the horizon, |ξ| < δ + Δx/2.
    #[default]
    Extended,
}

impl VolumeCorrection {
    /// Returns κ for a bond of reference length r between cells of mean size `cell`.
    pub fn factor(self, r: f64, horizon: f64, cell: f64) -> f64 {
        let partial = ((horizon + 0.5 * cell - r) / cell).clamp(0.0, 1.0);
        match self {
            Self::None => 1.0,
            Self::Linear | Self::Extended => partial,
        }
    }

    /// Largest length of a bond: δ, or δ + Δx/2 for the extended correction. Lengths up to δ (1 + 1e-9) count as
    /// inside, because horizons are usually whole multiples of the spacing.
    pub fn reach(self, horizon: f64, cell: f64) -> f64 {
        match self {
            Self::None | Self::Linear => horizon * (1.0 + 1e-9),
            // At |ξ| = δ + Δx/2 the factor is zero, so that such bonds are left out.
            Self::Extended => (horizon + 0.5 * cell) * (1.0 - 1e-9),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volume_fractions_of_all_corrections() {
        let kappa = |correction: VolumeCorrection, r| correction.factor(r, 3.0, 1.0);
        assert_eq!(kappa(VolumeCorrection::None, 3.0), 1.0);
        assert_eq!(kappa(VolumeCorrection::Linear, 2.4), 1.0);
        assert_eq!(kappa(VolumeCorrection::Linear, 3.0), 0.5);
        assert_eq!(kappa(VolumeCorrection::Extended, 3.25), 0.25);
        assert!(VolumeCorrection::Linear.reach(3.0, 1.0) < 3.1);
        assert!(VolumeCorrection::Extended.reach(3.0, 1.0) > 3.49);
    }
}
