//! Rasterisation of filled cells: at every pixel the cell with the smallest key is visible. The key is the
//! distance from the cell centre in the plane and the depth in space, so that neighbours share a clean border
//! and the order of points does not matter.
//!
//! Among triangles of equal depth the one with the smaller number is visible, so that the drawing order does not
//! matter. Large hidden triangles are skipped by the largest key of every tile of pixels: a rod seen end on has
//! as many layers as cells along it.

use std::ops::Range;

use super::bitmap::{Bitmap, Rgb, WHITE};

/// A raster of cells with several subpixels per pixel.
#[derive(Debug)]
pub(super) struct Raster {
    width: usize,
    height: usize,
    /// Subpixels per pixel and direction; their mean smooths the edges.
    fine: usize,
    key: Vec<f32>,
    /// Number of the patch that has the key.
    owner: Vec<u32>,
    colour: Vec<Rgb>,
    /// Largest key of each tile; `None` where pixels have changed since it was computed.
    tiles: Vec<Option<f32>>,
    /// Number of pixels visited.
    #[cfg(test)]
    visited: usize,
}

/// Side length of a tile in subpixels.
const TILE: usize = 16;

/// Place of a patch in the order of equal depths, and the border around it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rank {
    /// Among patches of equal depth the one with the smallest number is visible.
    pub(super) number: u32,
    /// Depth of the border around the patch behind the patch itself: large enough for every neighbour to cover it.
    /// `None` without a border.
    pub(super) seam: Option<f64>,
}

impl Raster {
    pub(super) fn new(width: usize, height: usize, fine: usize) -> Self {
        let (width, height) = (width * fine, height * fine);
        Self {
            width,
            height,
            fine,
            key: vec![f32::INFINITY; width * height],
            owner: vec![u32::MAX; width * height],
            tiles: vec![None; width.div_ceil(TILE) * height.div_ceil(TILE)],
            #[cfg(test)]
            visited: 0,
            colour: vec![WHITE; width * height],
        }
    }

    /// Returns the subpixels from `low` to `high` inside `size`.
    fn range(low: f64, high: f64, size: usize) -> Range<usize> {
        // from the first to the last pixel whose centre is inside; casting a negative number gives zero
        let first = (low - 0.5).ceil().max(0.0) as usize;
        let end = ((high - 0.5).floor() + 1.0).max(0.0) as usize;
        first..end.min(size)
    }

    /// Returns whether a patch is in front of what a pixel shows.
    fn shows(&self, i: usize, j: usize, key: f32, number: u32) -> bool {
        let at = j * self.width + i;
        key < self.key[at] || key == self.key[at] && number < self.owner[at]
    }

    fn put(&mut self, i: usize, j: usize, key: f32, number: u32, colour: Rgb) {
        let at = j * self.width + i;
        self.key[at] = key;
        self.owner[at] = number;
        self.colour[at] = colour;
        self.tiles[j / TILE * self.width.div_ceil(TILE) + i / TILE] = None;
    }

    /// Returns whether a rectangle of pixels is completely covered by nearer faces. Small rectangles are not
    /// tested, because drawing them is as cheap.
    fn hides(&mut self, columns: &Range<usize>, rows: &Range<usize>, key: f32) -> bool {
        if columns.len() * rows.len() < TILE * TILE {
            return false;
        }
        let across = self.width.div_ceil(TILE);
        for row in rows.start / TILE..rows.end.div_ceil(TILE) {
            for column in columns.start / TILE..columns.end.div_ceil(TILE) {
                let tile = row * across + column;
                let largest = match self.tiles[tile] {
                    Some(largest) => largest,
                    None => self.largest_key(column, row),
                };
                self.tiles[tile] = Some(largest);
                if largest >= key {
                    return false;
                }
            }
        }
        true
    }

    fn largest_key(&self, column: usize, row: usize) -> f32 {
        let columns = column * TILE..((column + 1) * TILE).min(self.width);
        let rows = row * TILE..((row + 1) * TILE).min(self.height);
        rows.flat_map(|j| &self.key[j * self.width + columns.start..j * self.width + columns.end])
            .fold(f32::NEG_INFINITY, |most, &key| most.max(key))
    }

