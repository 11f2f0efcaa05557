//! Plane lattices inside polygons.

use rayon::prelude::*;
use robust::orient2d;

use super::FillError;
use super::lattice::{Filled, Lattice};
use super::partial::{PartialCells, gathered};
use super::rows::{coord, sign};

/// Closed polygons in the plane, with either orientation. A point is inside if an odd number of polygons
/// surrounds it, so that polygons inside others are holes.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    polygons: Vec<Vec<[f64; 2]>>,
}

/// Returns twice the signed area of a polygon, with positions relative to its first corner.
fn twice_area(polygon: &[[f64; 2]]) -> f64 {
    let [x, y] = polygon[0];
    let pairs = polygon.windows(2);
    pairs
        .map(|pair| {
            let [a, b] = [pair[0], pair[1]].map(|p| [p[0] - x, p[1] - y]);
            a[0] * b[1] - a[1] * b[0]
        })
        .sum()
}

fn edges(polygon: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().copied().zip(next.copied())
}

/// Returns whether the line at x + ε crosses an edge.
fn crosses(a: [f64; 2], b: [f64; 2], x: f64) -> bool {
    (a[0] <= x) != (b[0] <= x)
}

/// Returns whether the point (x + ε, y + ε²) is above an edge that the line at x + ε crosses.
fn is_above(a: [f64; 2], b: [f64; 2], [x, y]: [f64; 2]) -> bool {
    let (left, right) = if a[0] <= b[0] { (a, b) } else { (b, a) };
    let ends = (coord(left[0], left[1]), coord(right[0], right[1]));
    match sign(orient2d(ends.0, ends.1, coord(x, y))) {
        // The sign of −(b_y − a_y) ε + (b_x − a_x) ε².
        0 => right[1] <= left[1],
        exact => exact > 0,
    }
}

/// Returns the mean of a height that varies linearly from `low` to `high`, clipped to [0, 1].
fn mean_height([low, high]: [f64; 2]) -> f64 {
    let share_below = |y: f64| match high > low {
        true => ((y - low) / (high - low)).clamp(0.0, 1.0),
        false if low < y => 1.0,
        false => 0.0,
    };
    let (from, to) = (share_below(0.0), share_below(1.0));
    let middle = low + 0.5 * (from + to) * (high - low);
    (to - from) * middle.clamp(0.0, 1.0) + (1.0 - to)
}

impl Outline {
    /// Creates an outline of polygons; the last corner of each is connected with its first.
    ///
    /// # Errors
    /// Returns an error for no polygons, a polygon with fewer than three corners, or a coordinate that is not
    /// finite.
    pub fn new(polygons: Vec<Vec<[f64; 2]>>) -> Result<Self, FillError> {
        if polygons.is_empty() {
            return Err(FillError::FewCorners {
                polygon: 0,
                corners: 0,
            });
        }
        for (polygon, corners) in polygons.iter().enumerate() {
            if corners.len() < 3 {
                let corners = corners.len();
                return Err(FillError::FewCorners { polygon, corners });
            }
            for (vertex, x) in corners.iter().enumerate() {
                if let Some(&value) = x.iter().find(|x| !x.is_finite()) {
                    return Err(FillError::NotFinite { vertex, value });
                }
            }
        }
        Ok(Self { polygons })
    }

    /// Returns whether a point, standing for (x + ε, y + ε²), is inside.
    pub fn contains(&self, point: [f64; 2]) -> bool {
        let edges = self.polygons.iter().flat_map(|polygon| edges(polygon));
        let above = edges.filter(|&(a, b)| crosses(a, b, point[0]) && !is_above(a, b, point));
        above.count() % 2 == 1
    }

    /// Returns the enclosed area of polygons that do not cross each other, without holes.
    pub fn area(&self) -> f64 {
        let area = |number: usize| {
            let polygon = &self.polygons[number];
            0.5 * self.sense(number) * twice_area(polygon).abs()
        };
        (0..self.polygons.len()).map(area).sum()
    }

    /// Returns 1 for a polygon around material, −1 for a hole: a polygon surrounded by an odd number of others.
    fn sense(&self, number: usize) -> f64 {
        let first = self.polygons[number][0];
        let others = self.polygons.iter().enumerate();
        let around = others.filter(|&(other, corners)| {
            let single = || edges(corners);
            let above =
                single().filter(|&(a, b)| crosses(a, b, first[0]) && !is_above(a, b, first));
            other != number && above.count() % 2 == 1
        });
        if around.count() % 2 == 0 { 1.0 } else { -1.0 }
    }

    /// Finds the cells of a lattice that are at least partly inside, with exact area fractions up to
    /// rounding: the area of the polygons clipped to the cell, for polygons that do not cross each other. A
    /// cell with a fraction below 0.1 distributes its area equally among its nearest neighbours above 0.1.
    ///
    /// # Errors
    /// As [`Outline::fill`].
    pub fn fill_partially(&self, spacing: [f64; 2]) -> Result<PartialCells, FillError> {
        let lattice = Lattice::around(self.bounds(), [spacing[0], spacing[1], 1.0])?;
        let senses: Vec<f64> = (0..self.polygons.len())
            .map(|number| self.sense(number) * -twice_area(&self.polygons[number]).signum())
            .collect();
        let [nx, ny, _] = lattice.counts;
        let columns: Vec<Vec<f64>> = (0..nx)
            .into_par_iter()
            .map(|column| self.parts_of_column(&lattice, column, &senses))
            .collect();
        let parts: Vec<f64> = (0..nx * ny)
            .map(|node| columns[node % nx][node / nx])
            .collect();
        Ok(gathered(lattice, &parts))
    }

