//! States of stress and elastic moduli.

use crate::error::{PericlesError, Result, positive};

/// State of stress, which fixes Poisson's ratio of a bond-based material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StressState {
    /// A bar under axial stress.
    Uniaxial,
    /// A thin plate.
    PlaneStress,
    /// A slice of a long body.
    PlaneStrain,
    /// A body in space.
    Spatial,
}

impl StressState {
    /// Returns the dimension of bodies in this state.
    pub fn dimension(self) -> usize {
        match self {
            Self::Uniaxial => 1,
            Self::PlaneStress | Self::PlaneStrain => 2,
            Self::Spatial => 3,
        }
    }

    /// Returns Poisson's ratio of the bond-based material; `None` for a bar.
    pub fn poisson_ratio(self) -> Option<f64> {
        match self {
            Self::Uniaxial => None,
            Self::PlaneStress => Some(1.0 / 3.0),
            Self::PlaneStrain | Self::Spatial => Some(0.25),
        }
    }

    /// Returns ρ c² of longitudinal waves, Pa: E in a bar, 9/8 E in plane stress, 6/5 E otherwise.
    pub fn longitudinal_modulus(self, young: f64) -> f64 {
        match self {
            Self::Uniaxial => young,
            Self::PlaneStress => young * 9.0 / 8.0,
            Self::PlaneStrain | Self::Spatial => young * 6.0 / 5.0,
        }
    }

    /// Returns the name used in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniaxial => "a bar",
            Self::PlaneStress => "plane stress",
            Self::PlaneStrain => "plane strain",
            Self::Spatial => "three dimensions",
        }
    }

    /// Returns an error if a given Poisson's ratio is not the ratio of the bond-based material.
    pub fn check_poisson_ratio(self, given: f64) -> Result<()> {
        match self.poisson_ratio() {
            // The tolerance accepts 0.33 and 0.333 for one third.
            Some(fixed) if (given - fixed).abs() > 5e-3 || !given.is_finite() => {
                Err(PericlesError::PoissonRatio {
                    given,
                    state: self.name(),
                    fixed,
                })
            }
            _ => Ok(()),
        }
    }
}

/// One elastic modulus; the others follow from the fixed Poisson's ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ElasticModulus {
    /// Young's modulus E, Pa.
    Young(f64),
    /// Bulk modulus K, Pa (K = E / (3 (1 − 2ν)); not for bars).
    Bulk(f64),
    /// Shear modulus G, Pa (G = E / (2 (1 + ν)); not for bars).
    Shear(f64),
}

impl ElasticModulus {
    /// Returns Young's modulus, Pa.
    pub fn young(self, state: StressState) -> Result<f64> {
        let ratio = |what| {
            state.poisson_ratio().ok_or(PericlesError::WrongDimension {
                what,
                needed: "2 or 3; give Young's modulus for a bar",
                dimension: 1,
            })
        };
        match self {
            Self::Young(modulus) => positive("Young's modulus", modulus),
            Self::Bulk(modulus) => {
                let nu = ratio("a bulk modulus")?;
                Ok(positive("the bulk modulus", modulus)? * 3.0 * (1.0 - 2.0 * nu))
            }
            Self::Shear(modulus) => {
                let nu = ratio("a shear modulus")?;
                Ok(positive("the shear modulus", modulus)? * 2.0 * (1.0 + nu))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poisson_ratio_is_fixed_by_the_state_of_stress() {
        assert!(StressState::PlaneStress.check_poisson_ratio(0.33).is_ok());
        assert!(StressState::PlaneStress.check_poisson_ratio(0.25).is_err());
        assert!(StressState::Spatial.check_poisson_ratio(0.3).is_err());
        let young = |m: ElasticModulus, s| m.young(s).unwrap();
        assert!((young(ElasticModulus::Bulk(1.0), StressState::Spatial) - 1.5).abs() < 1e-15);
        assert!((young(ElasticModulus::Shear(2.0), StressState::PlaneStrain) - 5.0).abs() < 1e-15);
        assert!(
            ElasticModulus::Bulk(1.0)
                .young(StressState::Uniaxial)
                .is_err()
        );
    }
}
