//! Shapes of rigid bodies: signed distances in their own frames.

use super::mesh::ClosedMesh;
use crate::vector::{
    M3, UNIT, V3, dot, minus, norm, product, rotation_about, scaled, times, transposed_times,
};

/// Shape of a rigid body in its own frame. In one and two dimensions a shape is infinite along the missing axes, so that
/// a ball is a disc.
#[derive(Debug, Clone)]
pub enum Shape {
    /// Ball about the origin.
    Ball {
        /// Radius, m.
        radius: f64,
    },
    /// Box about the origin.
    Box {
        /// Half of the sides, m.
        half: [f64; 3],
    },
    /// Cylinder about the z axis and the origin.
    Cylinder {
        /// Radius, m.
        radius: f64,
        /// Half of the height, m.
        half_height: f64,
    },
    /// The half-space below the plane z = 0.
    HalfSpace,
    /// A body bounded by triangles.
    Mesh(ClosedMesh),
}

/// Signed distance (m), positive outside, and its gradient.
pub(crate) type Distance = (f64, V3);

impl Shape {
    /// Returns half of the smallest extent of the shape along the axes of its frame, for bodies in a plane along the first two,
    /// m; infinite for half-spaces.
    pub fn smallest_half_width(&self, dimension: usize) -> f64 {
        let axes = dimension.min(3);
        match self {
            Self::Ball { radius } => *radius,
            Self::Box { half } => half[..axes].iter().copied().fold(f64::INFINITY, f64::min),
            Self::Cylinder {
                radius,
                half_height,
            } => match axes {
                3 => radius.min(*half_height),
                _ => *radius,
            },
            Self::HalfSpace => f64::INFINITY,
            Self::Mesh(mesh) => {
                let extent = |c: usize| {
                    let along = mesh.vertices().iter().map(|vertex| vertex[c]);
                    let range = |[low, high]: [f64; 2], x: f64| [low.min(x), high.max(x)];
                    let [low, high] = along.fold([f64::INFINITY, f64::NEG_INFINITY], range);
                    0.5 * (high - low)
                };
                (0..axes).map(extent).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// Returns the signed distance of a point of the shape's frame, m, positive outside, and its gradient.
    pub fn distance(&self, q: [f64; 3]) -> (f64, [f64; 3]) {
        match self {
            Self::Ball { radius } => {
                let r = norm(q);
                let gradient = match r > 0.0 {
                    true => scaled(1.0 / r, q),
                    false => [1.0, 0.0, 0.0],
                };
                (r - radius, gradient)
            }
            Self::HalfSpace => (q[2], [0.0, 0.0, 1.0]),
            Self::Box { half } => {
                let d: V3 = std::array::from_fn(|c| q[c].abs() - half[c]);
                let (s, of_sides) = corner(d);
                (
                    s,
                    std::array::from_fn(|c| of_sides[c].copysign(q[c] * of_sides[c])),
                )
            }
            Self::Cylinder {
                radius,
                half_height,
            } => {
                let r = q[0].hypot(q[1]);
                let (s, [side, _, top]) =
                    corner([r - radius, f64::NEG_INFINITY, q[2].abs() - half_height]);
                let radial = match r > 0.0 {
                    true => [q[0] / r, q[1] / r],
                    false => [1.0, 0.0],
                };
                (
                    s,
                    [side * radial[0], side * radial[1], top.copysign(q[2] * top)],
                )
            }
            Self::Mesh(mesh) => mesh.distance(q),
        }
    }

    /// Radius of a ball about the origin of the frame that contains the shape, m; infinite for a half-space.
    pub fn reach(&self) -> f64 {
        match self {
            Self::Ball { radius } => *radius,
            Self::Box { half } => norm(*half),
            Self::Cylinder {
                radius,
                half_height,
            } => radius.hypot(*half_height),
            Self::HalfSpace => f64::INFINITY,
            Self::Mesh(mesh) => mesh.reach(),
        }
    }

    /// Returns the shape without its ends along axes that the body does not have.
    pub(crate) fn extended(self, dimension: usize) -> Self {
        match self {
            Self::Box { mut half } => {
                half[dimension..].fill(f64::INFINITY);
                Self::Box { half }
            }
            Self::Cylinder { radius, .. } if dimension < 3 => Self::Cylinder {
                radius,
                half_height: f64::INFINITY,
            },
            shape => shape,
        }
    }
}

/// Returns the signed distance of a corner from the signed distances to its sides, and the derivatives by these. Inside,
/// the nearest side counts, the first one of several.
fn corner(d: V3) -> Distance {
    let outside = d.map(|d| d.max(0.0));
    let s = norm(outside);
    if s > 0.0 {
        return (s, scaled(1.0 / s, outside));
    }
    let nearest = (1..3).fold(0, |best, c| if d[c] > d[best] { c } else { best });
    let mut gradient = [0.0; 3];
    gradient[nearest] = 1.0;
    (d[nearest], gradient)
}

/// Position and orientation of a rigid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Position of the origin of the shape's frame, m.
    pub centre: [f64; 3],
    /// Rotation matrix Q by rows: a point q of the frame is at X + Q q.
    pub rotation: [[f64; 3]; 3],
}

impl Pose {
    /// The frame at a position, with the axes of space.
    pub fn at(centre: [f64; 3]) -> Self {
        Self {
            centre,
            rotation: UNIT,
        }
    }

    /// Turns the frame by an angle (radians) about a coordinate axis of space, 0 to 2, through its origin, after its
    /// present rotation.
    #[must_use]
    pub fn turned(self, axis: usize, angle: f64) -> Self {
        Self {
            rotation: product(&rotation_about(axis, angle), &self.rotation),
            ..self
        }
    }

    /// Returns the largest difference of Qᵀ Q from the unit matrix; infinite for a reflection.
    pub(crate) fn error(&self) -> f64 {
        let q: &M3 = &self.rotation;
        let columns: [V3; 3] = std::array::from_fn(|c| [q[0][c], q[1][c], q[2][c]]);
        let mut most: f64 = 0.0;
        for a in 0..3 {
            for b in 0..3 {
                most = most.max((dot(columns[a], columns[b]) - UNIT[a][b]).abs());
            }
        }
        let [a, b, c] = columns;
        match dot(crate::vector::cross(a, b), c) > 0.0 {
            true => most,
            false => f64::INFINITY,
        }
    }

    /// Coordinates of a point of space in the frame.
    #[inline]
    pub(crate) fn into_frame(self, y: V3) -> V3 {
        transposed_times(&self.rotation, minus(y, self.centre))
    }

    /// A vector of the frame in space.
    #[inline]
    pub(crate) fn turn(&self, vector: V3) -> V3 {
        times(&self.rotation, vector)
    }
}
