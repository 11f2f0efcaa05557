//! Integrals over the bonds that cross a plane.

use std::f64::consts::PI;

use super::Influence;
use super::quadrature::piecewise;

/// Integrals over the bonds that cross a plane from points on one side of it.
///
/// The cap of a point at distance z from the plane is the part of its family beyond the plane. With the fraction
/// p(z) = (1/m) ∫_cap α r² dV of the cap in the weighted volume m = ∫ α r² dV, the integrals are ∫₀^δ p dz, ∫₀^δ p²
/// dz and ∫₀^δ (volume of the cap) dz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CapIntegrals {
    /// ∫ p dz, m.
    pub share: f64,
    /// ∫ p² dz, m.
    pub share_squared: f64,
    /// ∫∫_cap dV dz per cross-section of the body: m² in one dimension, m³ in two, m⁴ in three.
    pub volume: f64,
}

impl Influence {
    /// Returns the weighted volume ∫ α r² dV of a full family per cross-section of the body: m³ in one dimension,
    /// m⁴ in two, m⁵ in three, times the unit of α.
    pub fn weighted_volume(&self, dimension: usize, horizon: f64) -> f64 {
        sphere(dimension) * self.moment((dimension + 1) as f64, horizon)
    }

    /// Returns the cap integrals of the continuum.
    pub fn cap_integrals(&self, dimension: usize, horizon: f64) -> CapIntegrals {
        let whole = self.weighted_volume(dimension, horizon);
        // ∫ (ξ·n) q dV over half of a ball is this constant times ∫ q r^dimension dr.
        let half = [1.0, 2.0, PI][dimension - 1];
        let power = (dimension + 1) as i32;
        let square = |z: f64| (self.cap(dimension, horizon, z) / whole).powi(2);
        let breaks = self.breaks_of_distances(horizon);
        CapIntegrals {
            share: half * self.moment((dimension + 2) as f64, horizon) / whole,
            share_squared: piecewise(&breaks, square),
            volume: half * horizon.powi(power) / f64::from(power),
        }
    }

    /// Returns ∫ α r² dV over the cap beyond a plane at distance z.
    fn cap(&self, dimension: usize, horizon: f64, z: f64) -> f64 {
        // Measure of the directions at distance r that cross the plane, per dr.
        let crossing = |r: f64| match dimension {
            1 => 1.0,
            2 => 2.0 * r * (z / r).min(1.0).acos(),
            _ => 2.0 * PI * r * (r - z),
        };
        let mut breaks = self.smooth_pieces(horizon);
        breaks.retain(|r| *r > z);
        breaks.insert(0, z);
        // The arc grows as the square root of r − z.
        let integrand = |x: f64| {
            let r = z + x * x;
            2.0 * x * self.alpha(r, horizon) * r * r * crossing(r)
        };
        let roots: Vec<f64> = breaks.iter().map(|r| (r - z).sqrt()).collect();
        piecewise(&roots, integrand)
    }

    /// Returns the ends of pieces of 0 … horizon on which the caps are smooth. They are halved towards zero,
    /// because the caps are not analytic at the plane.
    fn breaks_of_distances(&self, horizon: f64) -> Vec<f64> {
        let mut breaks = self.smooth_pieces(horizon);
        breaks.extend((0..=12).map(|k| horizon * 0.5f64.powi(k)));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }
}

/// Measure of all directions: 2 ends of a line, circumference of the unit circle, area of the unit sphere.
fn sphere(dimension: usize) -> f64 {
    [2.0, 2.0 * PI, 4.0 * PI][dimension - 1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::quadrature::integral;
    use crate::kernel::{ActsOn, InfluenceFunction};

    fn of(function: InfluenceFunction) -> Influence {
        Influence {
            function,
            acts_on: ActsOn::Stretch,
        }
    }

    /// ∫ p dz/δ and ∫ p² dz/δ: the first from closed forms; the second for 1/r in three dimensions from its closed form
    /// 26/405, others from an independent quadrature with mpmath.
    #[test]
    fn caps_of_usual_functions() {
        let cases = [
            (
                3,
                InfluenceFunction::Constant,
                5.0 / 24.0,
                0.067_640_692_7,
                1e-9,
            ),
            (
                3,
                InfluenceFunction::Inverse,
                1.0 / 5.0,
                26.0 / 405.0,
                1e-13,
            ),
            (
                3,
                InfluenceFunction::Conical,
                5.0 / 28.0,
                0.056_974_275_7,
                1e-9,
            ),
            (
                2,
                InfluenceFunction::Constant,
                4.0 / (5.0 * PI),
                0.088_130_921_7,
                1e-9,
            ),
            (
                2,
                InfluenceFunction::Inverse,
                3.0 / (4.0 * PI),
                0.080_649_936_6,
                1e-9,
            ),
            (
                2,
                InfluenceFunction::Conical,
                2.0 / (3.0 * PI),
                0.071_441_020_1,
                1e-9,
            ),
        ];
        for (dimension, function, share, squared, tolerance) in cases {
            for horizon in [1.0, 3e-3] {
                let caps = of(function.clone()).cap_integrals(dimension, horizon);
                assert!((caps.share / horizon / share - 1.0).abs() < 1e-13);
                assert!(
                    (caps.share_squared / horizon / squared - 1.0).abs() < tolerance,
                    "{dimension}, {function:?}: {}",
                    caps.share_squared / horizon
                );
            }
        }
    }

    #[test]
    fn cap_integrals_from_caps_equal_their_closed_forms() {
        // ∫ p dz from the caps equals the closed form.
        let gaussian = of(InfluenceFunction::Gaussian {
            length: 0.4,
            cutoff: None,
        });
        for dimension in 1..=3 {
            let whole = gaussian.weighted_volume(dimension, 1.0);
            let share = |z: f64| gaussian.cap(dimension, 1.0, z) / whole;
            let breaks = gaussian.breaks_of_distances(1.0);
            let sum: f64 = breaks
                .windows(2)
                .map(|ends| integral(ends[0], ends[1], share))
                .sum();
            let caps = gaussian.cap_integrals(dimension, 1.0);
            assert!((sum / caps.share - 1.0).abs() < 1e-9, "{dimension}: {sum}");
            // At the plane itself half of the family lies beyond.
            assert!((share(0.0) - 0.5).abs() < 1e-12);
        }
    }
}
