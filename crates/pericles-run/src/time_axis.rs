//! The time of a run as it is shown: static states have a load factor or a load step instead.

use crate::results::Results;
use crate::units::{number_of, quantity};
use pericles_io::Axis;

/// Name, unit and scale of the time of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeAxis {
    name: &'static str,
    unit: &'static str,
    /// The time of one unit, s.
    scale: f64,
}

impl TimeAxis {
    /// The time in seconds.
    pub const TIME: Self = Self {
        name: "time",
        unit: "s",
        scale: 1.0,
    };

    /// Returns the axis of a run: the load factor of static states, whose loads act fully at the end; the load step if
    /// loads are scaled from event to event; otherwise the time.
    pub fn of(results: &Results) -> Self {
        /// Schemes of static states.
        const STATIC: [&str; 3] = ["adaptive-dynamic-relaxation", "fire", "static"];
        let step = results.number("/model/dt").unwrap_or_default();
        let steps = results.count("/model/steps");
        if !STATIC.contains(&results.text("/model/scheme")) || step <= 0.0 || steps == 0 {
            return Self::TIME;
        }
        let of_model = results.text("/model_data/time/scheme/static/breaking");
        let is_event = results.text("/deck/values/time/breaking") == "event" || of_model == "event";
        let (name, scale) = match is_event {
            true => ("load step", step),
            false => ("load factor", step * steps as f64),
        };
        Self {
            name,
            unit: "",
            scale,
        }
    }

    /// Returns the axis of a chart.
    pub fn axis(&self) -> Axis {
        Axis::new(self.name, self.unit)
    }

    /// Returns the name: `time`, `load factor` or `load step`.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Returns the SI unit; empty for load factors and load steps.
    pub fn unit(&self) -> &'static str {
        self.unit
    }

    /// Returns the time of one unit, s.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns times in the unit of the axis.
    pub fn scaled(&self, times: &[f64]) -> Vec<f64> {
        times.iter().map(|t| t / self.scale).collect()
    }

    /// Returns the end of an axis as text: `40.0 µs`, `load factor 0.5`.
    pub fn label(&self, value: f64) -> String {
        match self.unit {
            "" => format!("{} {}", self.name, number_of(value)),
            unit => quantity(value, unit),
        }
    }

    /// Returns a time (s) as text: `t = 40.0 µs`, `load factor 0.5`.
    pub fn stamp(&self, t: f64) -> String {
        let label = self.label(t / self.scale);
        match self.unit {
            "" => label,
            _ => format!("t = {label}"),
        }
    }
}