    /// Returns the area fractions of the cells of a column: Σ ± ∫ (height of the edge within the cell) dx
    /// over the edges, divided by the area of a cell. `senses` are the signs of edges in the direction of
    /// increasing x.
    fn parts_of_column(&self, lattice: &Lattice, column: usize, senses: &[f64]) -> Vec<f64> {
        /// Fractions below this are rounding errors.
        const ROUNDING: f64 = 1e-12;
        let [dx, dy, _] = lattice.spacing;
        let ny = lattice.counts[1];
        let centre = lattice.coordinate(0, column);
        let sides = [centre - 0.5 * dx, centre + 0.5 * dx];
        let mut parts = vec![0.0; ny];
        // Contributions below row k are added to all rows below it at the end.
        let mut below = vec![0.0; ny + 1];
        for (polygon, sense) in self.polygons.iter().zip(senses) {
            for (a, b) in edges(polygon) {
                let (left, right, sign) = match a[0] <= b[0] {
                    true => (a, b, *sense),
                    false => (b, a, -sense),
                };
                let (from, to) = (left[0].max(sides[0]), right[0].min(sides[1]));
                // Also skips edges along y.
                if from >= to {
                    continue;
                }
                let height = |x: f64| {
                    let part = (x - left[0]) / (right[0] - left[0]);
                    left[1] + part * (right[1] - left[1])
                };
                let heights = [height(from), height(to)];
                let (low, high) = (heights[0].min(heights[1]), heights[0].max(heights[1]));
                let width = sign * (to - from) / dx;
                let rows = lattice.range(1, low, high);
                below[rows.start] += width;
                for row in rows {
                    let bottom = lattice.coordinate(1, row) - 0.5 * dy;
                    parts[row] += width * mean_height([low, high].map(|y| (y - bottom) / dy));
                }
            }
        }
        let mut whole = 0.0;
        for (part, below) in parts.iter_mut().zip(&below[1..]).rev() {
            whole += below;
            let sum: f64 = *part + whole;
            *part = match sum {
                sum if sum < ROUNDING => 0.0,
                sum if sum > 1.0 - ROUNDING => 1.0,
                sum => sum,
            };
        }
        parts
    }

    /// Returns the corners of the bounding box of all polygons, at z = 0.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for corner in self.polygons.iter().flatten() {
            for (c, &x) in corner.iter().enumerate() {
                bounds[0][c] = bounds[0][c].min(x);
                bounds[1][c] = bounds[1][c].max(x);
            }
        }
        (bounds[0][2], bounds[1][2]) = (0.0, 0.0);
        bounds
    }

    /// Finds the nodes of a lattice inside, with one node along z, at z = 0.
    ///
    /// # Errors
    /// Returns an error for a spacing that is not positive and for too many nodes.
    pub fn fill(&self, spacing: [f64; 2]) -> Result<Filled, FillError> {
        let lattice = Lattice::around(self.bounds(), [spacing[0], spacing[1], 1.0])?;
        Ok(self.fill_nodes(lattice))
    }

    /// Like [`Outline::fill`] with a given lattice, which need not cover the outline.
    pub fn fill_nodes(&self, lattice: Lattice) -> Filled {
        let [nx, ny, _] = lattice.counts;
        let columns: Vec<Vec<bool>> = (0..nx)
            .into_par_iter()
            .map(|column| self.column(&lattice, column))
            .collect();
        let inside = (0..nx * ny).map(|node| columns[node % nx][node / nx]);
        Filled {
            lattice,
            inside: inside.collect(),
            enclosed: self.area(),
            was_turned: false,
        }
    }

    /// Returns which nodes of a line along y are inside.
    fn column(&self, lattice: &Lattice, column: usize) -> Vec<bool> {
        let x = lattice.coordinate(0, column);
        let ny = lattice.counts[1];
        let mut odd = vec![false; ny + 1];
        for (a, b) in self.polygons.iter().flat_map(|polygon| edges(polygon)) {
            if !crosses(a, b, x) {
                continue;
            }
            let y = a[1] + (b[1] - a[1]) * ((x - a[0]) / (b[0] - a[0]));
            let guess = (y - lattice.coordinate(1, 0)) / lattice.spacing[1];
            let mut node = (guess.ceil().max(0.0) as usize).min(ny);
            let above = |node: usize| is_above(a, b, [x, lattice.coordinate(1, node)]);
            while node < ny && !above(node) {
                node += 1;
            }
            while node > 0 && above(node - 1) {
                node -= 1;
            }
            odd[node] ^= true;
        }
        let mut is_inside = odd[ny];
        let mut inside = vec![false; ny];
        for (inside, odd) in inside.iter_mut().zip(&odd[..ny]).rev() {
            *inside = is_inside;
            is_inside ^= odd;
        }
        inside
    }
}
