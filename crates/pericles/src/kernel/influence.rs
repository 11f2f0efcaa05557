//! Influence functions: shape and the quantity they multiply.

use super::ClassTable;
use crate::error::{PericlesError, Result, positive};
use crate::units::precise;

/// Shape g(r) of an influence function; δ is the horizon.
#[derive(Debug, Clone, PartialEq)]
pub enum InfluenceFunction {
    /// g = 1.
    Constant,
    /// g = 1 − r/δ.
    Conical,
    /// g = 1/r.
    Inverse,
    /// g = (r/δ)^exponent.
    Power {
        /// Any exponent for which the modulus is finite (see [`Influence::check`]).
        exponent: f64,
    },
    /// g = exp(−(r/length)²) up to the cut-off, zero beyond.
    Gaussian {
        /// The length l, m.
        length: f64,
        /// Cut-off, m; at most the horizon, which is the default.
        cutoff: Option<f64>,
    },
    /// Piecewise linear interpolation of (r, g), constant before the first and after the last entry.
    Tabulated {
        /// Pairs (r in m, g) with increasing r.
        table: Vec<(f64, f64)>,
    },
    /// g = a₀ + Σ_j a_j cos(j wavenumber r).
    Cosines {
        /// Wavenumber of the first cosine, rad/m.
        wavenumber: f64,
        /// a₀, a₁ …
        coefficients: Vec<f64>,
    },
    /// A value per class of lattice bonds, as obtained by tuning against the dispersion relation; not necessarily a
    /// function of r.
    Classes(ClassTable),
}

/// The quantity that the influence function multiplies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ActsOn {
    /// The stretch s: α = g, force density c g s. In 1D the micromodulus is C(r) = c g(r) / r.
    #[default]
    Stretch,
    /// The relative displacement r s: force density c g r s, that is α = r g. In 1D the micromodulus is C(r) = c
    /// g(r).
    Displacement,
}

/// The influence function of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct Influence {
    /// Its shape.
    pub function: InfluenceFunction,
    /// The quantity it multiplies.
    pub acts_on: ActsOn,
}

impl Default for Influence {
    fn default() -> Self {
        Self {
            function: InfluenceFunction::Constant,
            acts_on: ActsOn::Stretch,
        }
    }
}

impl Influence {
    /// Returns α at reference length r (m). Cells that overlap the horizon with their centre beyond it take the
    /// value at the horizon, where their partial volume lies.
    pub fn alpha(&self, r: f64, horizon: f64) -> f64 {
        let r = r.min(horizon);
        let shape = match &self.function {
            InfluenceFunction::Constant => 1.0,
            InfluenceFunction::Conical => 1.0 - r / horizon,
            InfluenceFunction::Inverse => 1.0 / r,
            InfluenceFunction::Power { exponent } => (r / horizon).powf(*exponent),
            InfluenceFunction::Gaussian { length, cutoff } => {
                if cutoff.is_some_and(|end| r > end * (1.0 + 1e-9)) {
                    0.0
                } else {
                    (-(r / length).powi(2)).exp()
                }
            }
            InfluenceFunction::Tabulated { table } => interpolate(table, r),
            InfluenceFunction::Cosines {
                wavenumber,
                coefficients,
            } => cosines(coefficients, wavenumber * r),
            InfluenceFunction::Classes(table) => interpolate(table.chord(), r),
        };
        match self.acts_on {
            ActsOn::Stretch => shape,
            ActsOn::Displacement => shape * r,
        }
    }

