//! Lattice beyond an absorbing boundary.

use std::f64::consts::PI;

use super::AbsorbingError;
use pericles::sum::max_norm;

/// Homogeneous lattice u_n'' = Σ_{k=1..K} a_k (u_{n+k} − 2 u_n + u_{n−k}) with symmetric weights a_k (1/s²).
///
/// A bar has a_k = c α κ V/(ρ |ξ|); the Euler–Bernoulli lattice has (4, −1), the harmonic chain one weight.
#[derive(Debug, Clone, PartialEq)]
pub struct LatticeStencil {
    weights: Vec<f64>,
}

/// Samples of the band: many per oscillation of cos Kθ for all common K.
const SAMPLES: usize = 4096;

impl LatticeStencil {
    /// Creates the lattice with weights a_1 … a_K, 1/s².
    ///
    /// # Errors
    /// No weights, weights that are not finite, a_K = 0, or ω² ≤ 0 for some wave.
    pub fn new(weights: &[f64]) -> Result<Self, AbsorbingError> {
        for (k, &weight) in weights.iter().enumerate() {
            if !weight.is_finite() {
                let reach = k + 1;
                return Err(AbsorbingError::WeightNotFinite { reach, weight });
            }
        }
        let largest = max_norm(weights);
        match weights.last() {
            None => return Err(AbsorbingError::EmptyStencil),
            // Round-off of a weight that should vanish, as for the conical function at the horizon.
            Some(last) if last.abs() <= 1e-13 * largest => {
                let reach = weights.len();
                return Err(AbsorbingError::OutermostWeightZero { reach });
            }
            Some(_) => {}
        }
        let stencil = Self {
            weights: weights.to_vec(),
        };
        let samples = stencil.samples();
        for n in 1..=samples {
            let theta = PI * n as f64 / samples as f64;
            let square = stencil.square_frequency(theta);
            if square <= 0.0 {
                return Err(AbsorbingError::UnstableStencil { theta, square });
            }
        }
        Ok(stencil)
    }

    /// a_1 … a_K, 1/s².
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Reach K: the farthest neighbour in spacings.
    pub fn reach(&self) -> usize {
        self.weights.len()
    }

    /// Sum Σ a_k.
    pub fn sum(&self) -> f64 {
        self.weights.iter().sum()
    }

    /// ω²(θ) = 2 Σ a_k (1 − cos kθ), θ in radians per spacing; evaluated as squares of sines, accurate for long
    /// waves.
    pub fn square_frequency(&self, theta: f64) -> f64 {
        let terms = self.weights.iter().enumerate();
        terms
            .map(|(k, a)| 4.0 * a * (0.5 * (k + 1) as f64 * theta).sin().powi(2))
            .sum()
    }

    /// dω²/dθ.
    fn slope(&self, theta: f64) -> f64 {
        let terms = self.weights.iter().enumerate();
        terms
            .map(|(k, a)| {
                let k = (k + 1) as f64;
                2.0 * a * k * (k * theta).sin()
            })
            .sum()
    }

    /// Frequencies ω with zero group velocity, ascending: the band edge and interior extrema.
    pub fn stationary_frequencies(&self) -> Vec<f64> {
        let samples = self.samples();
        let at = |n: usize| PI * n as f64 / samples as f64;
        let mut found = vec![self.square_frequency(PI).sqrt()];
        for n in 1..samples - 1 {
            let (mut low, mut high) = (at(n), at(n + 1));
            let sign = self.slope(low) > 0.0;
            if (self.slope(high) > 0.0) == sign {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if (self.slope(middle) > 0.0) == sign {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            found.push(self.square_frequency(low).sqrt());
        }
        found.sort_by(f64::total_cmp);
        found
    }

    /// Highest frequency max ω, 1/s.
    pub fn highest_frequency(&self) -> f64 {
        let frequencies = self.stationary_frequencies();
        frequencies.last().copied().unwrap_or_default()
    }

    /// Largest group velocity max |dω/dθ|, spacings per second.
    pub fn fastest(&self) -> f64 {
        let samples = self.samples();
        (1..samples)
            .map(|n| {
                let theta = PI * n as f64 / samples as f64;
                0.5 * self.slope(theta).abs() / self.square_frequency(theta).sqrt()
            })
            .fold(0.0, f64::max)
    }

    /// Checks that velocity Verlet is stable on this lattice.
    ///
    /// # Errors
    /// dt max ω ≥ 2, or a time step that is not positive.
    pub fn check_step(&self, dt: f64) -> Result<(), AbsorbingError> {
        let omega = self.highest_frequency();
        let limit = 2.0 / omega;
        if dt > 0.0 && dt < limit {
            Ok(())
        } else {
            Err(AbsorbingError::UnstableStep { dt, omega, limit })
        }
    }

    fn samples(&self) -> usize {
        SAMPLES.max(64 * self.reach())
    }
}
