//! Areas, volumes, angles and cotangent weights.

use super::{HalfEdges, Surface};
use pericles::Result;
use pericles::space::{Point, PointCloud};
use pericles::vector::{cross, dot, minus, norm, normal};

/// Rule that distributes the area of triangles to their corners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AreaRule {
    /// One third of each triangle to each corner.
    #[default]
    Barycentric,
    /// Voronoi areas if the triangle is not obtuse; otherwise half of it to the obtuse corner and a quarter to
    /// each of the others (Meyer, Desbrun, Schröder, Barr 2003, section 3.3).
    MixedVoronoi,
}

/// Weights of the cotangent Laplacian: Σ_j w_ij (u_j − u_i) ≈ A_i Δu at vertex i, with w_ij = ½ (cot α + cot
/// β), α and β the angles opposite the edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Cotangents {
    /// Edges, the lower vertex first, ascending.
    pub edges: Vec<[u32; 2]>,
    /// One weight per edge.
    pub weights: Vec<f64>,
}

impl Surface {
    /// Returns the vertices as points of a body, with areas (m²) in place of volumes; densities are then per
    /// area.
    ///
    /// # Errors
    /// An area is not positive, or the number of areas is not the number of vertices.
    pub fn points(&self, areas: Vec<f64>) -> Result<PointCloud> {
        let spacing = (self.area() / self.len() as f64).sqrt();
        PointCloud::of_areas(self.positions(), areas, spacing, self.user_numbers())
    }

    /// Total area of the triangles, m².
    pub fn area(&self) -> f64 {
        self.triangle_areas().sum()
    }

    /// Areas of the triangles, m².
    pub fn triangle_areas(&self) -> impl Iterator<Item = f64> + '_ {
        self.triangles
            .iter()
            .map(|&triangle| 0.5 * norm(normal(self.corners(triangle))))
    }

    /// Enclosed volume ⅙ Σ a · (b × c), m³: positive if the triangles run counter-clockwise seen from outside.
    pub fn volume(&self) -> f64 {
        let sixfold: f64 = self
            .triangles
            .iter()
            .map(|&triangle| {
                let [a, b, c] = self.corners(triangle);
                dot(a, cross(b, c))
            })
            .sum();
        sixfold / 6.0
    }

    /// Area associated with each vertex, m²; their sum is the area of the surface.
    pub fn vertex_areas(&self, rule: AreaRule) -> Vec<f64> {
        let mut areas = vec![0.0; self.len()];
        for &triangle in &self.triangles {
            let corners = self.corners(triangle);
            let shares = match rule {
                AreaRule::Barycentric => [norm(normal(corners)) / 6.0; 3],
                AreaRule::MixedVoronoi => voronoi_shares(corners),
            };
            for (vertex, share) in triangle.into_iter().zip(shares) {
                areas[vertex as usize] += share;
            }
        }
        areas
    }

    /// Edges, the lower vertex first, ascending.
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let mut edges: Vec<[u32; 2]> = self
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Straight distance of two vertices, m.
    pub fn chord(&self, a: usize, b: usize) -> f64 {
        norm(minus(self.positions[a], self.positions[b]))
    }

    /// Median edge length, m.
    pub fn median_edge(&self) -> f64 {
        let mut lengths: Vec<f64> = self
            .edges()
            .iter()
            .map(|&[a, b]| self.chord(a as usize, b as usize))
            .collect();
        let middle = lengths.len() / 2;
        *lengths.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// Weights of the cotangent Laplacian.
    pub fn cotangents(&self) -> Cotangents {
        let mut halves: Vec<([u32; 2], f64)> = Vec::with_capacity(3 * self.triangles.len());
        for &triangle in &self.triangles {
            let cotangents = corner_cotangents(self.corners(triangle));
            for k in 0..3 {
                let [a, b] = [triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
                halves.push(([a.min(b), a.max(b)], 0.5 * cotangents[k]));
            }
        }
        // A stable sort: the two halves of an edge are added in the order of their triangles.
        halves.sort_by_key(|&(edge, _)| edge);
        let (mut edges, mut weights) = (Vec::new(), Vec::new());
        for group in halves.chunk_by(|a, b| a.0 == b.0) {
            edges.push(group[0].0);
            weights.push(group.iter().map(|(_, weight)| weight).sum());
        }
        Cotangents { edges, weights }
    }

    /// Smallest and largest angle of the triangles, rad.
    pub fn angle_range(&self) -> [f64; 2] {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for &triangle in &self.triangles {
            for angle in corner_angles(self.corners(triangle)) {
                range = [range[0].min(angle), range[1].max(angle)];
            }
        }
        range
    }

    /// Angles of a triangle, rad, in the order of its corners.
    pub fn corner_angles(&self, triangle: [u32; 3]) -> [f64; 3] {
        corner_angles(self.corners(triangle))
    }

    /// Total angle of the triangles at each vertex, rad: below 2π at convex vertices, above at saddles.
    pub fn total_angles(&self) -> Vec<f64> {
        let mut totals = vec![0.0; self.len()];
        for &triangle in &self.triangles {
            let angles = corner_angles(self.corners(triangle));
            for (vertex, angle) in triangle.into_iter().zip(angles) {
                totals[vertex as usize] += angle;
            }
        }
        totals
    }

    /// Lengths of the half-edges, m.
    pub fn half_edge_lengths(&self, half_edges: &HalfEdges) -> Vec<f64> {
        (0..half_edges.len() as u32)
            .map(|h| {
                let (a, b) = (half_edges.origin(h), half_edges.target(h));
                // The lower vertex comes first, so that both directions give the same bits.
                self.chord(a.min(b) as usize, a.max(b) as usize)
            })
            .collect()
    }
}

fn corner_angles(corners: [Point; 3]) -> [f64; 3] {
    let twice_area = norm(normal(corners));
    std::array::from_fn(|k| {
        let to = |m: usize| minus(corners[(k + m) % 3], corners[k]);
        twice_area.atan2(dot(to(1), to(2)))
    })
}

fn corner_cotangents(corners: [Point; 3]) -> [f64; 3] {
    let twice_area = norm(normal(corners));
    std::array::from_fn(|k| {
        let to = |m: usize| minus(corners[(k + m) % 3], corners[k]);
        dot(to(1), to(2)) / twice_area
    })
}

fn voronoi_shares(corners: [Point; 3]) -> [f64; 3] {
    let area = 0.5 * norm(normal(corners));
    let cotangents = corner_cotangents(corners);
    if let Some(obtuse) = cotangents.iter().position(|&cotangent| cotangent < 0.0) {
        return std::array::from_fn(|k| if k == obtuse { 0.5 * area } else { 0.25 * area });
    }
    let square = |a: usize, b: usize| {
        let side = minus(corners[a], corners[b]);
        dot(side, side)
    };
    std::array::from_fn(|k| {
        let (next, last) = ((k + 1) % 3, (k + 2) % 3);
        (square(k, next) * cotangents[last] + square(k, last) * cotangents[next]) / 8.0
    })
}
