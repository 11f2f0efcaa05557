//! Body forces.

use super::TimeFunction;
use crate::operator::On;
use crate::space::{PointCloud, PointSet};

/// A force density b(t) = density · g(t) on a set of points, N/m³.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// The loaded points.
    pub points: PointSet,
    /// Amplitude, N/m³; components beyond the body's dimension are zero.
    pub density: [f64; 3],
    /// g(t).
    pub function: TimeFunction,
}

impl Load {
    /// A traction (force per area, Pa) that acts on `area` (m²) of a layer, spread over the layer's volume: b = traction · area / ΣV.
    pub fn traction(
        cloud: &PointCloud,
        points: PointSet,
        traction: [f64; 3],
        area: f64,
        function: TimeFunction,
    ) -> Self {
        let volume: f64 = points.iter().map(|&i| cloud.volumes()[i as usize]).sum();
        Self {
            points,
            density: traction.map(|component| component * area / volume),
            function,
        }
    }

    /// Adds the force density at time t for the points named by `on`.
    pub(crate) fn add_force(
        &self,
        t: f64,
        on: &On<'_>,
        points: usize,
        dimension: usize,
        out: &mut [f64],
    ) {
        let factor = self.function.value(t);
        for c in 0..dimension {
            let force = self.density[c] * factor;
            if force == 0.0 {
                continue;
            }
            let component = &mut out[c * points..(c + 1) * points];
            on.common(&self.points, |_, i| component[i] += force);
        }
    }

    /// Resultant force at time t, N.
    pub fn resultant(&self, t: f64, cloud: &PointCloud) -> [f64; 3] {
        let volume: f64 = self
            .points
            .iter()
            .map(|&i| cloud.volumes()[i as usize])
            .sum();
        let factor = self.function.value(t);
        self.density.map(|component| component * factor * volume)
    }
}
