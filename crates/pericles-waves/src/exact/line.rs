//! Pulses on the infinite line.

use rayon::prelude::*;

use super::ExactSolution;
use pericles::parallel::BLOCK;

/// Displacement of the nonlocal line after a Gaussian initial displacement at rest:
/// u = (2U/√π) ∫₀^∞ e^{−s²} cos(2sx/L) cos[ (2t/l) √(E/ρ) √(1 − e^{−(sl/L)²}) ] ds.
///
/// The trapezoidal rule is exact to round-off because the integrand is even and entire; a step ds corresponds to a
/// period πL/ds, which is chosen far beyond the extent of the solution. Error: 1e-14 of the amplitude. Cost: about
/// 120 + 2 (|x| + 6ct)/L terms of a few operations per position.
///
/// Source: Coclite et al., Appl. Numer. Math. 155 (2020) 119–139, who print it for E = ρ = l = L = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineSolution {
    /// Young's modulus E, Pa.
    pub young: f64,
    /// Density ρ, kg/m³.
    pub density: f64,
    /// Length l of the micromodulus, m.
    pub length: f64,
    /// Width L of the initial pulse, m.
    pub width: f64,
    /// Amplitude U of the initial pulse.
    pub amplitude: f64,
    /// Centre of the initial pulse, m.
    pub centre: f64,
}

/// Upper limit of s; e^{−s²} is below 1e-17 beyond.
const LARGEST: f64 = 6.3;

impl LineSolution {
    /// Speed of long waves √(E/ρ), m/s.
    pub fn speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// Step ds of the rule for positions up to `reach` from the centre.
    fn spacing(&self, t: f64, reach: f64) -> f64 {
        let period = reach + 6.0 * t.abs() * self.speed() + 60.0 * self.length.max(self.width);
        std::f64::consts::PI * self.width / period
    }

    /// Number of terms for one position up to `reach` from the centre at time t, which determines computing time
    /// and memory.
    pub fn terms(&self, t: f64, reach: f64) -> f64 {
        LARGEST / self.spacing(t, reach)
    }

    /// Step and weights of the rule for positions up to `reach` from the centre: (ds, e^{−s²} cos(ω(s) t) times all
    /// factors).
    fn rule(&self, t: f64, reach: f64) -> (f64, Vec<f64>) {
        let ds = self.spacing(t, reach);
        let count = (LARGEST / ds).ceil() as usize;
        let turn = 2.0 * t / self.length * self.speed();
        let factor = 2.0 * self.amplitude * ds / std::f64::consts::PI.sqrt();
        let weight = |k: usize| {
            let s = k as f64 * ds;
            let omega = (-(-(s * self.length / self.width).powi(2)).exp_m1()).sqrt();
            let half = if k == 0 { 0.5 } else { 1.0 };
            half * factor * (-s * s).exp() * (turn * omega).cos()
        };
        (ds, (0..=count).map(weight).collect())
    }

    /// Estimates the largest difference between a ring of period P and the infinite line until time t at positions
    /// y within `window` of the centre, relative to the amplitude: max |Σ_{j≥1} u(jP − y) + u(jP + y)| over samples
    /// of time and position. At most eight images on each side are summed, so for rings that waves circle more
    /// often the result is a lower bound of order one.
    pub fn image_error(&self, period: f64, window: f64, t: f64) -> f64 {
        const TIMES: u32 = 16;
        const PLACES: u32 = 64;
        const MOST_IMAGES: f64 = 8.0;
        let tail = 6.0 * self.width.max(self.length);
        let travelled = window + self.speed() * t.abs() + tail;
        let images = (travelled / period).ceil().clamp(1.0, MOST_IMAGES) as u32;
        // As dense as the waves where that suffices to cover the window; the edge of the window is closest to the
        // image.
        let dense = 0.25 * self.width.min(self.length.max(0.1 * self.width));
        let step = dense.max(window / f64::from(PLACES));
        let near = (0..8).map(|k| window - f64::from(k) * dense);
        let all = (0..PLACES).map(|k| window - f64::from(k) * step);
        let places: Vec<f64> = near.chain(all).filter(|y| *y >= 0.0).collect();
        let x: Vec<f64> = (places.iter())
            .flat_map(|y| {
                (1..=images)
                    .flat_map(move |j| [-1.0, 1.0].map(|side| f64::from(j) * period + side * y))
            })
            .map(|distance| self.centre + distance)
            .collect();
        let mut image = vec![0.0; x.len()];
        let mut worst = 0.0f64;
        for k in 0..=TIMES {
            self.displacement_into(t * f64::from(k) / f64::from(TIMES), &x, &mut image);
            let sums = image
                .chunks(2 * images as usize)
                .map(|place| place.iter().sum::<f64>());
            worst = sums.fold(worst, |worst, sum| worst.max(sum.abs()));
        }
        worst / self.amplitude.abs()
    }
}

impl ExactSolution for LineSolution {
    fn displacement_into(&self, t: f64, x: &[f64], out: &mut [f64]) {
        let reach = x.iter().fold(0.0f64, |m, x| m.max((x - self.centre).abs()));
        let (ds, weights) = self.rule(t, reach);
        out.par_chunks_mut(BLOCK)
            .zip(x.par_chunks(BLOCK))
            .for_each(|(out, x)| {
                for (out, x) in out.iter_mut().zip(x) {
                    *out = cosine_sum(&weights, 2.0 * ds * (x - self.centre) / self.width);
                }
            });
    }
}

