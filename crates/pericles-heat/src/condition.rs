//! Conditions on a diffusing field.

use std::fmt;
use std::sync::Arc;

/// A value at a point and time.
pub type Value = Arc<dyn Fn(usize, f64) -> f64 + Send + Sync>;

/// A condition on the points of a set.
#[derive(Clone)]
pub struct Condition {
    /// Name in messages and columns.
    pub name: String,
    /// The points, ascending.
    pub points: Vec<u32>,
    /// What acts on them.
    pub kind: Kind,
}

/// What acts on the points of a condition.
#[derive(Clone)]
pub enum Kind {
    /// A prescribed value of the field.
    Prescribed(Value),
    /// An inflow per area (flux, W/m²) or per volume (source, W/m³).
    Inflow {
        /// Inflow per measure.
        density: Value,
        /// Area (m²) or volume (m³) of each point of the condition.
        measure: Vec<f64>,
    },
    /// An exchange with the surroundings.
    Exchange {
        /// The law.
        law: Exchange,
        /// Coefficient h: inflow per area is h (g(T∞) − g(T)).
        coefficient: f64,
        /// T∞.
        ambient: Value,
        /// Area of each point of the condition, m².
        area: Vec<f64>,
    },
}

/// Law of an exchange with the surroundings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exchange {
    /// g(T) = T: convection.
    Linear,
    /// g(T) = T³|T|: radiation with the coefficient ε σ. Temperatures below zero are outside its range, but a solution that
    /// oscillates about zero is still driven towards the ambient temperature.
    FourthPower,
}

impl Exchange {
    pub(crate) fn value(self, t: f64) -> f64 {
        match self {
            Self::Linear => t,
            Self::FourthPower => t * t * t * t.abs(),
        }
    }

    pub(crate) fn derivative(self, t: f64) -> f64 {
        match self {
            Self::Linear => 1.0,
            Self::FourthPower => 4.0 * t * t * t.abs(),
        }
    }
}

impl Condition {
    /// Returns whether it prescribes the value of the field.
    pub fn is_prescribed(&self) -> bool {
        matches!(self.kind, Kind::Prescribed(_))
    }

    /// Returns whether it determines the level of a steady state: a prescribed value or an exchange.
    pub fn determines_level(&self) -> bool {
        !matches!(self.kind, Kind::Inflow { .. })
    }

    pub(crate) fn quantity(&self) -> &'static str {
        match self.kind {
            Kind::Prescribed(_) => "prescribed temperature",
            Kind::Inflow { .. } => "heat flux or source",
            Kind::Exchange { .. } => "ambient temperature",
        }
    }

    pub(crate) fn value(&self) -> &Value {
        match &self.kind {
            Kind::Prescribed(value)
            | Kind::Inflow { density: value, .. }
            | Kind::Exchange { ambient: value, .. } => value,
        }
    }
}

impl fmt::Debug for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("Condition");
        shown
            .field("name", &self.name)
            .field("points", &self.points.len())
            .finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radiation_rises_with_the_temperature_on_both_sides_of_zero() {
        let law = Exchange::FourthPower;
        assert_eq!(law.value(3.0), 81.0);
        assert_eq!(law.value(-3.0), -81.0);
        for t in [-300.0, -2.0, 0.5, 300.0] {
            let step = 1e-4 * f64::abs(t);
            let slope = (law.value(t + step) - law.value(t - step)) / (2.0 * step);
            assert!((law.derivative(t) / slope - 1.0).abs() < 1e-6, "{t}");
            assert!(slope > 0.0);
        }
    }
}
