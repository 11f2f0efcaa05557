//! Critical stretches of bonds by the materials of their ends.

use crate::material::{PairClasses, PairForce};

/// Critical stretches and thresholds of the strain by the materials of a bond's ends.
pub(super) struct PairThresholds {
    /// The material of every place that bonds lead to, and the critical stretch of every pair of materials.
    classes: PairClasses,
    /// Thresholds by class of pairs; empty where strengths scatter.
    table: Vec<f64>,
    threshold: fn(f64) -> f64,
}

impl PairThresholds {
    /// Those of a pair law.
    pub fn of<L: PairForce>(classes: PairClasses) -> Self {
        let stretches = match classes.strengths() {
            [] => classes.critical_stretches(),
            _ => &[],
        };
        let table = stretches.iter().map(|&stretch| L::threshold(stretch));
        Self {
            table: table.collect(),
            threshold: L::threshold,
            classes,
        }
    }

    /// The threshold of a bond between two places.
    pub fn threshold(&self, a: usize, b: usize) -> f64 {
        match &self.table[..] {
            [] => (self.threshold)(self.classes.critical_stretch(a, b)),
            table => table[self.classes.class(a, b)],
        }
    }

    /// The critical stretch of a bond between two places.
    pub fn critical_stretch(&self, a: usize, b: usize) -> f64 {
        self.classes.critical_stretch(a, b)
    }
}
