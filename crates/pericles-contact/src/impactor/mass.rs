//! Mass and inertia of rigid bodies.

use std::f64::consts::PI;

use super::mesh::Solid;
use super::shape::Shape;
use crate::vector::{M3, UNIT};

/// Mass and inertia of a rigid body that moves freely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Inertia {
    /// A homogeneous body of this density, kg/m³.
    Density(f64),
    /// Mass and inertia.
    Mass {
        /// Mass, kg.
        mass: f64,
        /// Inertia tensor about the centre in the frame of the shape, kg m²; if missing, the tensor of a homogeneous body.
        inertia: Option<[[f64; 3]; 3]>,
    },
}

/// Mass and principal moments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass: f64,
    /// Principal moments of inertia, kg m².
    pub moments: [f64; 3],
    /// Principal axes in the frame of the shape, as columns.
    pub axes: [[f64; 3]; 3],
}

/// Volume and second moments of a shape about its centre in a body of a dimension with a section (thickness of a plate,
/// cross-section of a bar); `None` for shapes without a volume.
pub(crate) fn solid(shape: &Shape, dimension: usize, section: f64) -> Option<Solid> {
    let own = |volume: f64, squares: [f64; 3]| Solid {
        volume,
        centre: [0.0; 3],
        second: std::array::from_fn(|a| {
            std::array::from_fn(|b| if a == b { volume * squares[a] } else { 0.0 })
        }),
    };
    match shape {
        Shape::Ball { radius } => {
            let square = radius * radius;
            Some(match dimension {
                1 => own(2.0 * radius * section, [square / 3.0, 0.0, 0.0]),
                2 => own(
                    PI * square * section,
                    [square / 4.0, square / 4.0, section * section / 12.0],
                ),
                _ => own(4.0 / 3.0 * PI * square * radius, [square / 5.0; 3]),
            })
        }
        Shape::Box { half } => {
            let volume: f64 = half[..dimension].iter().map(|half| 2.0 * half).product();
            let square = |c: usize| match c < dimension {
                true => half[c] * half[c] / 3.0,
                false if dimension == 2 => section * section / 12.0,
                false => 0.0,
            };
            Some(own(volume * section, std::array::from_fn(square)))
        }
        Shape::Cylinder {
            radius,
            half_height,
        } => {
            let square = radius * radius;
            let height = match dimension {
                3 => 2.0 * half_height,
                _ => section,
            };
            Some(match dimension {
                1 => own(2.0 * radius * section, [square / 3.0, 0.0, 0.0]),
                _ => own(
                    PI * square * height,
                    [square / 4.0, square / 4.0, height * height / 12.0],
                ),
            })
        }
        Shape::HalfSpace => None,
        Shape::Mesh(mesh) => Some(mesh.solid()),
    }
}

impl Inertia {
    /// Returns mass and principal moments of a body; `None` if they are not positive and finite or not known.
    pub(crate) fn of(&self, solid: Option<Solid>, dimension: usize) -> Option<MassProperties> {
        let tensor = |density: f64, solid: &Solid| -> M3 {
            let s = &solid.second;
            let trace = s[0][0] + s[1][1] + s[2][2];
            std::array::from_fn(|a| {
                std::array::from_fn(|b| density * (trace * UNIT[a][b] - s[a][b]))
            })
        };
        let (mass, inertia) = match (*self, solid) {
            (Self::Density(density), Some(solid)) => {
                (density * solid.volume, tensor(density, &solid))
            }
            (
                Self::Mass {
                    mass,
                    inertia: Some(inertia),
                },
                _,
            ) => (mass, inertia),
            (Self::Mass { mass, .. }, Some(solid)) => (mass, tensor(mass / solid.volume, &solid)),
            _ => return None,
        };
        if !(mass > 0.0 && mass.is_finite()) {
            return None;
        }
        let (moments, axes) = principal(inertia);
        // Bars do not turn, and plates turn about z only.
        let needed = match dimension {
            1 => &[][..],
            2 => &[2][..],
            _ => &[0, 1, 2][..],
        };
        let positive = |&c: &usize| moments[c] > 0.0 && moments[c].is_finite();
        needed.iter().all(positive).then_some(MassProperties {
            mass,
            moments: moments.map(|one| if one > 0.0 { one } else { mass }),
            axes,
        })
    }
}

/// Returns eigenvalues and eigenvectors (columns) of a symmetric matrix by Jacobi rotations. A diagonal matrix is returned
/// with the coordinate axes.
fn principal(mut m: M3) -> ([f64; 3], M3) {
    /// Each sweep squares the ratio of the other entries to the diagonal.
    const SWEEPS: usize = 30;
    let mut axes = UNIT;
    let scale = m.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q].abs() <= 1e-300_f64.max(f64::EPSILON * f64::EPSILON * scale) {
                continue;
            }
            let ratio = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            let t = 1.0f64.copysign(ratio) / (ratio.abs() + (ratio * ratio + 1.0).sqrt());
            let cos = 1.0 / (t * t + 1.0).sqrt();
            let sin = t * cos;
            let turn = |row: &mut [f64; 3]| {
                let (a, b) = (row[p], row[q]);
                row[p] = cos * a - sin * b;
                row[q] = sin * a + cos * b;
            };
            m.iter_mut().for_each(turn);
            let (a, b) = (m[p], m[q]);
            m[p] = std::array::from_fn(|c| cos * a[c] - sin * b[c]);
            m[q] = std::array::from_fn(|c| sin * a[c] + cos * b[c]);
            axes.iter_mut().for_each(turn);
        }
    }
    ([m[0][0], m[1][1], m[2][2]], axes)
}
