//! Softening of bonds beyond the elastic limit.
//!
//! The area below every curve equals that of the brittle bond, ½ s₀², so that calibration, interfaces and scatter do
//! not depend on the law.

use crate::error::{PericlesError, Result};

/// Force–stretch curve of a bond beyond the elastic limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SofteningLaw {
    /// Straight line to zero.
    Linear,
    /// Two straight lines: from the largest force to the fraction `knee_force` of it at the fraction
    /// `knee_position` of the way from the elastic limit to the end, then to zero.
    ///
    /// The values 1/3 and 2/9 give the curve of Petersson (1981) for concrete: the knee at an opening of 0.8
    /// G/f and the end at 3.6 G/f, with the strength f and the fracture energy G.
    Trilinear {
        /// Force at the knee over the largest force, above 0 and below 1.
        knee_force: f64,
        /// Position of the knee between the elastic limit (0) and the end (1).
        knee_position: f64,
    },
    /// s_e exp(−(s − s_e)/s_x). The bond breaks when the force has fallen to the fraction
    /// [`SofteningLaw::RESIDUAL`] of the largest force.
    Exponential,
}

/// Softening of the bonds of a material whose pair force is proportional to the stretch.
///
/// The force of a bond is c α (1 − d) s with the stretch s and the damage d(κ), which depends on the largest
/// stretch κ in the history of the bond: (1 − d) κ = g(κ) with the curve g. The curve is elastic up to
/// `onset` and then falls by the [`SofteningLaw`]. Unloading and reloading below κ follow the straight line
/// through the origin.
///
/// The fracture energy determines the end of the curve: the area ∫ g ds is ½ s₀², the area of a bond that
/// breaks at the critical stretch s₀ without softening. The critical stretch from a fracture energy
/// ([`FractureCalibration`](super::FractureCalibration)) is therefore valid for all curves, and cracks take
/// the same energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Softening {
    /// Shape of the curve.
    pub law: SofteningLaw,
    /// Elastic limit s_e, the stretch at which softening starts;
    /// [`HomogeneousBonds::softening`](super::HomogeneousBonds::softening) determines it from a tensile strength.
    pub onset: f64,
}

/// Softening curve of bonds with a given critical stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SofteningCurve {
    law: SofteningLaw,
    onset: f64,
    /// Stretch at which the bond breaks.
    end: f64,
    /// s_x of the exponential law; stretch at the knee of the trilinear law.
    length: f64,
    /// ½ s₀²
    area: f64,
}

impl SofteningLaw {
    /// Fraction of the largest force at which bonds with exponential softening break.
    pub const RESIDUAL: f64 = 0.01;

    /// The curve of Petersson for concrete.
    pub const PETERSSON: Self = Self::Trilinear {
        knee_force: 1.0 / 3.0,
        knee_position: 2.0 / 9.0,
    };

    /// Returns the name used in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Trilinear { .. } => "trilinear",
            Self::Exponential => "exponential",
        }
    }

    /// Returns the force and position of the knee; the linear law has its knee at the end.
    fn knee(self) -> [f64; 2] {
        match self {
            Self::Linear | Self::Exponential => [0.0, 1.0],
            Self::Trilinear {
                knee_force,
                knee_position,
            } => [knee_force, knee_position],
        }
    }
}

impl Softening {
    /// Returns an error if a parameter is out of range.
    ///
    /// # Errors
    /// [`PericlesError::OutOfRange`].
    pub fn check(&self) -> Result<()> {
        let inside = |value: f64| value > 0.0 && value < 1.0;
        let reject = |quantity, value, allowed| {
            Err(PericlesError::OutOfRange {
                quantity,
                value,
                allowed,
            })
        };
        if !(self.onset > 0.0 && self.onset.is_finite()) {
            return reject(
                "the stretch at which softening starts",
                self.onset,
                "above 0",
            );
        }
        if let SofteningLaw::Trilinear {
            knee_force,
            knee_position,
        } = self.law
        {
            if !inside(knee_force) {
                return reject("the force at the knee", knee_force, "above 0 and below 1");
            }
            if !inside(knee_position) {
                return reject(
                    "the position of the knee",
                    knee_position,
                    "above 0 and below 1",
                );
            }
        }
        Ok(())
    }

