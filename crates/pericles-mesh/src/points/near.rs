//! Points near the faces of a set: layers thicker than one element, for constraints.

use rayon::prelude::*;

use super::MeshPoints;
use crate::element::dot;
use crate::raw::RawMesh;

type Point = [f64; 3];

/// Maximum number of cells along an axis of the grid of faces.
const MOST_CELLS: f64 = 128.0;

fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|c| a[c] - b[c])
}

/// Returns the squared distance of a point from a triangle, which may degenerate to a line or a point
/// (Ericson, Real-Time Collision Detection, 5.1.5).
fn square_distance(p: Point, [a, b, c]: [Point; 3]) -> f64 {
    let at = |s: f64, t: f64| -> Point {
        std::array::from_fn(|k| a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]))
    };
    let square_to = |x: Point| {
        let d = minus(p, x);
        dot(d, d)
    };
    let (ab, ac, ap) = (minus(b, a), minus(c, a), minus(p, a));
    let (bp, cp) = (minus(p, b), minus(p, c));
    let (d1, d2, d3, d4) = (dot(ab, ap), dot(ac, ap), dot(ab, bp), dot(ac, bp));
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    let part = |x: f64, y: f64| if x + y > 0.0 { x / (x + y) } else { 0.0 };
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if d1 <= 0.0 && d2 <= 0.0 {
        return square_to(a);
    }
    if d3 >= 0.0 && d4 <= d3 {
        return square_to(b);
    }
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return square_to(at(part(d1, -d3), 0.0));
    }
    if d6 >= 0.0 && d5 <= d6 {
        return square_to(c);
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return square_to(at(0.0, part(d2, -d6)));
    }
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let t = part(d4 - d3, d5 - d6);
        return square_to(at(1.0 - t, t));
    }
    let sum = va + vb + vc;
    square_to(at(vb / sum, vc / sum))
}

/// Triangles in the cells of a grid: each in all cells that its bounding box, enlarged by a distance, meets.
struct Grid {
    low: Point,
    side: f64,
    counts: [usize; 3],
    cells: Vec<Vec<u32>>,
}

impl Grid {
    fn new(triangles: &[[Point; 3]], distance: f64) -> Self {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for x in triangles.iter().flatten() {
            for c in 0..3 {
                bounds[0][c] = bounds[0][c].min(x[c] - distance);
                bounds[1][c] = bounds[1][c].max(x[c] + distance);
            }
        }
        let largest = (0..3)
            .map(|c| bounds[1][c] - bounds[0][c])
            .fold(0.0, f64::max);
        let side = (largest / MOST_CELLS).max(distance);
        let counts = std::array::from_fn(|c| ((bounds[1][c] - bounds[0][c]) / side) as usize + 1);
        let mut grid = Self {
            low: bounds[0],
            side,
            counts,
            cells: vec![Vec::new(); counts.iter().product()],
        };
        for (number, corners) in (0u32..).zip(triangles) {
            let ranges: [_; 3] = std::array::from_fn(|c| {
                let x = corners.map(|corner| corner[c]);
                let low = x[0].min(x[1]).min(x[2]) - distance;
                let high = x[0].max(x[1]).max(x[2]) + distance;
                grid.place(c, low)..=grid.place(c, high)
            });
            for k in ranges[2].clone() {
                for j in ranges[1].clone() {
                    for i in ranges[0].clone() {
                        grid.cells[(k * counts[1] + j) * counts[0] + i].push(number);
                    }
                }
            }
        }
        grid
    }

    fn place(&self, axis: usize, x: f64) -> usize {
        let place = ((x - self.low[axis]) / self.side).max(0.0) as usize;
        place.min(self.counts[axis] - 1)
    }

    /// Returns the triangles that may be near a point.
    fn near(&self, x: Point) -> &[u32] {
        let is_outside = |c: usize| {
            let high = self.low[c] + self.side * self.counts[c] as f64;
            x[c] < self.low[c] || x[c] > high
        };
        if (0..3).any(is_outside) {
            return &[];
        }
        let [i, j, k] = [0, 1, 2].map(|c| self.place(c, x[c]));
        &self.cells[(k * self.counts[1] + j) * self.counts[0] + i]
    }
}

impl MeshPoints {
    /// Returns the points within a distance (m) of the faces of a set, ascending; `None` if there is no face
    /// set of this name. A constrained layer should be as thick as the horizon, while the elements that own
    /// the faces form a single layer. `mesh` and `unit` must be those from which the points were created.
    pub fn near_faces(
        &self,
        mesh: &RawMesh,
        unit: f64,
        set: &str,
        distance: f64,
    ) -> Option<Vec<u32>> {
        let faces = &self.set(set).filter(|set| !set.faces.is_empty())?.faces;
        let at = |node: u32| mesh.nodes[node as usize].map(|x| x * unit);
        let mut triangles = Vec::new();
        for (_, corners) in faces.iter() {
            match *corners {
                [a, b] => triangles.push([at(a), at(b), at(b)]),
                [a, b, c] => triangles.push([at(a), at(b), at(c)]),
                [a, b, c, d] => {
                    triangles.push([at(a), at(b), at(c)]);
                    triangles.push([at(a), at(c), at(d)]);
                }
                _ => {}
            }
        }
        let grid = Grid::new(&triangles, distance.max(0.0));
        let is_near = |x: Point| {
            let near = grid.near(x).iter();
            let mut squares = near.map(|&t| square_distance(x, triangles[t as usize]));
            squares.any(|square| square <= distance * distance)
        };
        let near: Vec<bool> = self.positions.par_iter().map(|&x| is_near(x)).collect();
        let points = (0u32..).zip(near).filter(|(_, near)| *near);
        Some(points.map(|(point, _)| point).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_from_triangles_agree_with_a_dense_search() {
        let triangle = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.5], [0.5, 1.5, 0.0]];
        let [a, b, c] = triangle;
        for n in 0..300 {
            let x = |k: usize| ((n * 37 + k * 101) % 97) as f64 / 97.0 * 5.0 - 2.0;
            let p = [x(0), x(1), x(2)];
            let mut least = f64::INFINITY;
            let steps = 200;
            for i in 0..=steps {
                for j in 0..=steps - i {
                    let (s, t) = (i as f64 / steps as f64, j as f64 / steps as f64);
                    let q: Point =
                        std::array::from_fn(|k| a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]));
                    let d = minus(p, q);
                    least = least.min(dot(d, d));
                }
            }
            let (found, least) = (square_distance(p, triangle).sqrt(), least.sqrt());
            // The sampling points are 0.01 apart.
            assert!(
                found <= least + 1e-12 && least - found < 0.012,
                "{p:?}: {found} {least}"
            );
        }
        // A triangle degenerate to a line, and one degenerate to a point.
        assert_eq!(
            square_distance(
                [1.0, 2.0, 0.0],
                [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 0.0, 0.0]]
            ),
            4.0
        );
        assert_eq!(square_distance([3.0, 4.0, 0.0], [[0.0; 3]; 3]), 25.0);
    }
}
