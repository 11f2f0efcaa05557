//! The functions, where they act, and their moments.

use gauss_quad::GaussLegendre;

use crate::error::{PericlesError, Result, positive};

/// The shape g(r) of an influence function; δ is the horizon.
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
        /// Cut-off, m; at most the horizon, which is the cut-off if none is given.
        cutoff: Option<f64>,
    },
    /// Piecewise linear through (r, g), constant before the first and after the last entry.
    Tabulated {
        /// Ascending r (m) with values.
        table: Vec<(f64, f64)>,
    },
}

/// What the function multiplies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ActsOn {
    /// The stretch: α = g, force density c g s. In 1D the micromodulus is C(r) = c g(r) / r.
    #[default]
    Stretch,
    /// The relative displacement: force density c g (r s), that is α = r g. In 1D the micromodulus is C(r) = c g(r).
    Displacement,
}

/// An influence function as used by a material.
#[derive(Debug, Clone, PartialEq)]
pub struct Influence {
    /// Its shape.
    pub function: InfluenceFunction,
    /// What it multiplies.
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
    /// α at reference length r (m). Cells that reach into the horizon although their centre lies beyond it take the value at
    /// the horizon: that is where their partial volume lies.
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
        };
        match self.acts_on {
            ActsOn::Stretch => shape,
            ActsOn::Displacement => shape * r,
        }
    }

    /// Checks the parameters for a body of `dimension` with the given horizon.
    ///
    /// # Errors
    /// Lengths that are not positive; a table that is not ascending; an exponent for which the modulus integral
    /// ∫ α r^dimension dr diverges.
    pub fn check(&self, dimension: usize, horizon: f64) -> Result<()> {
        let refuse = |reason: String| Err(PericlesError::BadInfluence { reason });
        match &self.function {
            InfluenceFunction::Gaussian { length, cutoff } => {
                positive("the Gaussian's length", *length)?;
                if let Some(end) = cutoff {
                    positive("the Gaussian's cut-off", *end)?;
                    if *end > horizon * (1.0 + 1e-9) {
                        return refuse(format!(
                            "the cut-off {end} m lies beyond the horizon {horizon} m; the horizon is the largest cut-off"
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
                    return refuse(
                        "a table needs at least one pair (r, value), finite, with r ≥ 0 ascending"
                            .into(),
                    );
                }
            }
            _ => {}
        }
        let (exponent, _) = self.leading_power();
        let power = exponent + dimension as f64;
        if !power.is_finite() || power <= -1.0 {
            return refuse(format!(
                "the exponent {} makes the modulus infinite in dimension {dimension}; it must exceed {}",
                exponent - self.shift(),
                -1.0 - dimension as f64 - self.shift()
            ));
        }
        if self.moment(dimension as f64, horizon) <= 0.0 {
            return refuse("its modulus integral ∫ α r^dimension dr must be positive".into());
        }
        Ok(())
    }

    /// Whether α is negative anywhere within the horizon: such bonds store energy with the wrong sign and must not break.
    pub fn is_signed(&self) -> bool {
        match &self.function {
            InfluenceFunction::Tabulated { table } => table.iter().any(|(_, g)| *g < 0.0),
            _ => false,
        }
    }

    /// The moment m_q = ∫₀^δ α(r) r^q dr, by closed form for powers and by Gauss–Legendre quadrature (exact to round-off) for
    /// the Gaussian and the pieces of a table.
    pub fn moment(&self, q: f64, horizon: f64) -> f64 {
        // ∫₀^δ r^p dr
        let power = |p: f64| horizon.powf(p + 1.0) / (p + 1.0);
        let q = q + self.shift();
        match &self.function {
            InfluenceFunction::Constant => power(q),
            InfluenceFunction::Conical => power(q) - power(q + 1.0) / horizon,
            InfluenceFunction::Inverse => power(q - 1.0),
            InfluenceFunction::Power { exponent } => power(q + exponent) / horizon.powf(*exponent),
            InfluenceFunction::Gaussian { length, cutoff } => {
                let end = cutoff.unwrap_or(horizon).min(horizon);
                // Beyond 7 lengths the integrand is below round-off; a piece per length keeps the quadrature exact.
                let end = end.min(7.0 * length + 7.0 * length * q.max(0.0).sqrt());
                let pieces = (end / length).ceil().max(1.0) as usize;
                let breaks: Vec<f64> = (0..=pieces)
                    .map(|k| end * k as f64 / pieces as f64)
                    .collect();
                quadrature(&breaks, |r| (-(r / length).powi(2)).exp() * r.powf(q))
            }
            InfluenceFunction::Tabulated { table } => {
                let mut breaks = vec![0.0];
                breaks.extend(
                    table
                        .iter()
                        .map(|(r, _)| *r)
                        .filter(|r| *r > 0.0 && *r < horizon),
                );
                breaks.push(horizon);
                quadrature(&breaks, |r| interpolate(table, r) * r.powf(q))
            }
        }
    }

    /// 1 where α carries an extra factor r.
    fn shift(&self) -> f64 {
        match self.acts_on {
            ActsOn::Stretch => 0.0,
            ActsOn::Displacement => 1.0,
        }
    }

    /// α ~ factor · r^exponent as r → 0.
    fn leading_power(&self) -> (f64, f64) {
        let exponent = match &self.function {
            InfluenceFunction::Inverse => -1.0,
            InfluenceFunction::Power { exponent } => *exponent,
            _ => 0.0,
        };
        (exponent + self.shift(), 1.0)
    }
}

fn interpolate(table: &[(f64, f64)], r: f64) -> f64 {
    let after = table.partition_point(|(x, _)| *x <= r);
    match (after.checked_sub(1).map(|k| table[k]), table.get(after)) {
        (Some((x0, g0)), Some(&(x1, g1))) => g0 + (g1 - g0) * (r - x0) / (x1 - x0),
        (Some((_, g)), None) => g,
        (None, Some(&(_, g))) => g,
        (None, None) => 0.0,
    }
}

/// Gauss–Legendre with 32 nodes on each piece.
fn quadrature(breaks: &[f64], integrand: impl Fn(f64) -> f64) -> f64 {
    const NODES: std::num::NonZeroUsize = std::num::NonZeroUsize::new(32).unwrap();
    let rule = GaussLegendre::new(NODES);
    breaks
        .windows(2)
        .map(|piece| rule.integrate(piece[0], piece[1], &integrand))
        .sum()
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
    fn moments_have_their_closed_forms() {
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
    fn a_table_of_a_line_has_the_line_s_moments() {
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
    fn bad_functions_are_refused() {
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
