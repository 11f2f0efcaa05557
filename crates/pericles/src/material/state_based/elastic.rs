//! Elastic constants of an isotropic solid from any two of E, ν, K and G.

use crate::error::{PericlesError, Result, positive};
use crate::material::StressState;
use crate::units::quantity;

/// Elastic constants of an isotropic linear elastic solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticConstants {
    bulk: f64,
    shear: f64,
}

/// Given elastic constants: two of the four, or Young's modulus for a bar.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GivenConstants {
    /// Young's modulus E, Pa.
    pub young: Option<f64>,
    /// Poisson's ratio ν.
    pub poisson_ratio: Option<f64>,
    /// Bulk modulus K of the solid in three dimensions, Pa.
    pub bulk: Option<f64>,
    /// Shear modulus G, Pa.
    pub shear: Option<f64>,
}

/// Relative tolerance of redundant constants, which allows for rounding: 0.33 and 0.333 are accepted for one third.
const ROUNDING: f64 = 0.02;

impl ElasticConstants {
    /// Returns the constants of a solid with Young's modulus E (Pa) and Poisson's ratio ν: K = E/(3 (1 −
    /// 2ν)), G = E/(2 (1 + ν)).
    ///
    /// # Errors
    /// E that is not positive; ν outside −1 < ν < 1/2, where K or G is not positive.
    pub fn of_young(young: f64, poisson_ratio: f64) -> Result<Self> {
        positive("Young's modulus", young)?;
        check_poisson_ratio(poisson_ratio)?;
        Ok(Self {
            bulk: young / (3.0 * (1.0 - 2.0 * poisson_ratio)),
            shear: young / (2.0 * (1.0 + poisson_ratio)),
        })
    }

    /// Returns the constants of a solid with the bulk modulus K and the shear modulus G, Pa.
    ///
    /// # Errors
    /// Moduli that are not positive.
    pub fn of_moduli(bulk: f64, shear: f64) -> Result<Self> {
        Ok(Self {
            bulk: positive("the bulk modulus", bulk)?,
            shear: positive("the shear modulus", shear)?,
        })
    }

    /// Returns the bulk modulus K, Pa.
    pub fn bulk(&self) -> f64 {
        self.bulk
    }

    /// Returns the shear modulus G, Pa.
    pub fn shear(&self) -> f64 {
        self.shear
    }

    /// Returns Young's modulus E = 9 K G/(3 K + G), Pa.
    pub fn young(&self) -> f64 {
        9.0 * self.bulk * self.shear / (3.0 * self.bulk + self.shear)
    }

    /// Returns Poisson's ratio ν = (3 K − 2 G)/(2 (3 K + G)).
    pub fn poisson_ratio(&self) -> f64 {
        (3.0 * self.bulk - 2.0 * self.shear) / (2.0 * (3.0 * self.bulk + self.shear))
    }

    /// Returns the dilatation modulus κ in the dimension of the body, Pa: K in three dimensions, K + G/3 in
    /// plane strain, 9 K G/(3 K + 4 G) = E/(2 (1 − ν)) in plane stress, E in a bar.
    pub fn dilatation_modulus(&self, state: StressState) -> f64 {
        let Self { bulk, shear } = *self;
        match state {
            StressState::Uniaxial => self.young(),
            StressState::PlaneStress => 9.0 * bulk * shear / (3.0 * bulk + 4.0 * shear),
            StressState::PlaneStrain => bulk + shear / 3.0,
            StressState::Spatial => bulk,
        }
    }

    /// Returns ρ c² of longitudinal waves, Pa: E in a bar, E/(1 − ν²) in plane stress, K + 4 G/3 otherwise.
    pub fn longitudinal_modulus(&self, state: StressState) -> f64 {
        match state {
            StressState::Uniaxial => self.young(),
            StressState::PlaneStress => self.dilatation_modulus(state) + self.shear,
            _ => self.bulk + 4.0 / 3.0 * self.shear,
        }
    }
}

fn check_poisson_ratio(ratio: f64) -> Result<()> {
    if ratio > -1.0 && ratio < 0.5 {
        return Ok(());
    }
    Err(PericlesError::OutOfRange {
        quantity: "Poisson's ratio",
        value: ratio,
        allowed: "above -1 and below 0.5, where bulk and shear modulus are positive",
    })
}

