//! Time functions of loads and prescribed motions.

use std::f64::consts::PI;
use std::fmt;
use std::sync::Arc;

use super::TimeTable;

/// A custom time function g(t).
pub trait TimeCourse: fmt::Debug + Send + Sync {
    /// g(t).
    fn value(&self, t: f64) -> f64;
    /// g'(t); at a kink the right-hand derivative.
    fn derivative(&self, t: f64) -> f64;
    /// g''(t) without the delta functions at kinks.
    fn second_derivative(&self, t: f64) -> f64;
    /// ∫₀ᵗ g.
    fn integral(&self, t: f64) -> f64;
}

/// A time function: a dimensionless factor g(t) with its integral and derivatives.
#[derive(Debug, Clone, Default)]
pub enum TimeFunction {
    /// g = 1.
    #[default]
    Constant,
    /// g rises linearly from 0 at `start` to 1 at `start + duration` and stays 1.
    Ramp {
        /// Start, s.
        start: f64,
        /// Duration of the rise, s; positive.
        duration: f64,
    },
    /// A smooth pulse: g = sin²(π (t − start)/duration) between `start` and `start + duration`, zero elsewhere.
    Pulse {
        /// Start, s.
        start: f64,
        /// Duration of the pulse, s; positive.
        duration: f64,
    },
    /// Linear interpolation in a table.
    Table(Arc<TimeTable>),
    /// Any other time function.
    Course(Arc<dyn TimeCourse>),
}

/// Tables are equal if their numbers are equal, custom functions if they are the same object.
impl PartialEq for TimeFunction {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Constant, Self::Constant) => true,
            (
                &Self::Ramp { start, duration },
                &Self::Ramp {
                    start: other_start,
                    duration: other_duration,
                },
            )
            | (
                &Self::Pulse { start, duration },
                &Self::Pulse {
                    start: other_start,
                    duration: other_duration,
                },
            ) => (start, duration) == (other_start, other_duration),
            (Self::Table(table), Self::Table(other)) => table == other,
            (Self::Course(course), Self::Course(other)) => Arc::ptr_eq(course, other),
            _ => false,
        }
    }
}

impl TimeFunction {
    /// g(t).
    pub fn value(&self, t: f64) -> f64 {
        match *self {
            Self::Table(ref table) => table.value(t),
            Self::Course(ref course) => course.value(t),
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
        }
    }

    /// g'(t); at a kink the right-hand derivative.
    pub fn derivative(&self, t: f64) -> f64 {
        match *self {
            Self::Table(ref table) => table.derivative(t),
            Self::Course(ref course) => course.derivative(t),
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
        }
    }

    /// g''(t) without the delta functions at the kinks of a ramp.
    pub fn second_derivative(&self, t: f64) -> f64 {
        match *self {
            Self::Constant | Self::Ramp { .. } | Self::Table(_) => 0.0,
            Self::Course(ref course) => course.second_derivative(t),
            Self::Pulse { start, duration } => {
                let phase = (t - start) / duration;
                if (0.0..=1.0).contains(&phase) {
                    2.0 * (PI / duration).powi(2) * (2.0 * PI * phase).cos()
                } else {
                    0.0
                }
            }
        }
    }

    /// ∫₀ᵗ g.
    pub fn integral(&self, t: f64) -> f64 {
        match self {
            Self::Table(table) => table.integral(t),
            Self::Course(course) => course.integral(t),
            _ => self.primitive(t) - self.primitive(0.0),
        }
    }

    /// The integral of the kinds that have it in closed form.
    fn primitive(&self, t: f64) -> f64 {
        match *self {
            Self::Constant | Self::Table(_) | Self::Course(_) => t,
            Self::Ramp { start, duration } => {
                let rise = (t - start).clamp(0.0, duration);
                0.5 * rise * rise / duration + (t - start - duration).max(0.0)
            }
            Self::Pulse { start, duration } => {
                let phase = ((t - start) / duration).clamp(0.0, 1.0);
                duration * (0.5 * phase - (2.0 * PI * phase).sin() / (4.0 * PI))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_and_integrals_agree_with_values() {
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
            TimeFunction::Table(Arc::new(
                TimeTable::new(vec![(-0.1, 2.0), (0.2, 1.0), (0.9, 4.0)]).unwrap(),
            )),
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