    /// Draws a cell in the plane: centre and half edges in pixels. It is enlarged by a tenth and at least
    /// half a pixel, so that a stretched grid stays closed while an open crack remains visible.
    pub(super) fn cell(&mut self, middle: (f64, f64), half: (f64, f64), colour: Rgb) {
        let fine = self.fine as f64;
        let (x, y) = (middle.0 * fine, middle.1 * fine);
        let half = ((half.0 * fine).max(1e-3), (half.1 * fine).max(1e-3));
        let reach = |half: f64| (1.1 * half).max(half + 0.5);
        let columns = Self::range(x - reach(half.0), x + reach(half.0), self.width);
        for j in Self::range(y - reach(half.1), y + reach(half.1), self.height) {
            let v = (j as f64 + 0.5 - y).abs() / half.1;
            for i in columns.clone() {
                let u = (i as f64 + 0.5 - x).abs() / half.0;
                let key = u.max(v) as f32;
                if self.shows(i, j, key, u32::MAX) {
                    self.put(i, j, key, u32::MAX, colour);
                }
            }
        }
    }

    /// Draws a triangle: (x, y) in pixels and the distance from the viewer. `colour` takes the barycentric coordinates.
    /// A border of half a pixel closes gaps between neighbours.
    pub(super) fn triangle(
        &mut self,
        corners: [[f64; 3]; 3],
        rank: Rank,
        colour: impl Fn([f64; 3]) -> Rgb,
    ) {
        let fine = self.fine as f64;
        let [a, b, c] = corners.map(|[x, y, depth]| [x * fine, y * fine, depth]);
        let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        // seen edge-on: no visible area
        if doubled.abs() < 1e-9 {
            return;
        }
        let edge = |p: [f64; 3], q: [f64; 3]| (q[0] - p[0]).hypot(q[1] - p[1]);
        // Half a pixel relative to the height above each corner's opposite edge.
        let border = if rank.seam.is_some() { 0.5 } else { 0.0 };
        let slack = [edge(b, c), edge(c, a), edge(a, b)].map(|edge| border * edge / doubled.abs());
        let bounds = |k: usize| {
            let values = [a[k], b[k], c[k]];
            let low = values.into_iter().fold(f64::INFINITY, f64::min);
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            (low, high)
        };
        let ((left, right), (top, bottom), (near, far)) = (bounds(0), bounds(1), bounds(2));
        let columns = Self::range(left - 1.0, right + 1.0, self.width);
        let rows = Self::range(top - 1.0, bottom + 1.0, self.height);
        // The border continues the slope of the triangle.
        let nearest = near - (far - near) * slack.iter().sum::<f64>();
        if self.hides(&columns, &rows, nearest as f32) {
            return;
        }
        // Change of each share from one pixel to the next.
        let slopes = [(b, c), (c, a), (a, b)].map(|(p, q)| (p[1] - q[1]) / doubled);
        for j in rows {
            let y = j as f64 + 0.5;
            let at_zero = [(b, c), (c, a), (a, b)]
                .map(|(p, q)| (p[0] * (q[1] - y) - q[0] * (p[1] - y)) / doubled);
            let columns = inside(&columns, at_zero, slopes, slack);
            #[cfg(test)]
            {
                self.visited += columns.len();
            }
            for i in columns {
                let x = i as f64 + 0.5;
                let shares: [f64; 3] = std::array::from_fn(|k| at_zero[k] + slopes[k] * x);
                if (0..3).all(|k| shares[k] >= -slack[k]) {
                    let seam = match shares.iter().any(|share| *share < 0.0) {
                        true => rank.seam.unwrap_or(0.0),
                        false => 0.0,
                    };
                    let depth = shares[0] * a[2] + shares[1] * b[2] + shares[2] * c[2] + seam;
                    let key = depth as f32;
                    // Colours take longer than what hides most of them.
                    if self.shows(i, j, key, rank.number) {
                        self.put(i, j, key, rank.number, colour(shares));
                    }
                }
            }
        }
    }

    /// Returns whether a place, in pixels, is not hidden by what is nearer than its distance from the viewer by more than
    /// `slack`. One uncovered pixel next to it suffices, because lines run along the edges of what they lie on.
    pub(super) fn is_visible(&self, [x, y, depth]: [f64; 3], slack: f64) -> bool {
        let fine = self.fine as f64;
        let around = |at: f64, size: usize| Self::range(at * fine - 1.5, at * fine + 1.5, size);
        let (columns, rows) = (around(x, self.width), around(y, self.height));
        rows.into_iter().any(|j| {
            let row = &self.key[j * self.width..(j + 1) * self.width];
            row[columns.clone()]
                .iter()
                .any(|key| f64::from(*key) >= depth - slack)
        })
    }

