//! Material of a surface: bonds whose force is a power of the relative displacement.

use pericles::{PericlesError, Result, positive};

/// Quantity that the bond force follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SurfaceBond {
    /// The difference of displacements, as in the paper; rigid rotations change the energy.
    #[default]
    Displacement,
    /// The elongation of the chord; invariant under rigid motions.
    Chord,
}

/// Constants of ρ u_tt = κ ∫ |η|^(p−2) η / d^(2+αp) dA′ + b over the points within the geodesic distance δ,
/// with η = u′ − u (Coclite, Coclite, Maddalena, Politi 2022). All terms are per area: the unit of κ is such
/// that the integral is in N/m².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerMaterial {
    /// Mass per area ρ, kg/m².
    pub density: f64,
    /// κ.
    pub kappa: f64,
    /// α, between 0 and 1.
    pub alpha: f64,
    /// p ≥ 2.
    pub p: f64,
    /// Horizon δ, m.
    pub horizon: f64,
    /// Quantity that the bond force follows.
    pub bond: SurfaceBond,
    /// Adds the self-interaction omitted by the sum: the integral over the disc of the point's own area, to
    /// first order in gradients. Only for p = 2 with [`SurfaceBond::Displacement`].
    pub self_interaction: bool,
    /// Critical stretch: largest |η|/d of an intact bond; infinite if bonds never break.
    pub critical_stretch: f64,
}

impl PowerMaterial {
    /// Validates all constants.
    ///
    /// # Errors
    /// α outside (0, 1), p below 2, a value that is not positive, or a self-interaction term with p ≠ 2 or
    /// another bond law.
    pub fn check(&self) -> Result<()> {
        positive("the density", self.density)?;
        positive("κ", self.kappa)?;
        positive("the horizon", self.horizon)?;
        let within = |quantity, value: f64, allowed, is| {
            if is {
                Ok(())
            } else {
                Err(PericlesError::OutOfRange {
                    quantity,
                    value,
                    allowed,
                })
            }
        };
        let alpha = self.alpha > 0.0 && self.alpha < 1.0;
        within("α", self.alpha, "above 0 and below 1", alpha)?;
        let p = self.p >= 2.0 && self.p.is_finite();
        within("p", self.p, "at least 2", p)?;
        let critical = self.critical_stretch > 0.0;
        within(
            "the critical stretch",
            self.critical_stretch,
            "a positive number, or infinity if bonds never break",
            critical,
        )?;
        if self.self_interaction && !Self::supports_self_interaction(self.p, self.bond) {
            return Err(PericlesError::OutOfRange {
                quantity: "the exponent p with the self-interaction term",
                value: self.p,
                allowed: "p = 2 with the force that follows displacements (the term is a Laplacian)",
            });
        }
        Ok(())
    }

    /// Weight w = κ / d^(2+αp) of a pair at distance d.
    pub fn weight(&self, distance: f64) -> f64 {
        self.kappa / distance.powf(2.0 + self.alpha * self.p)
    }

    /// Whether the self-interaction is available: for p = 2 it is a Laplacian of the displacement.
    pub fn supports_self_interaction(p: f64, bond: SurfaceBond) -> bool {
        p == 2.0 && bond == SurfaceBond::Displacement
    }

    /// Share of the force of a smooth field that the self-interaction of a vertex with this area has:
    /// (r/δ)^(p (1 − α)) with the radius r of a disc of this area. The sum over other points omits it, so that it is also the size of
    /// the dependence of the results on the mesh.
    pub fn self_interaction_share(&self, area: f64) -> f64 {
        let radius = (area / std::f64::consts::PI).sqrt();
        (radius / self.horizon).powf(self.p * (1.0 - self.alpha))
    }

    /// Stiffness c = κ π r^(2−2α)/(2 (2−2α)) of the self-interaction: for p = 2 the integral over a disc of
    /// this area and radius r, which the sum over other points omits, is c Δu to first order in gradients.
    pub fn self_interaction_stiffness(&self, area: f64) -> f64 {
        let radius = (area / std::f64::consts::PI).sqrt();
        let exponent = 2.0 - 2.0 * self.alpha;
        self.kappa * std::f64::consts::PI * radius.powf(exponent) / (2.0 * exponent)
    }
}