    /// Returns α of a bond with reference vector ξ (m), as used by force operators. It differs from
    /// [`Influence::alpha`] at |ξ| only for class tables, where two classes may have equal length.
    pub fn alpha_of(&self, xi: [f64; 3], horizon: f64) -> f64 {
        let r = (xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]).sqrt();
        match (&self.function, self.acts_on) {
            (InfluenceFunction::Classes(table), ActsOn::Stretch) => table.value(xi),
            (InfluenceFunction::Classes(table), ActsOn::Displacement) => table.value(xi) * r,
            _ => self.alpha(r, horizon),
        }
    }

    /// Checks the parameters for a body of given dimension and horizon.
    ///
    /// # Errors
    /// Lengths that are not positive; a table whose r does not increase; an exponent for which the modulus integral
    /// ∫ α r^dimension dr diverges.
    pub fn check(&self, dimension: usize, horizon: f64) -> Result<()> {
        let reject = |reason: String| Err(PericlesError::BadInfluence { reason });
        match &self.function {
            InfluenceFunction::Gaussian { length, cutoff } => {
                positive("the length of the Gaussian", *length)?;
                if let Some(end) = cutoff {
                    positive("the cut-off of the Gaussian", *end)?;
                    if *end > horizon * (1.0 + 1e-9) {
                        return reject(format!(
                            "the cut-off {} is beyond the horizon {}; allowed: at most the horizon",
                            precise(*end, "m"),
                            precise(horizon, "m")
                        ));
                    }
                }
            }
            InfluenceFunction::Tabulated { table } => {
                let ascending = table.windows(2).all(|pair| pair[0].0 < pair[1].0);
                let finite = table
                    .iter()
                    .all(|(r, g)| r.is_finite() && *r >= 0.0 && g.is_finite());
                if table.is_empty() || !ascending || !finite {
                    return reject(
                        "a table needs at least one pair (r, value); allowed: finite numbers, r ≥ 0 and increasing"
                            .into(),
                    );
                }
            }
            InfluenceFunction::Cosines {
                wavenumber,
                coefficients,
            } => {
                positive("the wavenumber of the cosines", *wavenumber)?;
                if coefficients.is_empty() || coefficients.iter().any(|a| !a.is_finite()) {
                    return reject(
                        "cosines need at least the coefficient a₀; allowed: finite numbers".into(),
                    );
                }
            }
            InfluenceFunction::Classes(table) => {
                // Its modulus is a lattice sum, which is computed with the body.
                return table.check_dimension(dimension);
            }
            _ => {}
        }
        let (exponent, _) = self.leading_power();
        let power = exponent + dimension as f64;
        if !power.is_finite() || power <= -1.0 {
            return reject(format!(
                "the exponent {} makes the modulus infinite in dimension {dimension}; allowed: more than {}",
                exponent - self.shift(),
                -1.0 - dimension as f64 - self.shift()
            ));
        }
        if self.moment(dimension as f64, horizon) <= 0.0 {
            return reject("the modulus integral ∫ α r^dimension dr must be positive".into());
        }
        Ok(())
    }

    /// Returns whether α is negative anywhere within the horizon: such bonds store negative energy and must not
    /// break.
    pub fn is_signed(&self, horizon: f64) -> bool {
        match &self.function {
            InfluenceFunction::Tabulated { table } => table.iter().any(|(_, g)| *g < 0.0),
            InfluenceFunction::Classes(table) => table.is_signed(),
            InfluenceFunction::Cosines { .. } => {
                // Twenty samples per period of the highest cosine.
                let samples = 20 * self.cosine_waves(horizon).ceil() as usize;
                (0..=samples)
                    .any(|k| self.alpha(horizon * k as f64 / samples as f64, horizon) < 0.0)
            }
            _ => false,
        }
    }

    /// Number of periods of the highest cosine within the horizon, at least one.
    pub(super) fn cosine_waves(&self, horizon: f64) -> f64 {
        match &self.function {
            InfluenceFunction::Cosines {
                wavenumber,
                coefficients,
            } => {
                let highest = wavenumber * coefficients.len() as f64;
                // A thousand periods are more than any real input has.
                (highest * horizon / std::f64::consts::TAU).clamp(1.0, 1e3)
            }
            _ => 1.0,
        }
    }

    /// Returns 1 where α has an additional factor r, else 0.
    pub(super) fn shift(&self) -> f64 {
        match self.acts_on {
            ActsOn::Stretch => 0.0,
            ActsOn::Displacement => 1.0,
        }
    }

    /// Returns (factor, exponent) of α ~ factor · r^exponent as r → 0.
    fn leading_power(&self) -> (f64, f64) {
        let exponent = match &self.function {
            InfluenceFunction::Inverse => -1.0,
            InfluenceFunction::Power { exponent } => *exponent,
            _ => 0.0,
        };
        (exponent + self.shift(), 1.0)
    }
}

