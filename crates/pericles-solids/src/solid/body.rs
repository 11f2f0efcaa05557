//! Bodies of state-based materials.

use std::sync::Arc;

use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::kernel::Influence;
use pericles::material::Materials;
use pericles::neighbourhood::DamageMeasure;
use pericles::space::PointCloud;

/// A body of state-based materials: the input of its force operator.
#[derive(Debug, Clone)]
pub struct SolidBody<'a, S> {
    /// The points.
    pub cloud: &'a Arc<PointCloud>,
    /// The materials, which have the horizon and the influence function of the body.
    pub materials: Materials<S>,
    /// Horizon δ, m.
    pub horizon: f64,
    /// Influence function.
    pub influence: &'a Influence,
    /// Partial volumes at the horizon.
    pub volume_correction: VolumeCorrection,
    /// Pre-cracks, which are cut before anything is computed from bonds.
    pub cracks: &'a [(Crack, EndRule)],
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
    /// Weights of bonds in the damage.
    pub damage: DamageMeasure,
}

impl<'a, S> SolidBody<'a, S> {
    /// Creates a body without pre-cracks and without unbreakable bonds, with partial volumes of cells cut by the horizon.
    pub fn new(
        cloud: &'a Arc<PointCloud>,
        materials: Materials<S>,
        horizon: f64,
        influence: &'a Influence,
    ) -> Self {
        Self {
            cloud,
            materials,
            horizon,
            influence,
            volume_correction: VolumeCorrection::default(),
            cracks: &[],
            no_fail: &[],
            damage: DamageMeasure::default(),
        }
    }
}