    /// Returns the curve of bonds with the critical stretch s₀.
    ///
    /// # Errors
    /// The errors of [`Softening::check`]; [`PericlesError::OutOfRange`] for unbreakable bonds and for an elastic
    /// limit that is not below the critical stretch, because then the elastic energy alone exceeds the
    /// fracture energy.
    pub fn curve(&self, critical_stretch: f64) -> Result<SofteningCurve> {
        self.check()?;
        if !critical_stretch.is_finite() {
            return Err(PericlesError::OutOfRange {
                quantity: "the critical stretch of bonds that soften",
                value: critical_stretch,
                allowed: "a finite number: softening needs a fracture energy or a critical stretch",
            });
        }
        if self.onset >= critical_stretch {
            return Err(PericlesError::OutOfRange {
                quantity: "the stretch at which softening starts",
                value: self.onset,
                allowed: "below the critical stretch, at which the elastic energy alone equals the fracture energy; use a larger fracture energy, a smaller horizon or a smaller onset",
            });
        }
        let area = 0.5 * critical_stretch * critical_stretch;
        Ok(SofteningCurve::new(self.law, self.onset, area))
    }
}

impl SofteningCurve {
    /// Returns the curve of a law with an elastic limit and an area, ½ s₀² with s₀ above the limit.
    #[inline(always)]
    fn new(law: SofteningLaw, onset: f64, area: f64) -> Self {
        // Area beyond the elastic limit over the largest force.
        let beyond = area / onset - 0.5 * onset;
        let (end, length) = match law {
            SofteningLaw::Exponential => {
                let length = beyond / (1.0 - SofteningLaw::RESIDUAL);
                (onset - length * SofteningLaw::RESIDUAL.ln(), length)
            }
            law => {
                let [force, position] = law.knee();
                let reach = 2.0 * beyond / (force + position);
                (onset + reach, onset + position * reach)
            }
        };
        Self {
            law,
            onset,
            end,
            length,
            area,
        }
    }

    /// Returns the curve with another elastic limit and the same area.
    #[inline(always)]
    pub(crate) fn with_onset(self, onset: f64) -> Self {
        Self::new(self.law, onset, self.area)
    }

    /// Returns the critical stretch s₀ of a brittle bond with this area.
    pub fn critical_stretch(&self) -> f64 {
        (2.0 * self.area).sqrt()
    }

    /// Returns the stretch at which softening starts.
    pub fn onset(&self) -> f64 {
        self.onset
    }

    /// Returns the stretch at which the bond breaks.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Returns the area under the curve, ½ s₀².
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Returns g(κ), the force over c α of a bond at its largest stretch.
    pub fn force(&self, largest: f64) -> f64 {
        if largest <= self.onset {
            return largest;
        }
        if largest >= self.end {
            return 0.0;
        }
        let [knee, _] = self.law.knee();
        match self.law {
            SofteningLaw::Exponential => self.onset * ((self.onset - largest) / self.length).exp(),
            _ if largest < self.length => {
                let part = (largest - self.onset) / (self.length - self.onset);
                self.onset * (1.0 - (1.0 - knee) * part)
            }
            _ => self.onset * knee * (self.end - largest) / (self.end - self.length),
        }
    }

    /// Returns dg/dκ.
    pub fn slope(&self, largest: f64) -> f64 {
        if largest <= self.onset {
            return 1.0;
        }
        if largest >= self.end {
            return 0.0;
        }
        let [knee, _] = self.law.knee();
        match self.law {
            SofteningLaw::Exponential => -self.force(largest) / self.length,
            _ if largest < self.length => -self.onset * (1.0 - knee) / (self.length - self.onset),
            _ => -self.onset * knee / (self.end - self.length),
        }
    }

    /// Returns 1 − d(κ), the remaining fraction of the stiffness.
    pub fn retained(&self, largest: f64) -> f64 {
        match largest > self.onset {
            true => self.force(largest) / largest,
            false => 1.0,
        }
    }

