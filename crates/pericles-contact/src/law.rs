//! The contact law: force, energy and stiffness of one contact.

use std::f64::consts::PI;

use pericles::Result;

use crate::error::ContactError;

/// Pairs of points between which contact acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ContactPairs {
    /// Pairs without an intact bond: different pieces, fragments, faces of cracks.
    #[default]
    Unbonded,
    /// Pairs of points of different pieces.
    Pieces,
    /// All pairs, also bonded ones: a barrier against points that pass each other in strongly compressed material.
    All,
}

/// Force of a contact as a function of the overlap g = d − r > 0, with the contact distance d and the distance r of the
/// points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum PairLaw {
    /// F = k g.
    #[default]
    Linear,
    /// F = k d (g/d)^p with the exponent p ≥ 1; p = 1.5 is the law of Hertz.
    Power(f64),
    /// F = k g with k = 15 c V_i V_j/δ and the micromodulus c of the material (Silling & Askari 2005). The stiffness
    /// decreases with the fifth power of the number of points in the horizon, so that points of fine horizons pass
    /// through each other.
    Emu,
}

impl PairLaw {
    /// Exponent p.
    pub fn exponent(self) -> f64 {
        match self {
            Self::Linear | Self::Emu => 1.0,
            Self::Power(exponent) => exponent,
        }
    }

    /// Returns the force (N) of an overlap `g` > 0 (m) with stiffness `k` (N/m) and contact distance `d` (m).
    #[inline]
    pub(crate) fn force(self, k: f64, d: f64, g: f64) -> f64 {
        match self {
            Self::Linear | Self::Emu => k * g,
            Self::Power(exponent) => k * d * power(g / d, exponent),
        }
    }

    /// Returns the stored energy (J) of an overlap with the force `force` (N).
    #[inline]
    pub(crate) fn energy(self, force: f64, g: f64) -> f64 {
        force * g / (self.exponent() + 1.0)
    }

    /// Returns dF/dg (N/m) of an overlap with the force `force` (N).
    #[inline]
    pub(crate) fn slope(self, force: f64, g: f64) -> f64 {
        self.exponent() * force / g
    }
}

/// x^p; without the general power function for the usual exponents.
#[inline]
fn power(x: f64, p: f64) -> f64 {
    if p == 1.5 {
        x * x.sqrt()
    } else if p == 2.0 {
        x * x
    } else {
        x.powf(p)
    }
}

/// Stiffness of contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactStiffness {
    /// k_i = χ E_i V_i/δ_i² of each point; a pair has the harmonic mean 2 k_i k_j/(k_i + k_j), which holds for springs
    /// of the two points in series.
    Relative(f64),
    /// The same k for all pairs, N/m.
    Absolute(f64),
}

impl Default for ContactStiffness {
    /// χ = 2.25: raises the highest frequency of a body by less than 9 %.
    fn default() -> Self {
        Self::Relative(2.25)
    }
}

/// Coulomb friction between points, regularised: F_t = −μ F_n w_t/√(w_t² + v²) with the tangential velocity w_t.
/// Between points and rigid bodies Coulomb's law holds exactly, and the speed is not used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Coefficient of friction μ.
    pub coefficient: f64,
    /// Speed v of regularisation, m/s: slower motion creeps.
    pub speed: f64,
}

/// The law of all contacts of a body.
///
/// ```text
/// g = d − r > 0:   F = k d (g/d)^p,   Φ = F g/(p + 1)
/// d = min(θ |ξ|, β (h_i + h_j)/2),    k_i = χ E_i V_i/δ_i²
/// ```
///
/// with the distance r of two points, their distance |ξ| in the reference configuration and the sizes h of their cells.
/// The minimum with θ |ξ| holds for all pairs: points closer than d at the start do not repel each other, and a bond that
/// breaks in tension is replaced by a contact without force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLaw {
    /// Pairs between which contact acts.
    pub pairs: ContactPairs,
    /// Force as a function of the overlap.
    pub law: PairLaw,
    /// Stiffness; not used by [`PairLaw::Emu`].
    pub stiffness: ContactStiffness,
    /// β: contact distance relative to the mean cell size of the two points.
    pub distance: f64,
    /// θ: largest contact distance relative to the distance of the points in the reference configuration.
    pub closing: f64,
    /// ζ: damping relative to the critical damping of a lone pair. It takes away the ringing of contacts; the energy
    /// lost in a collision of bodies hardly depends on it.
    pub damping: f64,
    /// Friction; `None` for smooth contact.
    pub friction: Option<Friction>,
}

