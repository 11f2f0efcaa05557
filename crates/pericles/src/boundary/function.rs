//! Functions of time that loads and prescribed motions follow.

use std::f64::consts::PI;

/// A dimensionless factor g(t) with its integral and derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum TimeFunction {
    /// g = 1 from the start.
    #[default]
    Constant,
    /// g rises linearly from 0 at `start` to 1 at `start + duration` and stays there.
    Ramp {
        /// Begin, s.
        start: f64,
        /// Length of the rise, s; positive.
        duration: f64,
    },
    /// g = sin²(π (t − start)/duration) between `start` and `start + duration`, zero elsewhere: a smooth pulse.
    Pulse {
        /// Begin, s.
        start: f64,
        /// Length of the pulse, s; positive.
        duration: f64,
    },
    /// g = (1 − 2q) exp(−q), q = π² f² (t − delay)²: Ricker's wavelet, its peak 1 at `delay`.
    Ricker {
        /// f, the frequency of the largest amplitude, Hz; positive.
        frequency: f64,
        /// When the peak is, s.
        delay: f64,
    },
}

/// π² f², the time from the peak, and exp(−q) of Ricker's wavelet.
fn ricker(frequency: f64, delay: f64, t: f64) -> (f64, f64, f64) {
    let c = (PI * frequency).powi(2);
    let tau = t - delay;
    (c, tau, (-c * tau * tau).exp())
}

impl TimeFunction {
    /// g(t).
    pub fn value(&self, t: f64) -> f64 {
        match *self {
            Self::Constant => 1.0,
            Self::Ramp { start, duration } => ((t - start) / duration).clamp(0.0, 1.0),
            Self::Pulse { start, duration } => {
                let phase = (t - start) / duration;
                if (0.0..=1.0).contains(&phase) {
                    (PI * phase).sin().powi(2)
                } else {
                    0.0
                }
            }
            Self::Ricker { frequency, delay } => {
                let (c, tau, bell) = ricker(frequency, delay, t);
                (1.0 - 2.0 * c * tau * tau) * bell
            }
        }
    }

    /// g'(t); at a kink the derivative from the right.
    pub fn derivative(&self, t: f64) -> f64 {
        match *self {
            Self::Constant => 0.0,
            Self::Ramp { start, duration } => {
                if t >= start && t < start + duration {
                    1.0 / duration
                } else {
                    0.0
                }
            }
            Self::Pulse { start, duration } => {
                let phase = (t - start) / duration;
                if (0.0..=1.0).contains(&phase) {
                    PI / duration * (2.0 * PI * phase).sin()
                } else {
                    0.0
                }
            }
            Self::Ricker { frequency, delay } => {
                let (c, tau, bell) = ricker(frequency, delay, t);
                (4.0 * c * tau * tau - 6.0) * c * tau * bell
            }
        }
    }

    /// g''(t) without the impulses at the kinks of a ramp.
    pub fn second_derivative(&self, t: f64) -> f64 {
        match *self {
            Self::Constant | Self::Ramp { .. } => 0.0,
            Self::Pulse { start, duration } => {
                let phase = (t - start) / duration;
                if (0.0..=1.0).contains(&phase) {
                    2.0 * (PI / duration).powi(2) * (2.0 * PI * phase).cos()
                } else {
                    0.0
                }
            }
            Self::Ricker { frequency, delay } => {
                let (c, tau, bell) = ricker(frequency, delay, t);
                let q = c * tau * tau;
                (24.0 * q - 6.0 - 8.0 * q * q) * c * bell
            }
        }
    }

    /// ∫₀ᵗ g.
    pub fn integral(&self, t: f64) -> f64 {
        self.primitive(t) - self.primitive(0.0)
    }

    fn primitive(&self, t: f64) -> f64 {
        match *self {
            Self::Constant => t,
            Self::Ramp { start, duration } => {
                let rise = (t - start).clamp(0.0, duration);
                0.5 * rise * rise / duration + (t - start - duration).max(0.0)
            }
            Self::Pulse { start, duration } => {
                let phase = ((t - start) / duration).clamp(0.0, 1.0);
                duration * (0.5 * phase - (2.0 * PI * phase).sin() / (4.0 * PI))
            }
            Self::Ricker { frequency, delay } => {
                let (_, tau, bell) = ricker(frequency, delay, t);
                tau * bell
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_and_integrals_belong_together() {
        let functions = [
            TimeFunction::Constant,
            TimeFunction::Ramp {
                start: 0.3,
                duration: 0.5,
            },
            TimeFunction::Pulse {
                start: -0.2,
                duration: 0.9,
            },
            TimeFunction::Ricker {
                frequency: 1.3,
                delay: 0.6,
            },
        ];
        let h = 1e-5;
        for g in functions {
            assert_eq!(g.integral(0.0), 0.0);
            for k in 0..40 {
                let t = 0.0123 + 0.031 * f64::from(k);
                let slope = (g.integral(t + h) - g.integral(t - h)) / (2.0 * h);
                assert!((slope - g.value(t)).abs() < 1e-8, "{g:?} at {t}");
                let slope = (g.value(t + h) - g.value(t - h)) / (2.0 * h);
                assert!((slope - g.derivative(t)).abs() < 1e-6, "{g:?} at {t}");
                let slope = (g.derivative(t + h) - g.derivative(t - h)) / (2.0 * h);
                assert!(
                    (slope - g.second_derivative(t)).abs() < 1e-5,
                    "{g:?} at {t}"
                );
            }
        }
    }
}
