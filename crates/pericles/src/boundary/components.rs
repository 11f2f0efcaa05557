//! Prescribed motions as single components, for processors that compute them themselves.

use super::{AxisMotion, PrescribedMotion};

/// A prescribed component of a point: its displacement is start + amplitude · unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionComponent {
    /// Entry of the state's arrays.
    pub entry: usize,
    /// Entry of the reactions.
    pub slot: usize,
    /// Amplitude, m or m/s.
    pub amplitude: f64,
    /// Displacement to which the motion adds, m.
    pub start: f64,
}

impl PrescribedMotion {
    /// Returns the prescribed components that no other constraint prescribes; `None` if the motion is not a product of
    /// amplitudes and [`PrescribedMotion::unit`].
    pub fn components(&self, cloud_len: usize) -> Option<Vec<MotionComponent>> {
        let mut components = Vec::new();
        for (axis, c) in self.axes().enumerate() {
            for (k, &i) in self.points.iter().enumerate() {
                let amplitude = match self.along[c].as_ref()? {
                    AxisMotion::Uniform(amplitude) => *amplitude,
                    AxisMotion::PerPoint(amplitudes) => amplitudes[k],
                    AxisMotion::Trajectory { .. } | AxisMotion::Values(_) => return None,
                };
                let slot = axis * self.points.len() + k;
                if self.shared.binary_search(&(slot as u32)).is_err() {
                    components.push(MotionComponent {
                        entry: c * cloud_len + i as usize,
                        slot,
                        amplitude,
                        start: self.start[slot],
                    });
                }
            }
        }
        Some(components)
    }

    /// Reaction force densities of the prescribed components at the last accepted state, N/m³, by
    /// [`MotionComponent::slot`].
    pub fn reactions_mut(&mut self) -> &mut [f64] {
        &mut self.reaction
    }
}