/// a₀ + Σ a_j cos(j angle)
pub(super) fn cosines(coefficients: &[f64], angle: f64) -> f64 {
    let terms = coefficients.iter().enumerate();
    terms.map(|(j, a)| a * (j as f64 * angle).cos()).sum()
}

/// Piecewise linear interpolation of a table, constant outside.
pub(super) fn interpolate(table: &[(f64, f64)], r: f64) -> f64 {
    let after = table.partition_point(|(x, _)| *x <= r);
    match (after.checked_sub(1).map(|k| table[k]), table.get(after)) {
        (Some((x0, g0)), Some(&(x1, g1))) => g0 + (g1 - g0) * (r - x0) / (x1 - x0),
        (Some((_, g)), None) => g,
        (None, Some(&(_, g))) => g,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn on_stretch(function: InfluenceFunction) -> Influence {
        Influence {
            function,
            acts_on: ActsOn::Stretch,
        }
    }

    #[test]
    fn moments_equal_their_closed_forms() {
        let delta: f64 = 0.7;
        let cases: [(InfluenceFunction, f64, f64); 6] = [
            (InfluenceFunction::Constant, 2.0, delta.powi(3) / 3.0),
            (InfluenceFunction::Conical, 3.0, delta.powi(4) / 20.0),
            (InfluenceFunction::Inverse, 3.0, delta.powi(3) / 3.0),
            (
                InfluenceFunction::Power { exponent: 0.5 },
                2.0,
                delta.powi(3) / 3.5,
            ),
            // l ≪ δ: the half-line integrals √π l³/4 and l⁴/2.
            (
                InfluenceFunction::Gaussian {
                    length: 0.05,
                    cutoff: None,
                },
                2.0,
                PI.sqrt() * 0.05f64.powi(3) / 4.0,
            ),
            (
                InfluenceFunction::Gaussian {
                    length: 0.05,
                    cutoff: None,
                },
                3.0,
                0.05f64.powi(4) / 2.0,
            ),
        ];
        for (function, q, exact) in cases {
            let moment = on_stretch(function.clone()).moment(q, delta);
            assert!(
                (moment / exact - 1.0).abs() < 1e-13,
                "{function:?} m_{q}: {moment} {exact}"
            );
        }
    }

    #[test]
    fn a_table_of_a_linear_function_has_its_moments() {
        let delta = 2.0;
        let table = on_stretch(InfluenceFunction::Tabulated {
            table: vec![(0.0, 1.0), (0.3, 0.85), (2.0, 0.0)],
        });
        let cone = on_stretch(InfluenceFunction::Conical);
        for q in [1.0, 2.0, 3.0, 4.0] {
            let (a, b) = (table.moment(q, delta), cone.moment(q, delta));
            assert!((a / b - 1.0).abs() < 1e-13);
        }
        assert_eq!(table.alpha(1.15, delta), 0.425);
    }

    #[test]
    fn acting_on_displacement_adds_a_factor_r() {
        let stretch = on_stretch(InfluenceFunction::Conical);
        let displacement = Influence {
            acts_on: ActsOn::Displacement,
            ..stretch.clone()
        };
        assert_eq!(displacement.moment(1.0, 0.4), stretch.moment(2.0, 0.4));
        assert_eq!(displacement.alpha(0.1, 0.4), 0.1 * stretch.alpha(0.1, 0.4));
    }

    #[test]
    fn invalid_functions_are_rejected() {
        let power = |exponent| on_stretch(InfluenceFunction::Power { exponent });
        assert!(power(-2.0).check(1, 1.0).is_err());
        assert!(power(-1.9).check(1, 1.0).is_ok());
        assert!(power(f64::NAN).check(3, 1.0).is_err());
        let table = |table| on_stretch(InfluenceFunction::Tabulated { table });
        assert!(table(vec![]).check(2, 1.0).is_err());
        assert!(table(vec![(1.0, 1.0), (0.5, 1.0)]).check(2, 1.0).is_err());
        assert!(table(vec![(0.0, -1.0)]).check(2, 1.0).is_err());
        let far = InfluenceFunction::Gaussian {
            length: 1.0,
            cutoff: Some(2.0),
        };
        assert!(on_stretch(far).check(2, 1.0).is_err());
    }
}
