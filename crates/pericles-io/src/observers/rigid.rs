//! Impactors as triangles and lines, for pictures and files.
//!
//! Pictures, `.vtp` files and re-rendered pictures use the same description of an impactor at its present place.

use std::f64::consts::TAU;

use pericles::System;
use pericles::observe::Snapshot;
use pericles::space::PointCloud;
use pericles_contact::{Impactor, Pose, Shape};

/// Meridians of a ball, corners of a circle.
const AROUND: usize = 48;
/// Circles of latitude of a ball, with the poles.
const DOWN: usize = 24;

/// A rigid body to draw: triangles of its boundary in three dimensions, otherwise its outline in the plane.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RigidMesh {
    /// Corners, m.
    pub vertices: Vec<[f64; 3]>,
    /// Triangles between the corners, anticlockwise seen from outside; empty for bodies in the plane.
    pub triangles: Vec<[u32; 3]>,
    /// Whether the corners of a body in the plane form a closed polygon.
    pub closed: bool,
}

/// Returns the impactors of a system.
pub fn impactors(system: &System) -> impl Iterator<Item = &Impactor> {
    system
        .interactions()
        .filter_map(|one| one.downcast_ref::<Impactor>())
}

/// Returns the impactors of a snapshot at their present places, for pictures.
pub(super) fn rigid_meshes(snapshot: &Snapshot<'_>) -> Vec<RigidMesh> {
    impactors(snapshot.system())
        .map(|one| RigidMesh::of(one, snapshot.whole_cloud()))
        .collect()
}

impl RigidMesh {
    /// Returns an impactor at its present place in a body of points. Of a half-space the part of its boundary next to
    /// the body is shown.
    pub fn of(impactor: &Impactor, cloud: &PointCloud) -> Self {
        let pose = impactor.pose();
        let own = match (impactor.shape(), cloud.dimension()) {
            (Shape::HalfSpace, dimension) => return boundary(&pose, cloud, dimension),
            (Shape::Ball { radius }, 3) => ball(*radius),
            (Shape::Box { half }, 3) => block(*half),
            (
                Shape::Cylinder {
                    radius,
                    half_height,
                },
                3,
            ) => cylinder(*radius, *half_height),
            (Shape::Mesh(mesh), _) => Self {
                vertices: mesh.vertices().to_vec(),
                triangles: mesh.triangles().to_vec(),
                closed: true,
            },
            (Shape::Ball { radius } | Shape::Cylinder { radius, .. }, _) => polygon(
                (0..AROUND)
                    .map(|k| {
                        let (sin, cos) = (k as f64 * TAU / AROUND as f64).sin_cos();
                        [radius * cos, radius * sin, 0.0]
                    })
                    .collect(),
            ),
            (Shape::Box { half: [a, b, _] }, _) => polygon(vec![
                [-a, -b, 0.0],
                [*a, -b, 0.0],
                [*a, *b, 0.0],
                [-a, *b, 0.0],
            ]),
        };
        let vertices = own.vertices.iter().map(|&q| placed(&pose, q));
        Self {
            vertices: vertices.collect(),
            ..own
        }
    }

    /// Returns the mesh as numbers, for files: closed, numbers of vertices and triangles, vertices, triangles.
    pub(super) fn to_numbers(&self) -> Vec<f64> {
        let head = [
            f64::from(u8::from(self.closed)),
            self.vertices.len() as f64,
            self.triangles.len() as f64,
        ];
        let vertices = self.vertices.iter().flatten().copied();
        let triangles = self.triangles.iter().flatten().map(|&k| f64::from(k));
        head.into_iter().chain(vertices).chain(triangles).collect()
    }

    /// Reads meshes from their numbers, one after the other; `None` if they are incomplete.
    pub(super) fn from_numbers(mut numbers: &[f64]) -> Option<Vec<Self>> {
        let mut meshes = Vec::new();
        while !numbers.is_empty() {
            let (head, rest) = numbers.split_at_checked(3)?;
            let (vertices, rest) = rest.split_at_checked(3 * head[1] as usize)?;
            let (triangles, rest) = rest.split_at_checked(3 * head[2] as usize)?;
            let three = |of: &[f64]| [of[0], of[1], of[2]];
            let corners = |of: &[f64]| three(of).map(|k| k as u32);
            meshes.push(Self {
                vertices: vertices.chunks(3).map(three).collect(),
                triangles: triangles.chunks(3).map(corners).collect(),
                closed: head[0] != 0.0,
            });
            numbers = rest;
        }
        Some(meshes)
    }

    /// Returns the positions of the corners of all triangles, three after each other.
    pub(super) fn corners(&self) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
        let triangles = self.triangles.iter();
        triangles.map(|triangle| triangle.map(|k| self.vertices[k as usize]))
    }

    /// Returns the outline of a body in the plane; empty for triangles.
    pub(super) fn outline(&self) -> Vec<[f64; 2]> {
        if !self.triangles.is_empty() {
            return Vec::new();
        }
        let first = self.vertices.first().filter(|_| self.closed);
        let all = self.vertices.iter().chain(first);
        all.map(|&[x, y, _]| [x, y]).collect()
    }
}

/// Returns the position in space of a point of the frame of a shape.
fn placed(pose: &Pose, q: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| {
        let row = pose.rotation[c];
        pose.centre[c] + row[0] * q[0] + row[1] * q[1] + row[2] * q[2]
    })
}

fn polygon(vertices: Vec<[f64; 3]>) -> RigidMesh {
    RigidMesh {
        vertices,
        triangles: Vec::new(),
        closed: true,
    }
}