    /// Returns width and height in whole pixels.
    pub(super) fn size(&self) -> (usize, usize) {
        (self.width / self.fine, self.height / self.fine)
    }

    /// Returns the raster as a picture of its own, on white or without a background.
    pub(super) fn bitmap(&self, is_transparent: bool) -> Bitmap {
        let (width, height) = self.size();
        let on = |colour| {
            let mut bitmap = Bitmap::filled(width, height, colour);
            self.lay_on(&mut bitmap, 0, 0);
            bitmap
        };
        match is_transparent {
            true => Bitmap::without_background(on(WHITE), &on([0; 3])),
            false => on(WHITE),
        }
    }

    /// Draws the raster on a bitmap with its corner at (left, top). Uncovered pixels are unchanged.
    pub(super) fn lay_on(&self, bitmap: &mut Bitmap, left: usize, top: usize) {
        let fine = self.fine;
        for j in 0..self.height / fine {
            for i in 0..self.width / fine {
                let (mut sum, mut count) = ([0_u32; 3], 0_u32);
                for row in j * fine..(j + 1) * fine {
                    for at in row * self.width + i * fine..row * self.width + (i + 1) * fine {
                        if self.key[at] < f32::INFINITY {
                            count += 1;
                            for (sum, &part) in sum.iter_mut().zip(&self.colour[at]) {
                                *sum += u32::from(part);
                            }
                        }
                    }
                }
                if count > 0 {
                    let mean = sum.map(|part| ((part + count / 2) / count) as u8);
                    let cover = f64::from(count) / (fine * fine) as f64;
                    bitmap.blend((left + i) as i64, (top + j) as i64, mean, cover);
                }
            }
        }
    }
}

