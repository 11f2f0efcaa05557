//! Reasons why a plate cannot have an open boundary.

use pericles::space::Face;
use pericles::units::{quantity, significant};

impl From<OpenError> for pericles::PericlesError {
    fn from(error: OpenError) -> Self {
        Self::Extension(Box::new(error))
    }
}

/// Reason why an open boundary is not possible.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OpenError {
    /// The body is not a plate on a square lattice.
    #[error(
        "open boundary: {found}; allowed: a plate (2D) whose points are all nodes of one square lattice. \
        kind = \"damping-layer\" absorbs waves approximately in any body"
    )]
    NotALattice {
        /// The property of the body.
        found: String,
    },
    /// A side is periodic.
    #[error(
        "open boundary: the side {side} of a periodic body is joined with the opposite side; open both sides, or remove \
        `periodic`"
    )]
    Periodic {
        /// The side.
        side: Face,
    },
    /// Both sides across an open side are free.
    #[error(
        "open boundary: both sides normal to {across} are free, and {side} is open; waves guided between free sides may move \
        against their phase and grow in the layer. Open one of the sides normal to {across} too, make the body periodic, or use \
        kind = \"damping-layer\""
    )]
    Guided {
        /// The open side.
        side: Face,
        /// The axis across it.
        across: char,
    },
    /// The number of cells of a layer is not supported.
    #[error(
        "open boundary: the layer at {side} has {cells} cells; allowed: from {least} cells to {most}. With more cells it \
        reflects less: 12 cells suffice for most purposes"
    )]
    Cells {
        /// The side.
        side: Face,
        /// Number of cells.
        cells: usize,
        /// The least number: 8, or the reach of the bonds.
        least: usize,
        /// The largest number.
        most: usize,
    },
    /// The body has no room for the layers.
    #[error(
        "open boundary: the body has {nodes} points along {axis}, of which its layers occupy {layers}; allowed: at least {least} \
        points. Use a larger body or thinner layers"
    )]
    NoRoom {
        /// The axis.
        axis: char,
        /// Points of the body along the axis.
        nodes: usize,
        /// Points of its layers.
        layers: usize,
        /// The least number of points.
        least: usize,
    },
    /// The points have no forces.
    #[error(
        "open boundary: the forces of the body do not depend on its displacement; an open boundary needs a stiffness"
    )]
    NoForces,
    /// Bonds are longer than supported.
    #[error(
        "open boundary: bonds are longer than {largest} cells along an axis; allowed: up to {largest}. Use a smaller horizon"
    )]
    Reach {
        /// The largest reach, in cells.
        largest: usize,
    },
    /// The speed of waves depends on the axis.
    #[error(
        "open boundary: longitudinal waves have the speed {} along x and {} along y; allowed: equal speeds. Use an isotropic \
        material", quantity(speeds[0], "m/s"), quantity(speeds[1], "m/s")
    )]
    Anisotropic {
        /// Speeds along x and y, m/s.
        speeds: [f64; 2],
    },
    /// The forces in the layer are not those of a uniform lattice.
    #[error(
        "open boundary: the layer is not uniform: at point {point} the force differs by {} from that of a uniform lattice. The \
        layers and one horizon before them must have no holes, pre-cracks, surface correction, other material or density; move the \
        sides outwards", significant(*share, 3)
    )]
    NotUniform {
        /// The first such point, in the user's numbering.
        point: usize,
        /// Difference relative to the largest force.
        share: f64,
    },
    /// Nodes of the layers are not points of the body.
    #[error(
        "open boundary: {missing} of the {nodes} cells in the layers and one horizon before them are not points of the body; \
        allowed: no holes there. Move the sides outwards"
    )]
    Holes {
        /// Cells without points.
        missing: usize,
        /// Cells of layers and horizon.
        nodes: usize,
    },
    /// A load or prescribed motion acts on the layer.
    #[error(
        "open boundary: {what} acts on point {point}, which is in a layer or one horizon before it; allowed: loads and constraints \
        elsewhere. Restrict it to a set, or move the sides outwards"
    )]
    ActedOn {
        /// "a load" or "a prescribed motion".
        what: &'static str,
        /// The point, in the user's numbering.
        point: usize,
    },
    /// The initial field is not zero in the layer.
    #[error(
        "open boundary: the initial {field} at point {point}, in a layer or one horizon before it, is {} of the largest one; \
        allowed: {}. Move the sides outwards, to where the initial field is zero", significant(*share, 3), significant(*allowed, 3)
    )]
    NotAtRest {
        /// "displacement" or "velocity".
        field: &'static str,
        /// The point, in the user's numbering.
        point: usize,
        /// Its value relative to the largest one.
        share: f64,
        /// The largest allowed share.
        allowed: f64,
    },
}
