//! Exact solutions of the local bar, fixed at x = 0 and free at its other end.

use std::f64::consts::{FRAC_PI_2, PI};

use super::ExactSolution;

/// Bar released from uniform strain: u = ½ [tri(x − ct) + tri(x + ct)] with tri the triangle wave of period 4 ·
/// length and slope ε through the origin.
///
/// The equivalent series is u = (8εL/π²) Σ_k (−1)^k/(2k+1)² sin((2k+1)πx/2L) cos((2k+1)πct/2L).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StretchedBar {
    /// Length L, m.
    pub length: f64,
    /// Initial strain ε.
    pub strain: f64,
    /// Wave speed c = √(E/ρ), m/s.
    pub speed: f64,
}

impl StretchedBar {
    fn triangle(&self, x: f64) -> f64 {
        let period = 4.0 * self.length;
        let place = (x + self.length).rem_euclid(period);
        let height = if place <= 2.0 * self.length {
            place - self.length
        } else {
            3.0 * self.length - place
        };
        self.strain * height
    }

    /// Sum of the first `terms` terms of the series.
    pub fn series(&self, t: f64, x: f64, terms: usize) -> f64 {
        let term = |k: usize| {
            let odd = (2 * k + 1) as f64;
            let angle = odd * PI / (2.0 * self.length);
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            sign / (odd * odd) * (angle * x).sin() * (angle * self.speed * t).cos()
        };
        8.0 * self.strain * self.length / (PI * PI) * (0..terms).map(term).sum::<f64>()
    }
}

impl ExactSolution for StretchedBar {
    fn displacement_into(&self, t: f64, x: &[f64], out: &mut [f64]) {
        let way = self.speed * t;
        for (out, x) in out.iter_mut().zip(x) {
            *out = 0.5 * (self.triangle(x - way) + self.triangle(x + way));
        }
    }
}

/// Fundamental mode: u = U sin(πx/2L) cos(πct/2L).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BarMode {
    /// Length L, m.
    pub length: f64,
    /// Amplitude U.
    pub amplitude: f64,
    /// Wave speed c = √(E/ρ), m/s.
    pub speed: f64,
}

impl ExactSolution for BarMode {
    fn displacement_into(&self, t: f64, x: &[f64], out: &mut [f64]) {
        let k = FRAC_PI_2 / self.length;
        for (out, x) in out.iter_mut().zip(x) {
            *out = self.amplitude * (k * x).sin() * (k * self.speed * t).cos();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_equals_the_series() {
        let bar = StretchedBar {
            length: 2.0,
            strain: 0.1,
            speed: 3.0,
        };
        for (x, t) in [(0.3, 0.0), (1.9, 0.4), (1.0, 5.0), (2.0, 1.7)] {
            let mut u = [0.0];
            bar.displacement_into(t, &[x], &mut u);
            // The remainder of the series is below the sum of 1/(2k+1)² from 20000 on.
            assert!((u[0] - bar.series(t, x, 20_000)).abs() < 5e-6, "{x} {t}");
        }
    }
}
