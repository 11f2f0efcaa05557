//! A picture in memory: antialiased strokes and convex shapes, and the PNG file.

use std::io::{self, Write};
use std::path::Path;

use crate::{IoError, write_atomically};

pub(super) type Rgb = [u8; 3];

pub(super) const WHITE: Rgb = [255, 255, 255];
/// Text, axes and ticks.
pub(super) const INK: Rgb = [38, 38, 38];

/// The sizes that are drawn, in pixels; a raster of the largest still fits into memory.
pub(super) const SIZES: std::ops::RangeInclusive<u32> = 200..=16_000;

/// Pixels in rows from the top; the pixel (i, j) covers the square from (i, j) to (i + 1, j + 1).
#[derive(Debug, Clone)]
pub(super) struct Bitmap {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
}

impl Bitmap {
    pub(super) fn white(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            rgb: vec![255; 3 * width * height],
        }
    }

    #[cfg(test)]
    pub(super) fn width(&self) -> usize {
        self.width
    }

    #[cfg(test)]
    pub(super) fn height(&self) -> usize {
        self.height
    }

    #[cfg(test)]
    pub(super) fn pixel(&self, i: usize, j: usize) -> Rgb {
        let at = 3 * (j * self.width + i);
        [self.rgb[at], self.rgb[at + 1], self.rgb[at + 2]]
    }

    /// Lays a colour over a pixel; pixels outside are left out.
    pub(super) fn blend(&mut self, i: i64, j: i64, colour: Rgb, cover: f64) {
        let (Ok(i), Ok(j)) = (usize::try_from(i), usize::try_from(j)) else {
            return;
        };
        if i >= self.width || j >= self.height {
            return;
        }
        let at = 3 * (j * self.width + i);
        if cover >= 1.0 {
            self.rgb[at..at + 3].copy_from_slice(&colour);
            return;
        }
        let cover = cover.max(0.0);
        for (old, new) in self.rgb[at..at + 3].iter_mut().zip(colour) {
            let mixed = f64::from(*old) * (1.0 - cover) + f64::from(new) * cover;
            *old = mixed.round() as u8;
        }
    }

    pub(super) fn fill_rectangle(
        &mut self,
        from: (f64, f64),
        to: (f64, f64),
        colour: Rgb,
        cover: f64,
    ) {
        for j in from.1.round() as i64..to.1.round() as i64 {
            for i in from.0.round() as i64..to.0.round() as i64 {
                self.blend(i, j, colour, cover);
            }
        }
    }

    /// Strokes with round ends and joints. All are laid down in one go, so that where they overlap is not seen.
    pub(super) fn stroke(&mut self, lines: &[Vec<(f64, f64)>], width: f64, colour: Rgb) {
        let mut cover = vec![0_u8; self.width * self.height];
        for line in lines {
            if let [point] = line[..] {
                self.cover_segment(&mut cover, point, point, width);
            }
            for pair in line.windows(2) {
                self.cover_segment(&mut cover, pair[0], pair[1], width);
            }
        }
        for (at, &cover) in cover.iter().enumerate().filter(|(_, cover)| **cover > 0) {
            let (i, j) = (at % self.width, at / self.width);
            self.blend(i as i64, j as i64, colour, f64::from(cover) / 255.0);
        }
    }

    fn cover_segment(&self, cover: &mut [u8], a: (f64, f64), b: (f64, f64), width: f64) {
        let radius = width / 2.0;
        let reach = radius + 1.0;
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let length_squared = dx * dx + dy * dy;
        let rows = |y: f64| (y.max(0.0) as usize).min(self.height);
        let columns = |x: f64| (x.max(0.0) as usize).min(self.width);
        for j in rows(a.1.min(b.1) - reach)..rows(a.1.max(b.1) + reach + 1.0) {
            let y = j as f64 + 0.5;
            // The part of the segment that can reach this row
            let (mut s, mut e) = (0.0, 1.0);
            if dy != 0.0 {
                let (first, last) = ((y - reach - a.1) / dy, (y + reach - a.1) / dy);
                s = first.min(last).clamp(0.0, 1.0);
                e = first.max(last).clamp(0.0, 1.0);
            }
            let (x0, x1) = (a.0 + s * dx, a.0 + e * dx);
            for i in columns(x0.min(x1) - reach)..columns(x0.max(x1) + reach + 1.0) {
                let x = i as f64 + 0.5;
                let along = if length_squared > 0.0 {
                    (((x - a.0) * dx + (y - a.1) * dy) / length_squared).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let distance = (x - a.0 - along * dx).hypot(y - a.1 - along * dy);
                let amount = ((radius + 0.5 - distance).clamp(0.0, 1.0) * 255.0).round() as u8;
                let at = j * self.width + i;
                cover[at] = cover[at].max(amount);
            }
        }
    }

    pub(super) fn fill_disc(&mut self, (x, y): (f64, f64), radius: f64, colour: Rgb) {
        for j in (y - radius).floor() as i64 - 1..=(y + radius).ceil() as i64 {
            for i in (x - radius).floor() as i64 - 1..=(x + radius).ceil() as i64 {
                let distance = (i as f64 + 0.5 - x).hypot(j as f64 + 0.5 - y);
                self.blend(i, j, colour, radius + 0.5 - distance);
            }
        }
    }

    /// A convex polygon, its corners clockwise on the screen.
    pub(super) fn fill_convex(&mut self, corners: &[(f64, f64)], colour: Rgb) {
        let bound = |pick: fn(&(f64, f64)) -> f64| {
            corners
                .iter()
                .map(pick)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                    (low.min(v), high.max(v))
                })
        };
        let ((left, right), (top, bottom)) = (bound(|c| c.0), bound(|c| c.1));
        for j in top.floor() as i64 - 1..=bottom.ceil() as i64 {
            for i in left.floor() as i64 - 1..=right.ceil() as i64 {
                let (x, y) = (i as f64 + 0.5, j as f64 + 0.5);
                let outside = (0..corners.len()).map(|k| {
                    let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
                    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
                    (dy * (x - a.0) - dx * (y - a.1)) / dx.hypot(dy)
                });
                let distance = outside.fold(f64::NEG_INFINITY, f64::max);
                self.blend(i, j, colour, 0.5 - distance);
            }
        }
    }

    /// Writes the picture, whole or not at all.
    pub(super) fn write_png(&self, path: &Path) -> Result<(), IoError> {
        write_atomically(path, |out| self.encode(out))
    }

    /// Writes the picture as PNG.
    pub(super) fn encode(&self, out: impl Write) -> io::Result<()> {
        let mut encoder = png::Encoder::new(out, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(encoding)?;
        writer.write_image_data(&self.rgb).map_err(encoding)?;
        writer.finish().map_err(encoding)
    }
}

