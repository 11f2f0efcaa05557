//! Intersections of a surface with lines along z.
//!
//! A line stands for (x + ε, y + ε²) with infinitesimal ε, so that it meets no edge and no corner, and two
//! triangles with a common edge agree on which of them it crosses.

use robust::{Coord, orient2d};

use super::lattice::Lattice;
use super::surface::TriangleSurface;

/// The triangles that the lines of each row, which have equal y, may cross.
pub(super) struct Rows<'a> {
    pub(super) lattice: Lattice,
    pub(super) surface: &'a TriangleSurface,
    ends: Vec<usize>,
    triangles: Vec<u32>,
}

pub(super) fn coord(x: f64, y: f64) -> Coord<f64> {
    Coord { x, y }
}

/// Returns the sign of a number: −1, 0 or 1.
pub(super) fn sign(x: f64) -> i32 {
    i32::from(x > 0.0) - i32::from(x < 0.0)
}

/// Returns the minimum and maximum of three numbers.
fn extent(x: [f64; 3]) -> (f64, f64) {
    (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]))
}

impl<'a> Rows<'a> {
    pub(super) fn new(surface: &'a TriangleSurface, lattice: Lattice) -> Self {
        let rows_of = |triangle: usize| {
            let (low, high) = extent(surface.corners(triangle).map(|corner| corner[1]));
            lattice.range(1, low, high)
        };
        let mut ends = vec![0; lattice.counts[1] + 1];
        for triangle in 0..surface.len() {
            for row in rows_of(triangle) {
                ends[row + 1] += 1;
            }
        }
        for row in 1..ends.len() {
            ends[row] += ends[row - 1];
        }
        let mut next = ends.clone();
        let mut triangles = vec![0; ends[lattice.counts[1]]];
        for triangle in 0..surface.len() {
            for row in rows_of(triangle) {
                triangles[next[row]] = triangle as u32;
                next[row] += 1;
            }
        }
        Self {
            lattice,
            surface,
            ends,
            triangles,
        }
    }

    /// Calls `crossed(number of the line along x, corners, 1 or −1)` for every triangle crossed by a line of
    /// a row; 1 if the normal of the triangle points upwards.
    pub(super) fn crossings(
        &self,
        row: usize,
        mut crossed: impl FnMut(usize, &[[f64; 3]; 3], i32),
    ) {
        let y = self.lattice.coordinate(1, row);
        for &triangle in &self.triangles[self.ends[row]..self.ends[row + 1]] {
            let corners = self.surface.corners(triangle as usize);
            let (low, high) = extent(corners.map(|corner| corner[1]));
            if y < low || y > high {
                continue;
            }
            let (low, high) = extent(corners.map(|corner| corner[0]));
            for column in self.lattice.range(0, low, high) {
                let x = self.lattice.coordinate(0, column);
                if x < low || x > high {
                    continue;
                }
                if let Some(sign) = crosses(&corners, x, y) {
                    crossed(column, &corners, sign);
                }
            }
        }
    }
}

/// Returns whether the line at (x + ε, y + ε²) crosses a triangle: 1 if its normal points upwards, −1 if
/// downwards.
fn crosses(corners: &[[f64; 3]; 3], x: f64, y: f64) -> Option<i32> {
    let side = |k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let exact = sign(orient2d(coord(a[0], a[1]), coord(b[0], b[1]), coord(x, y)));
        // Zero: the sign of −(b_y − a_y) ε + (b_x − a_x) ε² decides. Zero again: the triangle is vertical.
        match (exact, sign(a[1] - b[1])) {
            (0, 0) => sign(b[0] - a[0]),
            (0, shifted) => shifted,
            (exact, _) => exact,
        }
    };
    let first = side(0);
    (first != 0 && side(1) == first && side(2) == first).then_some(first)
}
