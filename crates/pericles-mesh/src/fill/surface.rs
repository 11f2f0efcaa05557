//! Triangulated surfaces.

use std::collections::HashMap;

use super::FillError;
use crate::element::{cross, dot};
use crate::raw::RawMesh;

/// Triangles with corners counter-clockwise as seen from outside. They may form several closed surfaces,
/// which may overlap; an inner surface of opposite orientation is a cavity.
#[derive(Debug, Clone, PartialEq)]
pub struct TriangleSurface {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl TriangleSurface {
    /// Creates a surface from positions and corners.
    ///
    /// # Errors
    /// Returns an error for no triangles, a coordinate that is not finite, or a corner that is not the number
    /// of a vertex.
    pub fn new(positions: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self, FillError> {
        if triangles.is_empty() {
            return Err(FillError::Empty);
        }
        for (vertex, x) in positions.iter().enumerate() {
            if let Some(&value) = x.iter().find(|x| !x.is_finite()) {
                return Err(FillError::NotFinite { vertex, value });
            }
        }
        let vertices = positions.len();
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&corner) = corners.iter().find(|&&c| c as usize >= vertices) {
                return Err(FillError::NoSuchVertex {
                    triangle,
                    corner,
                    vertices,
                });
            }
        }
        Ok(Self {
            positions,
            triangles,
        })
    }

    /// Creates a surface from the plane cells of a mesh, with the unit of length in m.
    ///
    /// # Errors
    /// The same as for [`TriangleSurface::new`].
    pub fn of_mesh(mesh: &RawMesh, unit: f64) -> Result<Self, FillError> {
        let positions = mesh.nodes.iter().map(|x| x.map(|x| x * unit));
        Self::new(positions.collect(), mesh.triangles())
    }

    /// Creates a surface from parts of another one.
    pub(super) fn of_parts(positions: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        Self {
            positions,
            triangles,
        }
    }

    /// Returns the surface with some triangles reversed.
    pub(super) fn with_turned(mut self, turned: &[bool]) -> Self {
        for (triangle, turned) in self.triangles.iter_mut().zip(turned) {
            if *turned {
                triangle.swap(1, 2);
            }
        }
        self
    }

    /// Returns the positions of the vertices, m.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Returns the vertices of the triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Returns the number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Always false: there is at least one triangle.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Returns the corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [[f64; 3]; 3] {
        self.triangles[triangle].map(|vertex| self.positions[vertex as usize])
    }

    /// Returns the corners of the bounding box of all triangles.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for &vertex in self.triangles.iter().flatten() {
            for (c, &x) in self.positions[vertex as usize].iter().enumerate() {
                bounds[0][c] = bounds[0][c].min(x);
                bounds[1][c] = bounds[1][c].max(x);
            }
        }
        bounds
    }

    /// Returns the number of triangle edges that no other triangle traverses in the opposite direction, compared
    /// by the positions of their ends: zero for closed, consistently oriented surfaces.
    pub fn unmatched_edges(&self) -> usize {
        // Zeros of both signs are the same position.
        let key = |x: [f64; 3]| x.map(|x| (x + 0.0).to_bits());
        let mut edges: HashMap<[[u64; 3]; 2], i64> = HashMap::new();
        for triangle in 0..self.len() {
            let corners = self.corners(triangle).map(key);
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                match a.cmp(&b) {
                    std::cmp::Ordering::Less => *edges.entry([a, b]).or_default() += 1,
                    std::cmp::Ordering::Greater => *edges.entry([b, a]).or_default() -= 1,
                    std::cmp::Ordering::Equal => {}
                }
            }
        }
        let unmatched = edges.values().map(|count| count.unsigned_abs());
        unmatched.sum::<u64>() as usize
    }

    /// Returns the enclosed volume Σ a · (b × c) / 6, negative if the triangles point inwards. Positions are
    /// relative to the first vertex of the first triangle.
    pub fn signed_volume(&self) -> f64 {
        let origin = self.corners(0)[0];
        let six = (0..self.len()).map(|triangle| {
            let [a, b, c] = self
                .corners(triangle)
                .map(|x| std::array::from_fn(|k| x[k] - origin[k]));
            dot(a, cross(b, c))
        });
        six.sum::<f64>() / 6.0
    }
}