    /// Returns the energy dissipated up to the largest stretch κ, over c α and the length of the bond: the
    /// area under the curve less the elastic energy ½ g(κ) κ; the whole area for broken bonds.
    pub fn dissipated(&self, largest: f64) -> f64 {
        if largest <= self.onset {
            return 0.0;
        }
        if largest >= self.end {
            return self.area;
        }
        let (force, elastic) = (self.force(largest), 0.5 * self.onset * self.onset);
        let [knee, _] = self.law.knee();
        let beyond = match self.law {
            SofteningLaw::Exponential => self.length * (self.onset - force),
            _ if largest < self.length => 0.5 * (self.onset + force) * (largest - self.onset),
            // Whole area beyond the elastic limit less the area that remains.
            _ => {
                let left = 0.5 * force * (self.end - largest);
                let first = 0.5 * self.onset * (1.0 + knee) * (self.length - self.onset);
                let second = 0.5 * self.onset * knee * (self.end - self.length);
                first + second - left
            }
        };
        elastic + beyond - 0.5 * force * largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMIT: f64 = 0.01;

    fn laws() -> [SofteningLaw; 4] {
        let flat = SofteningLaw::Trilinear {
            knee_force: 0.8,
            knee_position: 0.7,
        };
        [
            SofteningLaw::Linear,
            SofteningLaw::PETERSSON,
            flat,
            SofteningLaw::Exponential,
        ]
    }

    fn curves() -> impl Iterator<Item = SofteningCurve> {
        let onsets = [0.1, 0.5, 0.9].map(|part| part * LIMIT);
        laws()
            .into_iter()
            .flat_map(move |law| onsets.map(|onset| Softening { law, onset }.curve(LIMIT).unwrap()))
    }

    /// ∫ g ds = ½ s₀² by numerical integration over the smooth pieces.
    #[test]
    fn area_under_the_softening_curve_equals_that_of_brittle_bonds() {
        for curve in curves() {
            let area = |from: f64, to: f64| -> f64 {
                // Simpson's rule, exact for straight lines.
                let (n, h) = (4000, (to - from) / 4000.0);
                let of = |k: usize| {
                    let x = from + k as f64 * h;
                    let middle = curve.force(x + 0.5 * h);
                    h / 6.0 * (g(&curve, x) + 4.0 * middle + g(&curve, x + h))
                };
                (0..n).map(of).sum()
            };
            let knee = match curve.law {
                SofteningLaw::Trilinear { .. } => curve.length,
                _ => curve.end,
            };
            let pieces = [(0.0, curve.onset), (curve.onset, knee), (knee, curve.end)];
            let total: f64 = pieces.iter().map(|&(from, to)| area(from, to)).sum();
            let wanted = 0.5 * LIMIT * LIMIT;
            assert!((total / wanted - 1.0).abs() < 1e-10, "{curve:?}: {total}");
            assert_eq!(curve.dissipated(curve.end), wanted);
        }
    }

    /// Force at a stretch; at the end its limit from the left.
    fn g(curve: &SofteningCurve, x: f64) -> f64 {
        curve.force(x.min(curve.end * (1.0 - 1e-15)))
    }

    #[test]
    fn dissipation_rate_equals_half_squared_stretch_times_damage_rate() {
        for curve in curves() {
            let h = 1e-6 * LIMIT;
            let (mut retained, mut dissipated) = (1.0, 0.0);
            for k in 1..400 {
                let s = curve.end * f64::from(k) / 400.0;
                let now = curve.retained(s);
                assert!(now <= retained, "{curve:?} {s}");
                assert!(curve.dissipated(s) >= dissipated, "{curve:?} {s}");
                (retained, dissipated) = (now, curve.dissipated(s));
                if (s - curve.length).abs() < 2.0 * h || (s - curve.onset).abs() < 2.0 * h {
                    continue;
                }
                // dD = ½ s² dd, and the slope of g by central differences.
                let rate = (curve.dissipated(s + h) - curve.dissipated(s - h)) / (2.0 * h);
                let driven = -0.5 * s * s * (curve.retained(s + h) - curve.retained(s - h));
                assert!(
                    (rate - driven / (2.0 * h)).abs() < 1e-6 * LIMIT,
                    "{curve:?} {s}"
                );
                let slope = (curve.force(s + h) - curve.force(s - h)) / (2.0 * h);
                assert!((slope - curve.slope(s)).abs() < 1e-6, "{curve:?} {s}");
            }
            assert_eq!(curve.force(curve.end), 0.0);
        }
    }

    /// Knee at 0.8 G/f and end at 3.6 G/f beyond the elastic limit, where G is the area beyond it.
    #[test]
    fn petersson_curve_has_published_knee_and_end() {
        let law = SofteningLaw::PETERSSON;
        let curve = Softening { law, onset: 1e-4 }.curve(LIMIT).unwrap();
        let energy = curve.area - 0.5 * curve.onset * curve.onset;
        let opening = energy / curve.onset;
        assert!(((curve.end - curve.onset) / (3.6 * opening) - 1.0).abs() < 1e-12);
        assert!(((curve.length - curve.onset) / (0.8 * opening) - 1.0).abs() < 1e-12);
        assert!((curve.force(curve.length) / curve.onset - 1.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn softening_parameters_out_of_range_are_errors() {
        let rejected = |law, onset, limit: f64, word: &str| {
            let error = Softening { law, onset }.curve(limit).unwrap_err();
            assert!(error.to_string().contains(word), "{error}");
        };
        rejected(
            SofteningLaw::Linear,
            0.02,
            LIMIT,
            "below the critical stretch",
        );
        rejected(SofteningLaw::Linear, 0.0, LIMIT, "above 0");
        rejected(SofteningLaw::Linear, 1e-3, f64::INFINITY, "fracture energy");
        let knee = |knee_force, knee_position| SofteningLaw::Trilinear {
            knee_force,
            knee_position,
        };
        rejected(knee(1.0, 0.5), 1e-3, LIMIT, "knee");
        rejected(knee(0.5, 0.0), 1e-3, LIMIT, "knee");
    }
}
