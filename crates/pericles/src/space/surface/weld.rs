//! Surfaces with fewer vertices.

use super::check::same_places;
use super::{Surface, SurfaceError};

impl Surface {
    /// The surface with vertices nearer to each other than `tolerance` (m) made one, the first of them; triangles that lose a corner by it are left out.
    /// Vertices are numbered anew.
    ///
    /// # Errors
    /// [`SurfaceError::Empty`] if no triangle is left.
    pub fn welded(&self, tolerance: f64) -> Result<Self, SurfaceError> {
        let first = same_places(&self.positions, tolerance);
        let corners = |triangle: &[u32; 3]| triangle.map(|vertex| first[vertex as usize]);
        let kept = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
        let triangles = self.triangles.iter().map(corners).filter(kept).collect();
        let keep: Vec<bool> = first
            .iter()
            .enumerate()
            .map(|(k, &first)| first as usize == k)
            .collect();
        self.with_vertices(&keep, triangles)
    }

    /// The surface without the vertices that belong to no triangle. Vertices are numbered anew.
    ///
    /// # Errors
    /// None but those of [`Surface::new`].
    pub fn without_unreferenced(&self) -> Result<Self, SurfaceError> {
        let mut used = vec![false; self.len()];
        for &vertex in self.triangles.iter().flatten() {
            used[vertex as usize] = true;
        }
        let triangles = self.triangles.clone();
        self.with_vertices(&used, triangles)
    }

    fn with_vertices(
        &self,
        keep: &[bool],
        mut triangles: Vec<[u32; 3]>,
    ) -> Result<Self, SurfaceError> {
        let mut number = vec![0u32; keep.len()];
        let mut positions = Vec::new();
        for (vertex, position) in self.positions.iter().enumerate() {
            number[vertex] = positions.len() as u32;
            if keep[vertex] {
                positions.push(*position);
            }
        }
        for vertex in triangles.iter_mut().flatten() {
            *vertex = number[*vertex as usize];
        }
        Self::new(positions, triangles)
    }
}