impl GivenConstants {
    /// Returns the constants of the solid. A third and fourth constant must agree with the first two to 2 %
    /// and are otherwise ignored.
    ///
    /// # Errors
    /// Fewer than two constants (for a bar, none); constants that are not positive; inconsistent constants; ν
    /// outside −1 < ν < 1/2.
    pub fn resolve(&self, state: StressState) -> Result<ElasticConstants> {
        let reject = |reason: String| Err(PericlesError::ElasticConstants { reason });
        for (name, value) in [
            ("Young's modulus", self.young),
            ("the bulk modulus", self.bulk),
            ("the shear modulus", self.shear),
        ] {
            value.map_or(Ok(0.0), |value| positive(name, value))?;
        }
        let constants = match (self.young, self.poisson_ratio, self.bulk, self.shear) {
            (Some(young), Some(ratio), ..) => ElasticConstants::of_young(young, ratio)?,
            (_, _, Some(bulk), Some(shear)) => ElasticConstants::of_moduli(bulk, shear)?,
            (Some(young), _, Some(bulk), _) if young < 9.0 * bulk => {
                let shear = 3.0 * bulk * young / (9.0 * bulk - young);
                ElasticConstants::of_moduli(bulk, shear)?
            }
            (Some(young), _, _, Some(shear)) if young < 3.0 * shear => {
                let bulk = young * shear / (3.0 * (3.0 * shear - young));
                ElasticConstants::of_moduli(bulk, shear)?
            }
            (Some(young), _, Some(bulk), _) => {
                return reject(format!(
                    "Young's modulus {} must be below nine times the bulk modulus {}; otherwise the shear modulus is not positive",
                    quantity(young, "Pa"),
                    quantity(bulk, "Pa")
                ));
            }
            (Some(young), _, _, Some(shear)) => {
                return reject(format!(
                    "Young's modulus {} must be below three times the shear modulus {}; otherwise the bulk modulus is not positive",
                    quantity(young, "Pa"),
                    quantity(shear, "Pa")
                ));
            }
            (_, Some(ratio), Some(bulk), _) => {
                check_poisson_ratio(ratio)?;
                ElasticConstants::of_young(3.0 * bulk * (1.0 - 2.0 * ratio), ratio)?
            }
            (_, Some(ratio), _, Some(shear)) => {
                check_poisson_ratio(ratio)?;
                ElasticConstants::of_young(2.0 * shear * (1.0 + ratio), ratio)?
            }
            // A bar depends on Young's modulus only.
            (Some(young), ..) if state == StressState::Uniaxial => {
                ElasticConstants::of_young(young, 0.0)?
            }
            _ if state == StressState::Uniaxial => {
                return reject("a bar requires Young's modulus".into());
            }
            _ => {
                return reject(
                    "two of Young's modulus, Poisson's ratio, bulk modulus and shear modulus are required".into(),
                );
            }
        };
        self.check_agreement(&constants)?;
        Ok(constants)
    }

    /// Returns an error if a given constant contradicts the solid.
    fn check_agreement(&self, solid: &ElasticConstants) -> Result<()> {
        for (name, given, found) in [
            ("Young's modulus", self.young, solid.young()),
            ("the bulk modulus", self.bulk, solid.bulk),
            ("the shear modulus", self.shear, solid.shear),
        ] {
            if let Some(given) = given.filter(|given| (given / found - 1.0).abs() > ROUNDING) {
                return Err(PericlesError::ElasticConstants {
                    reason: format!(
                        "{name} is {}, but {} follows from the other constants; give two constants only",
                        quantity(given, "Pa"),
                        quantity(found, "Pa")
                    ),
                });
            }
        }
        let found = solid.poisson_ratio();
        match self.poisson_ratio {
            Some(given) if (given - found).abs() > ROUNDING => {
                Err(PericlesError::ElasticConstants {
                    reason: format!(
                        "Poisson's ratio is {given}, but {found:.4} follows from the other constants; give two constants only"
                    ),
                })
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_two_elastic_constants_give_the_same_solid() {
        let solid = ElasticConstants::of_young(10.0, 0.3).unwrap();
        let all = [
            solid.young(),
            solid.poisson_ratio(),
            solid.bulk(),
            solid.shear(),
        ];
        for first in 0..4 {
            for second in first + 1..4 {
                let given = |k: usize| (k == first || k == second).then_some(all[k]);
                let constants = GivenConstants {
                    young: given(0),
                    poisson_ratio: given(1),
                    bulk: given(2),
                    shear: given(3),
                };
                let found = constants.resolve(StressState::Spatial).unwrap();
                assert!(
                    (found.bulk() / solid.bulk() - 1.0).abs() < 1e-14,
                    "{constants:?}"
                );
                assert!(
                    (found.shear() / solid.shear() - 1.0).abs() < 1e-14,
                    "{constants:?}"
                );
            }
        }
        assert!((all[1] - 0.3).abs() < 1e-15);
    }

    #[test]
    fn moduli_in_plane_states_match_linear_elasticity() {
        let (young, nu) = (10.0, 0.3);
        let solid = ElasticConstants::of_young(young, nu).unwrap();
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-14, "{a} {b}");
        // ½ (σ_xx + σ_yy) for ε_xx = ε_yy = ½.
        close(
            solid.dilatation_modulus(StressState::PlaneStress),
            young / (2.0 * (1.0 - nu)),
        );
        let strain = young / (2.0 * (1.0 + nu) * (1.0 - 2.0 * nu));
        close(solid.dilatation_modulus(StressState::PlaneStrain), strain);
        close(
            solid.longitudinal_modulus(StressState::PlaneStress),
            young / (1.0 - nu * nu),
        );
        close(solid.dilatation_modulus(StressState::Uniaxial), young);
    }

    #[test]
    fn inconsistent_or_missing_elastic_constants_are_errors() {
        let resolve = |given: GivenConstants| given.resolve(StressState::PlaneStrain);
        let young = GivenConstants {
            young: Some(10.0),
            ..GivenConstants::default()
        };
        assert!(resolve(young).is_err());
        assert!(young.resolve(StressState::Uniaxial).is_ok());
        assert!(
            GivenConstants::default()
                .resolve(StressState::Uniaxial)
                .is_err()
        );
        for ratio in [0.5, -1.0, 0.7, f64::NAN] {
            let poisson_ratio = Some(ratio);
            assert!(
                resolve(GivenConstants {
                    poisson_ratio,
                    ..young
                })
                .is_err()
            );
        }
        let shear = GivenConstants {
            shear: Some(3.0),
            ..young
        };
        assert!(resolve(shear).is_err());
        let third = GivenConstants {
            shear: Some(4.0),
            poisson_ratio: Some(0.3),
            ..young
        };
        assert!(matches!(
            resolve(third),
            Err(PericlesError::ElasticConstants { .. })
        ));
        let agreeing = GivenConstants {
            shear: Some(3.85),
            poisson_ratio: Some(0.3),
            ..young
        };
        assert_eq!(
            resolve(agreeing).unwrap(),
            ElasticConstants::of_young(10.0, 0.3).unwrap()
        );
    }
}
