//! Critical stretches of bonds as a function of the materials of their ends.

use super::CriticalStretches;
use crate::material::{MaterialPairs, PairForce};

/// Critical stretches and strain thresholds as a function of the materials of both ends of a bond.
pub(super) struct PairThresholds {
    /// Material of each place that is an end of bonds, and critical stretch of each pair of materials.
    classes: MaterialPairs,
    /// Thresholds per class of pairs; empty if strengths are scattered.
    table: Vec<f64>,
    threshold: fn(f64) -> f64,
}

impl PairThresholds {
    /// Creates the thresholds of a pair law.
    pub fn of<L: PairForce>(classes: MaterialPairs) -> Self {
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

    /// Returns the threshold of a bond between two places.
    pub fn threshold(&self, a: usize, b: usize) -> f64 {
        match &self.table[..] {
            [] => (self.threshold)(self.classes.critical_stretch(a, b)),
            table => table[self.classes.class(a, b)],
        }
    }

    /// Returns the critical stretches as data.
    pub fn data(&self) -> CriticalStretches {
        CriticalStretches::Pairs {
            material: self.classes.of_point().to_vec(),
            table: self.classes.critical_stretches().to_vec(),
            factors: self.classes.strengths().to_vec(),
        }
    }

    /// Returns the critical stretch of a bond between two places.
    pub fn critical_stretch(&self, a: usize, b: usize) -> f64 {
        self.classes.critical_stretch(a, b)
    }
}