impl Default for ContactLaw {
    /// Elastic contact of unbonded pairs without damping and friction.
    fn default() -> Self {
        Self {
            pairs: ContactPairs::Unbonded,
            law: PairLaw::Linear,
            stiffness: ContactStiffness::default(),
            distance: 1.0,
            closing: 1.0,
            damping: 0.0,
            friction: None,
        }
    }
}

impl ContactLaw {
    /// Returns whether all contact forces have a potential.
    pub fn is_conservative(&self) -> bool {
        self.damping == 0.0 && self.friction.is_none()
    }

    /// Checks all numbers.
    ///
    /// # Errors
    /// [`ContactError::Law`] with the allowed range.
    pub fn check(&self) -> Result<()> {
        let most = match self.pairs {
            ContactPairs::All => 0.9,
            ContactPairs::Unbonded | ContactPairs::Pieces => 1.0,
        };
        let closing = match self.pairs {
            ContactPairs::All => {
                "above 0 and at most 0.9 with all pairs: bonded points must not touch at rest"
            }
            _ => "above 0 and at most 1: a larger distance would add energy whenever a bond breaks",
        };
        let exponent = self.law.exponent();
        let stiffness = match self.stiffness {
            ContactStiffness::Relative(value) | ContactStiffness::Absolute(value) => value,
        };
        let friction = self.friction.unwrap_or(Friction {
            coefficient: 0.0,
            speed: 1.0,
        });
        let above = "above 0";
        let checks = [
            ("the exponent", exponent, exponent >= 1.0, "at least 1"),
            ("the stiffness", stiffness, stiffness > 0.0, above),
            ("the distance", self.distance, self.distance > 0.0, above),
            (
                "the closing ratio",
                self.closing,
                self.closing > 0.0 && self.closing <= most,
                closing,
            ),
            (
                "the damping",
                self.damping,
                self.damping >= 0.0,
                "at least 0",
            ),
            (
                "the coefficient of friction",
                friction.coefficient,
                friction.coefficient >= 0.0,
                "at least 0",
            ),
            (
                "the speed of the friction",
                friction.speed,
                friction.speed > 0.0,
                above,
            ),
        ];
        for (what, value, is_allowed, allowed) in checks {
            if !(is_allowed && value.is_finite()) {
                return Err(ContactError::Law {
                    what,
                    value,
                    allowed,
                }
                .into());
            }
        }
        Ok(())
    }
}

/// Micromodulus c (N/m⁶) of a material with Young's modulus `young` (Pa) in a body with horizon `horizon` (m) and section
/// `section` (m², m or 1 in one, two or three dimensions), constant influence function: 2E/(A δ²), 9E/(π t δ³),
/// 12E/(π δ⁴) (Silling & Askari 2005; plane stress).
pub(crate) fn micromodulus(dimension: usize, young: f64, horizon: f64, section: f64) -> f64 {
    match dimension {
        1 => 2.0 * young / (section * horizon.powi(2)),
        2 => 9.0 * young / (PI * section * horizon.powi(3)),
        _ => 12.0 * young / (PI * horizon.powi(4)),
    }
}

/// Returns the largest overlap relative to the spacing to be expected when bodies meet with the relative speed `speed`
/// (m/s): 0.28 N² (v/c) (2.25/χ), with the wave speed c (m/s) and N = δ/dx. It holds for bars, and for bars on walls.
/// Above one half the points may pass each other.
pub fn usual_overlap(speed: f64, wave_speed: f64, points_in_horizon: f64, stiffness: f64) -> f64 {
    0.28 * points_in_horizon.powi(2) * (speed / wave_speed) * (2.25 / stiffness)
}