/// Returns the part of the boundary of a half-space near the body: a square, or a line in the plane.
fn boundary(pose: &Pose, cloud: &PointCloud, dimension: usize) -> RigidMesh {
    let [low, high] = cloud.bounds();
    let middle: [f64; 3] = std::array::from_fn(|c| 0.5 * (low[c] + high[c]));
    let size = (0..3)
        .map(|c| (high[c] - low[c]).powi(2))
        .sum::<f64>()
        .sqrt();
    let half = 0.5 * size;
    let column = |k: usize| -> [f64; 3] { std::array::from_fn(|c| pose.rotation[c][k]) };
    let [a, b, normal] = [0, 1, 2].map(column);
    let dot = |u: [f64; 3], v: [f64; 3]| (0..3).map(|c| u[c] * v[c]).sum::<f64>();
    let relative: [f64; 3] = std::array::from_fn(|c| middle[c] - pose.centre[c]);
    let above = dot(relative, normal);
    let foot: [f64; 3] = std::array::from_fn(|c| middle[c] - above * normal[c]);
    let at = |s: f64, t: f64| -> [f64; 3] {
        std::array::from_fn(|c| foot[c] + half * (s * a[c] + t * b[c]))
    };
    if dimension == 3 {
        return RigidMesh {
            vertices: vec![at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            closed: false,
        };
    }
    // In the plane along the boundary.
    let along = [-normal[1], normal[0], 0.0];
    let end = |s: f64| std::array::from_fn(|c| foot[c] + s * half * along[c]);
    RigidMesh {
        vertices: vec![end(-1.0), end(1.0)],
        triangles: Vec::new(),
        closed: false,
    }
}

fn ball(radius: f64) -> RigidMesh {
    let mut vertices = vec![[0.0, 0.0, radius]];
    for row in 1..DOWN {
        let (across, z) = (0.5 * TAU * row as f64 / DOWN as f64).sin_cos();
        for k in 0..AROUND {
            let (sin, cos) = (k as f64 * TAU / AROUND as f64).sin_cos();
            vertices.push([radius * across * cos, radius * across * sin, radius * z]);
        }
    }
    vertices.push([0.0, 0.0, -radius]);
    let last = vertices.len() as u32 - 1;
    let at = |row: usize, k: usize| (1 + (row - 1) * AROUND + k % AROUND) as u32;
    let mut triangles = Vec::new();
    for k in 0..AROUND {
        triangles.push([0, at(1, k), at(1, k + 1)]);
        for row in 1..DOWN - 1 {
            triangles.push([at(row, k), at(row + 1, k), at(row + 1, k + 1)]);
            triangles.push([at(row, k), at(row + 1, k + 1), at(row, k + 1)]);
        }
        triangles.push([at(DOWN - 1, k), last, at(DOWN - 1, k + 1)]);
    }
    RigidMesh {
        vertices,
        triangles,
        closed: true,
    }
}

fn cylinder(radius: f64, half_height: f64) -> RigidMesh {
    let mut vertices = vec![[0.0, 0.0, -half_height], [0.0, 0.0, half_height]];
    for k in 0..AROUND {
        let (sin, cos) = (k as f64 * TAU / AROUND as f64).sin_cos();
        for z in [-half_height, half_height] {
            vertices.push([radius * cos, radius * sin, z]);
        }
    }
    let at = |k: usize, top: usize| (2 + 2 * (k % AROUND) + top) as u32;
    let mut triangles = Vec::new();
    for k in 0..AROUND {
        triangles.push([at(k, 0), at(k + 1, 0), at(k + 1, 1)]);
        triangles.push([at(k, 0), at(k + 1, 1), at(k, 1)]);
        triangles.push([0, at(k + 1, 0), at(k, 0)]);
        triangles.push([1, at(k, 1), at(k + 1, 1)]);
    }
    RigidMesh {
        vertices,
        triangles,
        closed: true,
    }
}

fn block(half: [f64; 3]) -> RigidMesh {
    let corner = |k: usize| {
        std::array::from_fn(|c| match k >> c & 1 {
            0 => -half[c],
            _ => half[c],
        })
    };
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let (b, c) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        let high = 1u32 << axis;
        triangles.extend([
            [high, high + b, high + b + c],
            [high, high + b + c, high + c],
        ]);
        triangles.extend([[0, b + c, b], [0, c, b + c]]);
    }
    RigidMesh {
        vertices: (0..8).map(corner).collect(),
        triangles,
        closed: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the volume enclosed by triangles, positive for anticlockwise ones.
    fn volume(mesh: &RigidMesh) -> f64 {
        let six = |[a, b, c]: [[f64; 3]; 3]| {
            a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        mesh.corners().map(six).sum::<f64>() / 6.0
    }

    #[test]
    fn triangles_enclose_the_volume_of_the_shape_and_run_anticlockwise() {
        let pi = std::f64::consts::PI;
        let exact = [
            (volume(&block([1.0, 2.0, 0.5])), 8.0, 1e-14),
            (volume(&ball(2.0)), 32.0 * pi / 3.0, 0.01),
            (volume(&cylinder(2.0, 1.5)), 12.0 * pi, 0.01),
        ];
        let both = [block([1.0, 2.0, 0.5]), polygon(vec![[1.0, 0.0, 0.0]; 3])];
        let numbers: Vec<f64> = both.iter().flat_map(RigidMesh::to_numbers).collect();
        assert_eq!(RigidMesh::from_numbers(&numbers).unwrap(), both);
        assert_eq!(RigidMesh::from_numbers(&numbers[1..]), None);
        for (found, expected, tolerance) in exact {
            assert!(
                (found / expected - 1.0).abs() < tolerance,
                "{found} {expected}"
            );
        }
    }
}
