//! Viscosity and plasticity of linear peridynamic solids.

use pericles::material::StressState;
use pericles::{PericlesError, Result, positive};

use crate::solid::YieldScale;

/// Inelastic law of the deviatoric part of a linear peridynamic solid; its dilatation is elastic.
///
/// The deviatoric extension of a bond with extension e is e_d = e − θ r/D, with the dilatation θ of the point
/// that owns the force state. Each directed bond stores an inelastic extension e_x, and the force state is
/// t = (w/m)(A θ r + B (e − e_x)).
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Inelasticity {
    /// The solid is elastic.
    #[default]
    Elastic,
    /// Viscoelastic shear: e_x = Σ λ_k e_k with back-extensions de_k/dt = (e_d − e_k)/τ_k (Mitchell, Sandia
    /// report SAND2011-8064, 2011). The relaxation function of the shear modulus is G(t)/G = 1 − Σ λ_k + Σ
    /// λ_k exp(−t/τ_k).
    Viscous(Vec<ViscousTerm>),
    /// Elastoplastic shear: e_x is a plastic extension (Mitchell, Sandia report SAND2011-3166, 2011).
    Plastic(Yield),
}

/// A term of a relaxation function: the share λ of the shear modulus relaxes with the time τ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViscousTerm {
    /// λ, between 0 and 1.
    pub share: f64,
    /// τ, s.
    pub time: f64,
}

/// Yield criterion and hardening. A point yields when the norm |t| = (Σ t² b V)^½ of the deviatoric force
/// state reaches its value for a uniform strain at the yield point, √(2 ψ₀) = σ_y (c M₂)^½/m with M₂ = Σ w²
/// r², c = 5 in three dimensions and 8/3 in the plane.
///
/// In three dimensions this is the von Mises criterion for uniform strains, exact in the mean over all
/// directions. In the plane, bonds depend only on the in-plane deviator: the body yields where the largest
/// in-plane shear stress reaches σ_y/√3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Yield {
    /// Yield stress σ_y in uniaxial tension, Pa.
    pub stress: f64,
    /// Isotropic hardening H, Pa: the yield stress is σ_y + H ε_p, with the equivalent plastic strain ε_p.
    pub hardening: f64,
}

impl Yield {
    /// Returns the criterion of a point whose constants are multiplied by factors.
    pub(super) fn scaled(&self, scale: YieldScale) -> Self {
        Self {
            stress: scale.stress * self.stress,
            hardening: scale.hardening * self.hardening,
        }
    }
}

/// Largest number of terms of a relaxation function.
pub const MOST_TERMS: usize = 8;

impl Inelasticity {
    /// Returns whether the solid is elastic.
    pub fn is_elastic(&self) -> bool {
        *self == Self::Elastic
    }

    /// Returns the terms of the relaxation function.
    pub fn terms(&self) -> &[ViscousTerm] {
        match self {
            Self::Viscous(terms) => terms,
            Self::Elastic | Self::Plastic(_) => &[],
        }
    }

    /// Returns an error if a constant is out of range.
    ///
    /// # Errors
    /// Shares that are not positive or whose sum is not below one; times or yield stresses that are not
    /// positive; negative hardening; no terms, or more than [`MOST_TERMS`]; a bar, which has no deviatoric
    /// strain.
    pub fn check(&self, state: StressState) -> Result<()> {
        if !self.is_elastic() && state == StressState::Uniaxial {
            return Err(PericlesError::WrongDimension {
                what: "viscosity or plasticity of shear",
                needed: "2 or 3",
                dimension: 1,
            });
        }
        match self {
            Self::Elastic => Ok(()),
            Self::Viscous(terms) => check_terms(terms),
            Self::Plastic(law) => {
                positive("the yield stress", law.stress)?;
                if law.hardening.is_finite() && law.hardening >= 0.0 {
                    return Ok(());
                }
                Err(PericlesError::OutOfRange {
                    quantity: "the hardening modulus",
                    value: law.hardening,
                    allowed: "0 or a positive number",
                })
            }
        }
    }
}

fn check_terms(terms: &[ViscousTerm]) -> Result<()> {
    if terms.is_empty() || terms.len() > MOST_TERMS {
        return Err(PericlesError::OutOfRange {
            quantity: "the number of viscous terms",
            value: terms.len() as f64,
            allowed: "1 to 8",
        });
    }
    for term in terms {
        positive("the share of a viscous term", term.share)?;
        positive("the relaxation time of a viscous term", term.time)?;
    }
    let sum: f64 = terms.iter().map(|term| term.share).sum();
    if sum < 1.0 {
        return Ok(());
    }
    Err(PericlesError::OutOfRange {
        quantity: "the sum of the shares of all viscous terms",
        value: sum,
        allowed: "a number below 1, so that the long-term shear modulus is positive",
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_inelastic_constants_contain_the_value() {
        let viscous = |terms: &[[f64; 2]]| {
            let terms = terms
                .iter()
                .map(|&[share, time]| ViscousTerm { share, time });
            Inelasticity::Viscous(terms.collect())
        };
        let plastic = |stress, hardening| Inelasticity::Plastic(Yield { stress, hardening });
        for (law, words) in [
            (viscous(&[]), "number of viscous terms is 0"),
            (viscous(&[[0.1, 1.0]; 9]), "number of viscous terms is 9"),
            (viscous(&[[0.0, 1.0]]), "share of a viscous term"),
            (viscous(&[[0.5, -1.0]]), "relaxation time"),
            (viscous(&[[0.5, 1.0], [0.5, 2.0]]), "all viscous terms is 1"),
            (plastic(0.0, 0.0), "yield stress"),
            (plastic(1.0, -2.0), "hardening modulus is -2"),
        ] {
            let message = law.check(StressState::Spatial).unwrap_err().to_string();
            assert!(message.contains(words), "{message}");
        }
        for law in [viscous(&[[0.5, 1.0], [0.4, 2.0]]), plastic(1.0, 0.0)] {
            assert!(law.check(StressState::PlaneStrain).is_ok());
            let message = law.check(StressState::Uniaxial).unwrap_err().to_string();
            assert!(message.contains("dimension 2 or 3"), "{message}");
        }
    }
}