/// What the encoder failed of, as an error of files.
pub(super) fn encoding(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;
    use std::io::BufReader;

    #[test]
    fn a_picture_is_read_back_from_its_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut bitmap = Bitmap::white(31, 17);
        bitmap.fill_rectangle((3.0, 4.0), (7.0, 9.0), [200, 10, 30], 1.0);
        bitmap.write_png(&path).unwrap();
        let decoder = png::Decoder::new(BufReader::new(File::open(&path).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut rgb).unwrap();
        assert_eq!((info.width, info.height), (31, 17));
        assert_eq!(rgb, bitmap.rgb);
        assert_eq!(bitmap.pixel(3, 4), [200, 10, 30]);
        assert_eq!(bitmap.pixel(7, 4), WHITE);
    }

    #[test]
    fn a_stroke_covers_its_area_at_any_angle() {
        for angle in [0.0_f64, 0.3, 0.8, 1.2, std::f64::consts::FRAC_PI_2, 2.5] {
            let (dx, dy) = (60.0 * angle.cos(), 60.0 * angle.sin());
            let (a, b) = ((100.0 - dx, 100.0 - dy), (100.0 + dx, 100.0 + dy));
            let mut bitmap = Bitmap::white(200, 200);
            bitmap.stroke(&[vec![a, (100.0, 100.0), b]], 4.0, [0, 0, 0]);
            let dark: f64 = bitmap.rgb.iter().map(|&v| 1.0 - f64::from(v) / 255.0).sum();
            // a rectangle of 120 × 4 and two half discs of radius 2
            let area = 120.0 * 4.0 + std::f64::consts::PI * 4.0;
            assert!((dark / 3.0 - area).abs() < 0.02 * area, "{angle}: {dark}");
        }
    }

    #[test]
    fn a_polygon_covers_its_area_and_nothing_outside_the_picture_is_touched() {
        let mut bitmap = Bitmap::white(40, 40);
        bitmap.fill_convex(&[(10.0, 10.0), (30.0, 10.0), (20.0, 25.0)], [0, 0, 0]);
        let dark: f64 = bitmap.rgb.iter().map(|&v| 1.0 - f64::from(v) / 255.0).sum();
        assert!((dark / 3.0 - 150.0).abs() < 5.0, "{dark}");
        bitmap.fill_convex(
            &[(-50.0, -50.0), (90.0, -50.0), (90.0, 90.0), (-50.0, 90.0)],
            INK,
        );
        assert_eq!(bitmap.pixel(0, 39), INK);
        bitmap.stroke(&[vec![(-1e9, 5.0), (1e9, 5.0)]], 3.0, [255, 0, 0]);
        assert_eq!(bitmap.pixel(20, 5), [255, 0, 0]);
    }
}
