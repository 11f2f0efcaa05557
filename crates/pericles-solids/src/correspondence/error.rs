//! Errors of correspondence bodies.

use pericles::PericlesError;
use pericles::space::PointCloud;
use pericles::units::quantity;

/// A point whose bonds do not determine a deformation gradient.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the shape tensor of point {point} at ({}, {}, {}) is singular: its {bonds} bonds do not span the space (condition number {condition:.1e}; at least {} bonds and a condition number of at most 1e6 are needed); \
     choose a larger horizon, or move the crack or the boundary that separates the point from its neighbours",
    quantity(position[0], "m"), quantity(position[1], "m"), quantity(position[2], "m"), dimension + 1
)]
pub struct SingularShape {
    /// The point, in the user's numbering.
    pub point: usize,
    /// Where it is, m.
    pub position: [f64; 3],
    /// Its bonds.
    pub bonds: usize,
    /// The ratio of the principal values of its shape tensor.
    pub condition: f64,
    /// The body's dimension.
    pub dimension: usize,
}

impl SingularShape {
    pub(super) fn new(cloud: &PointCloud, i: usize, bonds: usize, condition: f64) -> Self {
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
