//! Probes: mean displacement and velocity of point sets.

use super::Snapshot;
use crate::error::{PericlesError, Result};
use crate::space::{PointSet, check_points};

/// A set of points at which displacement and velocity are recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Name in tables.
    pub name: String,
    /// Points of the mean, equally weighted.
    pub points: PointSet,
}

/// Mean displacement and velocity of a probe.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ProbeReading {
    /// Mean displacement, m.
    pub displacement: [f64; 3],
    /// Mean velocity, m/s.
    pub velocity: [f64; 3],
}

impl Probe {
    /// Returns the current reading.
    ///
    /// # Errors
    /// A probe without points, or with points that the body does not have.
    pub fn read(&self, snapshot: &Snapshot<'_>) -> Result<ProbeReading> {
        const WHAT: &str = "the points of a probe";
        let n = snapshot.system().points();
        check_points(WHAT, &self.points, n)?;
        let domain = snapshot.system().domain();
        let points = domain.count(self.points.len() as u64);
        if points == 0 {
            return Err(PericlesError::BadSet {
                what: WHAT,
                reason: "no points are given; at least one is needed",
            });
        }
        let mean = |field: &[f64]| -> [f64; 3] {
            std::array::from_fn(|c| {
                if c >= snapshot.system().dimension() {
                    return 0.0;
                }
                let value = |k: usize| field[c * n + self.points[k] as usize];
                domain.sum(self.points.len(), value) / points as f64
            })
        };
        Ok(ProbeReading {
            displacement: mean(&snapshot.state().u),
            velocity: mean(&snapshot.state().v),
        })
    }
}
