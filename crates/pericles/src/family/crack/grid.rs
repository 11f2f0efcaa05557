//! A grid of cells over triangles, so that a bond is tested against few of them.

use crate::space::Point;

/// The largest number of cells along an axis.
const MOST_CELLS: f64 = 64.0;

/// Triangles sorted into the cells that their bounding boxes meet.
#[derive(Debug, Clone)]
pub(super) struct FacetGrid {
    low: Point,
    high: Point,
    side: f64,
    counts: [usize; 3],
    cells: Vec<Vec<u32>>,
}

impl FacetGrid {
    /// Makes the grid of triangles whose bounding boxes are widened by a tolerance, m.
    pub(super) fn new(triangles: &[[Point; 3]], tolerance: f64) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        let mut extent = 0.0;
        for triangle in triangles {
            let bounds = bounds(triangle, tolerance);
            for c in 0..3 {
                low[c] = low[c].min(bounds[0][c]);
                high[c] = high[c].max(bounds[1][c]);
                extent += (bounds[1][c] - bounds[0][c]) / (3 * triangles.len()) as f64;
            }
        }
        let longest = (0..3).map(|c| high[c] - low[c]).fold(0.0, f64::max);
        // Positive, because every triangle has an area.
        let side = extent.max(longest / MOST_CELLS);
        let counts = std::array::from_fn(|c| ((high[c] - low[c]) / side).ceil().max(1.0) as usize);
        let mut grid = Self {
            low,
            high,
            side,
            counts,
            cells: vec![Vec::new(); counts.iter().product()],
        };
        for (number, triangle) in (0u32..).zip(triangles) {
            for cell in grid.cells_of(bounds(triangle, tolerance)) {
                grid.cells[cell].push(number);
            }
        }
        grid
    }

    /// Returns the triangles that the segment between two points may meet; some of them several times.
    pub(super) fn near(&self, p: Point, q: Point) -> impl Iterator<Item = u32> + '_ {
        let low: Point = std::array::from_fn(|c| p[c].min(q[c]));
        let high: Point = std::array::from_fn(|c| p[c].max(q[c]));
        let meets = (0..3).all(|c| low[c] <= self.high[c] && high[c] >= self.low[c]);
        let cells = meets.then(|| self.cells_of([low, high]));
        let cells = cells.into_iter().flatten();
        cells.flat_map(|cell| self.cells[cell].iter().copied())
    }

    /// Returns the cells that a box meets.
    fn cells_of(&self, [low, high]: [Point; 2]) -> impl Iterator<Item = usize> + use<> {
        let counts = self.counts;
        let place = |c: usize, x: f64| {
            // The casts clamp cells outside to the grid.
            (((x - self.low[c]) / self.side).max(0.0) as usize).min(counts[c] - 1)
        };
        let range = |c: usize| place(c, low[c])..=place(c, high[c]);
        let [along_x, along_y, along_z] = [range(0), range(1), range(2)];
        along_z.flat_map(move |k| {
            let along_x = along_x.clone();
            along_y.clone().flat_map(move |j| {
                let row = (k * counts[1] + j) * counts[0];
                along_x.clone().map(move |i| row + i)
            })
        })
    }
}

fn bounds(triangle: &[Point; 3], tolerance: f64) -> [Point; 2] {
    let along = |c: usize| triangle.iter().map(move |corner| corner[c]);
    [
        std::array::from_fn(|c| along(c).fold(f64::INFINITY, f64::min) - tolerance),
        std::array::from_fn(|c| along(c).fold(f64::NEG_INFINITY, f64::max) + tolerance),
    ]
}
