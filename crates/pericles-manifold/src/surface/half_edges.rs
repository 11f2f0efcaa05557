//! Adjacency of triangles, edges and vertices.

use super::{Surface, SurfaceError};

/// Half-edges (directed edges) of a triangulated surface.
///
/// Half-edge 3t + k runs from corner k of triangle t to the next corner. Its twin runs back along the same edge
/// in the neighbouring triangle. Every edge has one or two half-edges; the twin of a half-edge on a boundary is
/// [`HalfEdges::NONE`].
#[derive(Debug, Clone)]
pub struct HalfEdges {
    origin: Vec<u32>,
    twin: Vec<u32>,
    /// Half-edges that start at each vertex, in compressed rows.
    around_start: Vec<u32>,
    around: Vec<u32>,
}

impl HalfEdges {
    /// Marks a missing half-edge.
    pub const NONE: u32 = u32::MAX;

    /// Builds the half-edges of a surface.
    ///
    /// # Errors
    /// [`SurfaceError::NonManifoldEdge`] and [`SurfaceError::Flipped`]: twins exist only where at most two
    /// triangles share an edge, in opposite directions.
    pub fn new(surface: &Surface) -> Result<Self, SurfaceError> {
        let origin = origins(surface);
        let sorted = sorted_by_edge(&origin);
        let name = |edge: [u32; 2]| edge.map(|v| surface.user_number(v as usize));
        let mut twin = vec![Self::NONE; origin.len()];
        let (mut crowded, mut flipped) = (Vec::new(), Vec::new());
        for group in sorted.chunk_by(|a, b| a.0 == b.0) {
            let edge = group[0].0;
            match *group {
                [_] => {}
                [(_, a), (_, b)] if origin[a as usize] != origin[b as usize] => {
                    twin[a as usize] = b;
                    twin[b as usize] = a;
                }
                [_, _] => flipped.push(edge),
                _ => crowded.push((edge, group.len())),
            }
        }
        if let Some(&(edge, triangles)) = crowded.first() {
            return Err(SurfaceError::NonManifoldEdge {
                edges: crowded.len(),
                first: name(edge),
                triangles,
            });
        }
        if let Some(&edge) = flipped.first() {
            return Err(SurfaceError::Flipped {
                edges: flipped.len(),
                first: name(edge),
            });
        }
        let (around_start, around) = rows(surface.len(), &origin);
        Ok(Self {
            origin,
            twin,
            around_start,
            around,
        })
    }

    /// Number of half-edges, three per triangle.
    pub fn len(&self) -> usize {
        self.origin.len()
    }

    /// Always false.
    pub fn is_empty(&self) -> bool {
        self.origin.is_empty()
    }

    /// Vertex at which a half-edge starts.
    pub fn origin(&self, half_edge: u32) -> u32 {
        self.origin[half_edge as usize]
    }

    /// Vertex at which a half-edge ends.
    pub fn target(&self, half_edge: u32) -> u32 {
        self.origin[Self::next(half_edge) as usize]
    }

    /// Half-edge back along the same edge, or [`HalfEdges::NONE`].
    pub fn twin(&self, half_edge: u32) -> u32 {
        self.twin[half_edge as usize]
    }

    /// Next half-edge of the same triangle.
    pub fn next(half_edge: u32) -> u32 {
        if half_edge % 3 == 2 {
            half_edge - 2
        } else {
            half_edge + 1
        }
    }

    /// Previous half-edge of the same triangle.
    pub fn previous(half_edge: u32) -> u32 {
        if half_edge.is_multiple_of(3) {
            half_edge + 2
        } else {
            half_edge - 1
        }
    }

    /// Half-edges that start at a vertex, one per triangle around it, ascending.
    pub fn around(&self, vertex: usize) -> &[u32] {
        let row = self.around_start[vertex] as usize..self.around_start[vertex + 1] as usize;
        &self.around[row]
    }

    /// Iterates over the edges: of each pair of twins the half-edge with the lower number, ascending.
    pub fn edges(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.len() as u32).filter(|&h| self.twin(h) > h)
    }

    /// Returns true if the vertex lies on a boundary.
    pub fn on_boundary(&self, vertex: usize) -> bool {
        self.around(vertex)
            .iter()
            .any(|&h| self.twin(h) == Self::NONE || self.twin(Self::previous(h)) == Self::NONE)
    }

    /// Half-edges that start at a vertex, in counter-clockwise order of its triangles; at a boundary from the
    /// first triangle on. For a vertex that joins several fans, one fan.
    pub fn fan(&self, vertex: usize) -> Vec<u32> {
        let around = self.around(vertex);
        let Some(&any) = around.first() else {
            return Vec::new();
        };
        let first = around
            .iter()
            .copied()
            .find(|&h| self.twin(h) == Self::NONE)
            .unwrap_or(any);
        let mut fan = vec![first];
        loop {
            // The left edge at a corner of a triangle is the half-edge that ends there.
            let next = self.twin(Self::previous(fan[fan.len() - 1]));
            if next == Self::NONE || next == first {
                return fan;
            }
            fan.push(next);
        }
    }
}

/// Vertex at which every half-edge starts.
pub(super) fn origins(surface: &Surface) -> Vec<u32> {
    surface.triangles().iter().flatten().copied().collect()
}

/// Half-edges with their two vertices, the lower first, sorted.
pub(super) fn sorted_by_edge(origin: &[u32]) -> Vec<([u32; 2], u32)> {
    let mut sorted: Vec<([u32; 2], u32)> = (0..origin.len() as u32)
        .map(|h| {
            let (a, b) = (origin[h as usize], origin[HalfEdges::next(h) as usize]);
            ([a.min(b), a.max(b)], h)
        })
        .collect();
    sorted.sort_unstable();
    sorted
}

/// Indices of entries grouped by value, in compressed rows.
pub(super) fn rows(values: usize, entries: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0u32; values + 1];
    for &value in entries {
        start[value as usize + 1] += 1;
    }
    for k in 1..start.len() {
        start[k] += start[k - 1];
    }
    let mut next = start.clone();
    let mut row = vec![0u32; entries.len()];
    for (number, &value) in entries.iter().enumerate() {
        let place = &mut next[value as usize];
        row[*place as usize] = number as u32;
        *place += 1;
    }
    (start, row)
}