/// Σ_k w_k cos(kθ); the cosines of all runs of terms follow from those of the first run by the addition theorem.
fn cosine_sum(weights: &[f64], angle: f64) -> f64 {
    const RUN: usize = 64;
    let first: [(f64, f64); RUN] = std::array::from_fn(|k| (k as f64 * angle).sin_cos());
    let runs = weights.chunks(RUN).enumerate().map(|(run, weights)| {
        let (sine, cosine) = ((run * RUN) as f64 * angle).sin_cos();
        let (mut sines, mut cosines) = (0.0, 0.0);
        for (weight, (s, c)) in weights.iter().zip(&first) {
            sines += weight * s;
            cosines += weight * c;
        }
        cosine * cosines - sine * sines
    });
    runs.sum()
}

/// Local string with the same initial pulse: two halves that travel apart, u = U/2 [g(x − ct) + g(x + ct)], g =
/// exp(−(x/L)²).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TravellingPulse {
    /// Wave speed c, m/s.
    pub speed: f64,
    /// Width L, m.
    pub width: f64,
    /// Amplitude U.
    pub amplitude: f64,
    /// Initial centre, m.
    pub centre: f64,
}

impl ExactSolution for TravellingPulse {
    fn displacement_into(&self, t: f64, x: &[f64], out: &mut [f64]) {
        let bell = |x: f64| (-(x / self.width).powi(2)).exp();
        for (out, x) in out.iter_mut().zip(x) {
            let place = x - self.centre;
            let both = bell(place - self.speed * t) + bell(place + self.speed * t);
            *out = 0.5 * self.amplitude * both;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: LineSolution = LineSolution {
        young: 1.0,
        density: 1.0,
        length: 1.0,
        width: 1.0,
        amplitude: 1.0,
        centre: 0.0,
    };

    fn at(solution: &LineSolution, x: f64, t: f64) -> f64 {
        let mut u = [0.0];
        solution.displacement_into(t, &[x], &mut u);
        u[0]
    }

    #[test]
    fn line_solution_scales_with_length_and_time() {
        // Lengths by 3, time by 3/c with c = 5: the same shape.
        let scaled = LineSolution {
            young: 50.0,
            density: 2.0,
            length: 3.0,
            width: 3.0,
            amplitude: 0.1,
            centre: 7.0,
        };
        for (x, t) in [(0.0, 1.0), (0.7, 3.5), (5.0, 4.0), (2.0, 30.0)] {
            let same = at(&scaled, 7.0 + 3.0 * x, 3.0 * t / 5.0) / 0.1;
            assert!((same - at(&UNIT, x, t)).abs() < 3e-15, "{x} {t}");
        }
    }

    #[test]
    fn line_solution_satisfies_the_equation_of_motion() {
        // ρ u_tt by differences compared with 4E/(l³√π) ∫ e^{−ξ²/l²} (u(x+ξ) − u(x)) dξ by the trapezoidal rule.
        let line = LineSolution {
            length: 0.6,
            ..UNIT
        };
        let (x, t, h, dxi) = (0.8, 1.3, 1e-2, 0.05);
        let values = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| at(&line, x, t + k * h));
        let second = (-values[0] + 16.0 * values[1] - 30.0 * values[2] + 16.0 * values[3]
            - values[4])
            / (12.0 * h * h);
        let micromodulus = |xi: f64| {
            4.0 / (0.6f64.powi(3) * std::f64::consts::PI.sqrt()) * (-(xi / 0.6).powi(2)).exp()
        };
        let force: f64 = (-80..=80)
            .map(|k| {
                let xi = f64::from(k) * dxi;
                dxi * micromodulus(xi) * (at(&line, x + xi, t) - at(&line, x, t))
            })
            .sum();
        assert!((second - force).abs() < 1e-7, "{second} {force}");
    }

    #[test]
    fn short_micromodulus_converges_to_the_local_string() {
        // The difference is of second order in l.
        let error = |length: f64| {
            let line = LineSolution { length, ..UNIT };
            let string = TravellingPulse {
                speed: 1.0,
                width: 1.0,
                amplitude: 1.0,
                centre: 0.0,
            };
            let mut u = [0.0];
            string.displacement_into(2.0, &[1.7], &mut u);
            at(&line, 1.7, 2.0) - u[0]
        };
        let order = (error(0.1) / error(0.05)).log2();
        assert!((order - 2.0).abs() < 0.02, "{order}");
    }

    #[test]
    fn image_error_matches_reference_values() {
        // Independently computed errors on [−π, π] at t = 3.5 for half periods of 2π, 2.5π and 3π, relative to the
        // largest displacement there.
        let pi = std::f64::consts::PI;
        for (half, error) in [(2.0, 4.72e-5), (2.5, 2.15e-8), (3.0, 3.9e-12)] {
            let estimate = UNIT.image_error(2.0 * half * pi, pi, 3.5);
            let ratio = estimate / error;
            assert!(
                (0.05..5.0).contains(&ratio),
                "{half}: {estimate:e} {error:e}"
            );
        }
    }

    #[test]
    fn image_error_includes_images_that_pass_through_the_window() {
        // On a ring of period 8 the pulses of the neighbours meet in the middle at t = 8: half the amplitude each,
        // less the effect of dispersion.
        let estimate = UNIT.image_error(8.0, 1.0, 9.0);
        assert!((0.3..1.5).contains(&estimate), "{estimate}");
        // After they have passed, the error up to that time remains.
        assert!(UNIT.image_error(8.0, 1.0, 12.0) > 0.9 * estimate.min(0.5));
    }
}
