//! Welding and removal of vertices.

use pericles::vector::{minus, norm};
use std::collections::HashMap;

use super::{Surface, SurfaceError};
use pericles::space::Point;

impl Surface {
    /// Returns the surface with vertices closer than `tolerance` (m) merged into the first of them; triangles
    /// that collapse are removed and vertices renumbered.
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

    /// Returns the surface without vertices that belong to no triangle. Vertices are renumbered.
    ///
    /// # Errors
    /// As [`Surface::new`].
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

/// For each point, returns the first point within `tolerance` of it, or the point itself.
///
/// Points are sorted into cubes of side `tolerance`, of which 27 are searched.
pub(super) fn same_places(positions: &[Point], tolerance: f64) -> Vec<u32> {
    let side = tolerance.max(f64::MIN_POSITIVE);
    let cell = |x: &Point| x.map(|x| (x / side).floor());
    let key = |cell: [f64; 3]| cell.map(|c| (c + 0.0).to_bits());
    let mut cells: HashMap<[u64; 3], Vec<u32>> = HashMap::with_capacity(positions.len());
    let mut first = Vec::with_capacity(positions.len());
    for (number, x) in positions.iter().enumerate() {
        let at = cell(x);
        let mut found = number as u32;
        for k in 0..27 {
            let near = [
                at[0] + f64::from(k % 3 - 1),
                at[1] + f64::from(k / 3 % 3 - 1),
                at[2] + f64::from(k / 9 - 1),
            ];
            for &other in cells.get(&key(near)).into_iter().flatten() {
                let apart = norm(minus(*x, positions[other as usize]));
                if apart <= tolerance {
                    found = found.min(other);
                }
            }
        }
        if found == number as u32 {
            cells.entry(key(at)).or_default().push(found);
        }
        first.push(found);
    }
    first
}
