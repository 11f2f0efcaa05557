//! Rasterisation of filled cells: at every pixel the cell with the smallest key is visible. The key is the
//! distance from the cell centre in the plane and the depth in space, so that neighbours share a clean border
//! and the order of points does not matter.
//!
//! Among faces of equal depth the one with the smaller number is visible, so that the drawing order does not
//! matter. Large hidden faces are skipped by the largest key of every tile of pixels: a rod seen end on has
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
    /// Number of the face that has the key.
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

/// A parallelogram in space: centre and two half edges; (x, y) in pixels, then the distance from the viewer.
#[derive(Debug, Clone, Copy)]
pub(super) struct Face {
    pub(super) middle: [f64; 3],
    pub(super) a: [f64; 3],
    pub(super) b: [f64; 3],
    /// Depth of the border around the face behind the face itself: large enough for every neighbour to cover it.
    pub(super) seam: f64,
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

    fn put(&mut self, i: usize, j: usize, key: f32, colour: Rgb) {
        self.put_of(i, j, key, u32::MAX, colour);
    }

    fn put_of(&mut self, i: usize, j: usize, key: f32, number: u32, colour: Rgb) {
        let at = j * self.width + i;
        if key < self.key[at] || key == self.key[at] && number < self.owner[at] {
            self.key[at] = key;
            self.owner[at] = number;
            self.colour[at] = colour;
            self.tiles[j / TILE * self.width.div_ceil(TILE) + i / TILE] = None;
        }
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
                self.put(i, j, u.max(v) as f32, colour);
            }
        }
    }

    /// Draws a face seen from any direction, with a border of half a pixel that closes gaps between neighbours.
    pub(super) fn face(&mut self, face: &Face, number: u32, colour: Rgb) {
        let fine = self.fine as f64;
        let [x, y, depth] = [face.middle[0] * fine, face.middle[1] * fine, face.middle[2]];
        let [ax, ay] = [face.a[0] * fine, face.a[1] * fine];
        let [bx, by] = [face.b[0] * fine, face.b[1] * fine];
        let det = ax * by - ay * bx;
        let (length_a, length_b) = (ax.hypot(ay), bx.hypot(by));
        // seen edge-on: no visible area
        if det.abs() <= 1e-9 * length_a * length_b || det == 0.0 {
            return;
        }
        // Half a pixel, measured along each edge.
        let slack = |length: f64| 1.0 + 0.5 * length / det.abs();
        let (most_s, most_t) = (slack(length_b), slack(length_a));
        let reach = |a: f64, b: f64| most_s * a.abs() + most_t * b.abs();
        let columns = Self::range(x - reach(ax, bx), x + reach(ax, bx), self.width);
        let rows = Self::range(y - reach(ay, by), y + reach(ay, by), self.height);
        let nearest = depth - most_s * face.a[2].abs() - most_t * face.b[2].abs();
        if self.hides(&columns, &rows, nearest as f32) {
            return;
        }
        #[cfg(test)]
        {
            self.visited += columns.len() * rows.len();
        }
        for j in rows {
            let v = j as f64 + 0.5 - y;
            for i in columns.clone() {
                let u = i as f64 + 0.5 - x;
                let s = (u * by - v * bx) / det;
                let t = (ax * v - ay * u) / det;
                if s.abs() <= most_s && t.abs() <= most_t {
                    let seam = if s.abs() > 1.0 || t.abs() > 1.0 {
                        face.seam
                    } else {
                        0.0
                    };
                    let key = depth + s * face.a[2] + t * face.b[2] + seam;
                    self.put_of(i, j, key as f32, number, colour);
                }
            }
        }
    }

    /// Draws a triangle in space, (x, y) in pixels and the distance from the viewer; `colour` takes the
    /// barycentric coordinates. A border of half a pixel closes gaps between neighbours.
    pub(super) fn triangle(&mut self, corners: [[f64; 3]; 3], colour: impl Fn([f64; 3]) -> Rgb) {
        let fine = self.fine as f64;
        let [a, b, c] = corners.map(|[x, y, depth]| [x * fine, y * fine, depth]);
        let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        // seen edge-on: no visible area
        if doubled.abs() < 1e-9 {
            return;
        }
        let edge = |p: [f64; 3], q: [f64; 3]| (q[0] - p[0]).hypot(q[1] - p[1]);
        // Half a pixel relative to the height above each corner's opposite edge.
        let slack = [edge(b, c), edge(c, a), edge(a, b)].map(|edge| 0.5 * edge / doubled.abs());
        let bounds = |k: usize| {
            let values = [a[k], b[k], c[k]];
            let low = values.into_iter().fold(f64::INFINITY, f64::min);
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            (low - 1.0, high + 1.0)
        };
        let (left, right) = bounds(0);
        let (top, bottom) = bounds(1);
        let columns = Self::range(left, right, self.width);
        for j in Self::range(top, bottom, self.height) {
            let y = j as f64 + 0.5;
            for i in columns.clone() {
                let x = i as f64 + 0.5;
                let area = |p: [f64; 3], q: [f64; 3]| {
                    ((p[0] - x) * (q[1] - y) - (q[0] - x) * (p[1] - y)) / doubled
                };
                let shares = [area(b, c), area(c, a), area(a, b)];
                if (0..3).all(|k| shares[k] >= -slack[k]) {
                    let depth = shares[0] * a[2] + shares[1] * b[2] + shares[2] * c[2];
                    let key = depth as f32;
                    // Colours take longer than what hides most of them.
                    if key < self.key[j * self.width + i] {
                        self.put(i, j, key, colour(shares));
                    }
                }
            }
        }
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

    #[test]
    fn the_nearer_face_hides_the_other_in_any_order() {
        let face = |depth: f64| Face {
            middle: [20.0, 20.0, depth],
            a: [8.0, 3.0, 0.0],
            b: [-2.0, 9.0, 0.0],
            seam: 0.1,
        };
        for flip in [false, true] {
            let mut raster = Raster::new(40, 40, 2);
            let mut order = [(1.0, RED), (2.0, BLUE)];
            if flip {
                order.reverse();
            }
            for (depth, colour) in order {
                raster.face(&face(depth), 0, colour);
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
                let face = Face {
                    middle: [
                        40.0 * f64::from(cell % 10) + 20.0,
                        40.0 * f64::from(cell / 10) + 20.0,
                        depth,
                    ],
                    a: [20.0, 0.5, 0.1],
                    b: [-0.5, 20.0, -0.2],
                    seam: 0.3,
                };
                raster.face(&face, 100 * layer + cell, [cell as u8, layer as u8, 0]);
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
        let flat = Face {
            middle: [20.0, 20.0, 0.0],
            a: [10.0, 0.0, 0.0],
            b: [0.0, 10.0, 0.0],
            seam: 0.1,
        };
        let tilted = Face {
            a: [10.0, 0.0, 1.0],
            ..flat
        };
        raster.face(&flat, 0, RED);
        raster.face(&tilted, 1, BLUE);
        let bitmap = bitmap_of(&raster);
        assert_eq!(bitmap.pixel(12, 20), BLUE);
        assert_eq!(bitmap.pixel(28, 20), RED);
    }
}
