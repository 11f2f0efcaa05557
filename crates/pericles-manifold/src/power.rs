//! The material of a surface: bonds whose force is a power of the relative displacement.

use pericles::{PericlesError, Result, positive};

/// What the force of a bond follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SurfaceBond {
    /// The difference of displacements: rigid rotations cost energy, as in the paper.
    #[default]
    Displacement,
    /// The change of the chord's length: indifferent to rigid motions.
    Chord,
}

/// ρ u_tt = κ ∫ |η|^(p−2) η / d^(2+αp) dA′ + b over the points nearer than δ along the surface, with η = u′ − u
/// (Coclite, Coclite, Maddalena, Politi 2022), per area: κ in N/m^(2+p(1−α)) … such that the result is in N/m².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerMaterial {
    /// Mass per area ρ, kg/m².
    pub density: f64,
    /// κ.
    pub kappa: f64,
    /// α, between 0 and 1.
    pub alpha: f64,
    /// p, at least 2.
    pub p: f64,
    /// Horizon δ, m.
    pub horizon: f64,
    /// What the force follows.
    pub bond: SurfaceBond,
    /// Adds what the sum leaves out: the integral over the disc of the point's own area, to first order in gradients. For p = 2 and
    /// [`SurfaceBond::Displacement`] only.
    pub self_cell: bool,
    /// Largest |η|/d that a bond stands; infinite: bonds never break.
    pub critical_stretch: f64,
}

impl PowerMaterial {
    /// Checks every number.
    ///
    /// # Errors
    /// α outside (0, 1), p below 2, numbers that are not positive, a self-cell term with p ≠ 2 or another bond.
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
            "a positive number, or infinity for bonds that never break",
            critical,
        )?;
        if self.self_cell && (self.p != 2.0 || self.bond != SurfaceBond::Displacement) {
            return Err(PericlesError::OutOfRange {
                quantity: "p with the self-cell term",
                value: self.p,
                allowed: "2, with the force that follows displacements: the term is a Laplacian",
            });
        }
        Ok(())
    }

    /// w = κ / d^(2+αp), of a pair at distance d.
    pub fn weight(&self, distance: f64) -> f64 {
        self.kappa / distance.powf(2.0 + self.alpha * self.p)
    }

    /// c = κ π r^(2−2α)/(2 (2−2α)): for p = 2 the integral over a disc of this area, which the sum over other points leaves out, is c Δu to first order in
    /// gradients, r being the disc's radius.
    pub fn self_cell_stiffness(&self, area: f64) -> f64 {
        let radius = (area / std::f64::consts::PI).sqrt();
        let exponent = 2.0 - 2.0 * self.alpha;
        self.kappa * std::f64::consts::PI * radius.powf(exponent) / (2.0 * exponent)
    }
}
