//! Triangulated closed surfaces (2-manifolds) in space.
//!
//! A [`Surface`] consists of vertices and triangles, created by a formula ([`Surface::icosphere`],
//! [`Surface::torus`] …) or from arrays. [`Surface::checked`] checks that it is a closed, oriented, connected
//! manifold and reports which of seven conditions it violates. [`HalfEdges`] holds its adjacency. Vertex areas
//! sum to the area of the triangles ([`AreaRule`]); [`Surface::cotangents`] are the weights of the Laplacian of
//! linear elements.
//!
//! ```
//! use pericles_manifold::surface::{AreaRule, Surface, SurfaceChecks};
//! let sphere = Surface::icosphere(3, 1.0)?;
//! let (sphere, report) = sphere.checked(SurfaceChecks::default())?;
//! assert_eq!((sphere.len(), report.edges, sphere.triangles().len()), (642, 1920, 1280));
//! let sum: f64 = sphere.vertex_areas(AreaRule::Barycentric).iter().sum();
//! assert!((sum - 12.506492733969928).abs() < 1e-12);
//! # Ok::<(), pericles_manifold::surface::SurfaceError>(())
//! ```

mod caution;
mod check;
mod error;
mod half_edges;
mod measure;
mod order;
mod shapes;
mod weld;

pub use caution::SurfaceCaution;
pub use check::{Component, SurfaceChecks, SurfaceReport};
pub use error::SurfaceError;
pub use half_edges::HalfEdges;
pub use measure::{AreaRule, Cotangents};

use pericles::space::Point;

/// Triangulated surface.
///
/// The corners of a triangle run counter-clockwise seen from outside. Vertices keep the given order unless
/// [`Surface::renumbered`] is called; [`Surface::user_number`] returns the number under which a vertex was
/// given.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    positions: Vec<Point>,
    triangles: Vec<[u32; 3]>,
    user_numbers: Vec<u32>,
}

impl Surface {
    /// Creates a surface from positions (m) and triangle corners. Only the validity of the numbers is checked:
    /// see [`Surface::checked`].
    ///
    /// # Errors
    /// No triangle, more vertices than 2³² − 2, a coordinate that is NaN or infinite, or a corner that is not a
    /// vertex.
    pub fn new(positions: Vec<Point>, triangles: Vec<[u32; 3]>) -> Result<Self, SurfaceError> {
        let vertices = positions.len();
        // Half-edges, three per triangle, are numbered in 32 bits too.
        let limit = u32::MAX as usize / 3 - 1;
        for (what, count) in [("vertices", vertices), ("triangles", triangles.len())] {
            if count > limit {
                return Err(SurfaceError::TooLarge { what, count, limit });
            }
        }
        if triangles.is_empty() {
            return Err(SurfaceError::Empty);
        }
        for (vertex, position) in positions.iter().enumerate() {
            if let Some(&value) = position.iter().find(|x| !x.is_finite()) {
                return Err(SurfaceError::NotFinite { vertex, value });
            }
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices) {
                return Err(SurfaceError::NoSuchVertex {
                    triangle,
                    vertex: vertex as usize,
                    vertices,
                });
            }
        }
        let user_numbers = (0..vertices as u32).collect();
        Ok(Self {
            positions,
            triangles,
            user_numbers,
        })
    }

    /// Positions of the vertices, m.
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// Corners of the triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Always false: a surface has at least one triangle.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Number under which a vertex was given.
    pub fn user_number(&self, vertex: usize) -> usize {
        self.user_numbers[vertex] as usize
    }

    /// Numbers under which the vertices were given.
    pub fn user_numbers(&self) -> &[u32] {
        &self.user_numbers
    }

    /// Lowest and highest coordinates, m.
    pub fn bounds(&self) -> [Point; 2] {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for position in &self.positions {
            for c in 0..3 {
                bounds[0][c] = bounds[0][c].min(position[c]);
                bounds[1][c] = bounds[1][c].max(position[c]);
            }
        }
        bounds
    }

    /// Positions of a triangle's corners.
    pub(crate) fn corners(&self, triangle: [u32; 3]) -> [Point; 3] {
        triangle.map(|vertex| self.positions[vertex as usize])
    }
}