/// Returns the columns in which all shares of a row may be at least −slack: one more on each side, for rounding. `at_zero` are
/// the shares at x = 0.
fn inside(
    columns: &Range<usize>,
    at_zero: [f64; 3],
    slopes: [f64; 3],
    slack: [f64; 3],
) -> Range<usize> {
    let (mut low, mut high) = (columns.start as f64, columns.end as f64);
    for k in 0..3 {
        // at_zero + slope x ≥ −slack
        let bound = (-slack[k] - at_zero[k]) / slopes[k];
        match slopes[k] {
            up if up > 0.0 => low = low.max(bound - 1.5),
            down if down < 0.0 => high = high.min(bound + 1.5),
            _ => {}
        }
    }
    // A bound that is not a number is no bound; casting a negative number gives zero.
    let (first, end) = (low.ceil() as usize, high.ceil().max(0.0) as usize);
    first.max(columns.start)..end.min(columns.end)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: Rgb = [255, 0, 0];
    const BLUE: Rgb = [0, 0, 255];

    fn bitmap_of(raster: &Raster) -> Bitmap {
        let fine = raster.fine;
        let mut bitmap = Bitmap::white(raster.width / fine, raster.height / fine);
        raster.lay_on(&mut bitmap, 0, 0);
        bitmap
    }

    #[test]
    fn a_stretched_grid_is_closed_and_a_crack_is_open() {
        let mut raster = Raster::new(200, 40, 2);
        for k in 0..10 {
            // 15 % stretched, with a gap of 6 pixels after the fifth cell
            let x = 10.0 + 11.5 * f64::from(k) + if k > 4 { 6.0 } else { 0.0 };
            raster.cell((x, 20.0), (5.0, 5.0), if k % 2 == 0 { RED } else { BLUE });
        }
        let bitmap = bitmap_of(&raster);
        let white: Vec<_> = (6..120)
            .filter(|&i| bitmap.pixel(i, 20) == [255; 3])
            .collect();
        assert!((5..=7).contains(&white.len()), "{white:?}");
        assert!(white.iter().all(|i| (60..72).contains(i)), "{white:?}");
    }

    #[test]
    fn cells_smaller_than_pixels_leave_no_holes() {
        let mut raster = Raster::new(50, 50, 2);
        for k in 0..40_000 {
            let (x, y) = (f64::from(k % 200) * 0.25, f64::from(k / 200) * 0.25);
            raster.cell((x + 0.125, y + 0.125), (0.125, 0.125), BLUE);
        }
        let bitmap = bitmap_of(&raster);
        assert!((0..2500).all(|k| bitmap.pixel(k % 50, k / 50) == BLUE));
    }

    /// Draws a parallelogram by its centre and two half edges.
    fn draw(raster: &mut Raster, middle: [f64; 3], [a, b]: [[f64; 3]; 2], rank: Rank, colour: Rgb) {
        let corner = |s: f64, t: f64| std::array::from_fn(|c| middle[c] + s * a[c] + t * b[c]);
        let [p, q, r, s] = [
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ];
        raster.triangle([p, q, r], rank, |_| colour);
        raster.triangle([p, r, s], rank, |_| colour);
    }

    fn rank(number: u32) -> Rank {
        Rank {
            number,
            seam: Some(0.1),
        }
    }

    #[test]
    fn the_nearer_face_hides_the_other_in_any_order() {
        let edges = [[8.0, 3.0, 0.0], [-2.0, 9.0, 0.0]];
        for flip in [false, true] {
            let mut raster = Raster::new(40, 40, 2);
            let mut order = [(1.0, RED), (2.0, BLUE)];
            if flip {
                order.reverse();
            }
            for (depth, colour) in order {
                draw(&mut raster, [20.0, 20.0, depth], edges, rank(0), colour);
            }
            let bitmap = bitmap_of(&raster);
            assert_eq!(bitmap.pixel(20, 20), RED);
            assert_eq!(bitmap.pixel(2, 2), [255; 3]);
        }
    }

    /// Layers of 10 × 10 square cells behind each other, slightly tilted, by their distance from the viewer.
    fn layers(order: impl Iterator<Item = u32>) -> Raster {
        let mut raster = Raster::new(400, 400, 2);
        for layer in order {
            let depth = f64::from(layer);
            for cell in 0..100_u32 {
                let middle = [
                    40.0 * f64::from(cell % 10) + 20.0,
                    40.0 * f64::from(cell / 10) + 20.0,
                    depth,
                ];
                let edges = [[20.0, 0.5, 0.1], [-0.5, 20.0, -0.2]];
                let rank = Rank {
                    number: 100 * layer + cell,
                    seam: Some(0.3),
                };
                draw(
                    &mut raster,
                    middle,
                    edges,
                    rank,
                    [cell as u8, layer as u8, 0],
                );
            }
        }
        raster
    }

    #[test]
    fn hidden_layers_are_not_visited_and_pictures_do_not_depend_on_the_order() {
        let one = layers(0..1).visited;
        let many = layers(0..50);
        // Gaps between the cells of the first layer show the second one.
        assert!(many.visited < 4 * one, "{} {one}", many.visited);
        let reversed = layers((0..50).rev());
        assert!(reversed.visited > 40 * one);
        assert_eq!(many.colour, reversed.colour);
        assert_eq!(many.key, reversed.key);
    }

    #[test]
    fn the_depth_of_a_tilted_face_varies_over_it() {
        let mut raster = Raster::new(40, 40, 1);
        let (middle, across) = ([20.0, 20.0, 0.0], [0.0, 10.0, 0.0]);
        draw(
            &mut raster,
            middle,
            [[10.0, 0.0, 0.0], across],
            rank(0),
            RED,
        );
        draw(
            &mut raster,
            middle,
            [[10.0, 0.0, 1.0], across],
            rank(1),
            BLUE,
        );
        let bitmap = bitmap_of(&raster);
        assert_eq!(bitmap.pixel(12, 20), BLUE);
        assert_eq!(bitmap.pixel(28, 20), RED);
    }

    #[test]
    fn a_place_is_hidden_by_what_is_nearer_only() {
        let mut raster = Raster::new(40, 40, 2);
        let edges = [[10.0, 0.0, 0.0], [0.0, 10.0, 0.0]];
        draw(&mut raster, [20.0, 20.0, 5.0], edges, rank(0), RED);
        assert!(raster.is_visible([20.0, 20.0, 5.2], 0.5));
        assert!(!raster.is_visible([20.0, 20.0, 6.0], 0.5));
        // Beside the face nothing is hidden.
        assert!(raster.is_visible([35.0, 20.0, 6.0], 0.5));
    }
}
