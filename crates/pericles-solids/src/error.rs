//! Errors of state-based bodies.

use pericles::PericlesError;
use pericles::space::PointCloud;
use pericles::units::quantity;

/// A point whose bonds do not determine a force state.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the shape tensor of point {point} at ({}, {}, {}) is singular: its bonds do not span the space (number of bonds \
     {bonds}, condition number {condition:.1e}); allowed: at least {} bonds and a condition number of at most 1e6; use \
     a larger horizon, or move the crack or boundary that separates the point from its neighbours",
    quantity(position[0], "m"), quantity(position[1], "m"), quantity(position[2], "m"), dimension + 1
)]
pub struct SingularShape {
    /// Number of the point in output files.
    pub point: usize,
    /// Position, m.
    pub position: [f64; 3],
    /// Number of bonds.
    pub bonds: usize,
    /// Condition number of the shape tensor: ratio of its largest and smallest principal value.
    pub condition: f64,
    /// Dimension of the body.
    pub dimension: usize,
}

impl SingularShape {
    pub(crate) fn new(cloud: &PointCloud, i: usize, bonds: usize, condition: f64) -> Self {
        Self {
            point: cloud.user_number(i),
            position: cloud.point(i),
            bonds,
            condition,
            dimension: cloud.dimension(),
        }
    }
}

impl From<SingularShape> for PericlesError {
    fn from(error: SingularShape) -> Self {
        Self::Extension(Box::new(error))
    }
}
