//! Bitmap with antialiased strokes and areas (`tiny-skia`), and PNG output.

use std::io::{self, Write};
use std::path::Path;

use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, PathBuilder, PixmapMut, Rect, Stroke, StrokeDash, Transform,
};

use crate::{IoError, write_atomically};

pub(super) type Rgb = [u8; 3];

pub(super) const WHITE: Rgb = [255, 255, 255];
/// Colour of text, axes and ticks.
pub(super) const INK: Rgb = [38, 38, 38];

/// Allowed sizes in pixels; a raster of the largest size fits into memory.
pub(super) const SIZES: std::ops::RangeInclusive<u32> = 200..=16_000;

/// Compression of PNG files: a tenth larger than at the usual level 6, and five times as fast.
pub(super) const COMPRESSION: png::DeflateCompression = png::DeflateCompression::Level(3);

/// Number of segments rasterised together. The time grows quadratically with the number of segments that
/// cross the same rows.
const TOGETHER: usize = 500;

/// Style of lines.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pen {
    pub(super) width: f64,
    pub(super) colour: Rgb,
    /// Lengths of dashes and gaps; the round caps take part of the gaps.
    pub(super) dash: Option<[f64; 2]>,
}

/// Pixels in rows from the top; pixel (i, j) covers the square from (i, j) to (i + 1, j + 1).
#[derive(Debug, Clone)]
pub(super) struct Bitmap {
    width: usize,
    height: usize,
    /// Red, green, blue, and opacity: 255 while shapes are drawn.
    rgba: Vec<u8>,
    is_transparent: bool,
    /// Pixels per inch, if the picture has a size on paper.
    dpi: Option<f64>,
}

impl Bitmap {
    #[cfg(test)]
    pub(super) fn white(width: usize, height: usize) -> Self {
        Self::filled(width, height, WHITE)
    }

    pub(super) fn filled(width: usize, height: usize, [r, g, b]: Rgb) -> Self {
        Self {
            width,
            height,
            rgba: [r, g, b, 255].repeat(width * height),
            is_transparent: false,
            dpi: None,
        }
    }

    /// Sets the resolution in pixels per inch, which is written to the file.
    pub(super) fn with_dpi(self, dpi: Option<f64>) -> Self {
        Self { dpi, ..self }
    }

    /// Returns the picture without its background, from the same picture on white and on black: a shape of opacity a is
    /// 1 − a brighter on white.
    pub(super) fn without_background(on_white: Self, on_black: &Self) -> Self {
        let mut picture = on_white;
        let pairs = picture.rgba.chunks_exact_mut(4);
        for (light, dark) in pairs.zip(on_black.rgba.chunks_exact(4)) {
            let through = (0..3).map(|c| light[c].saturating_sub(dark[c])).max();
            let opacity = 255 - through.unwrap_or_default();
            for c in 0..3 {
                light[c] = match opacity {
                    0 => 0,
                    _ => rounded((255.0 * f64::from(dark[c]) / f64::from(opacity)).min(255.0)),
                };
            }
            light[3] = opacity;
        }
        picture.is_transparent = true;
        picture
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
        let at = 4 * (j * self.width + i);
        [self.rgba[at], self.rgba[at + 1], self.rgba[at + 2]]
    }

    /// Returns the opacities of the pixels.
    pub(super) fn alpha(&self) -> Vec<u8> {
        let pixels = self.rgba.chunks_exact(4);
        pixels.map(|pixel| pixel[3]).collect()
    }

    pub(super) fn rgb(&self) -> Vec<u8> {
        let pixels = self.rgba.chunks_exact(4);
        pixels.flat_map(|pixel| &pixel[..3]).copied().collect()
    }

    /// Blends a colour over a pixel; pixels outside are ignored.
    pub(super) fn blend(&mut self, i: i64, j: i64, colour: Rgb, cover: f64) {
        let (Ok(i), Ok(j)) = (usize::try_from(i), usize::try_from(j)) else {
            return;
        };
        if i >= self.width || j >= self.height {
            return;
        }
        let at = 4 * (j * self.width + i);
        if cover >= 1.0 {
            self.rgba[at..at + 3].copy_from_slice(&colour);
            return;
        }
        let cover = cover.max(0.0);
        for (old, new) in self.rgba[at..at + 3].iter_mut().zip(colour) {
            let mixed = f64::from(*old) * (1.0 - cover) + f64::from(new) * cover;
            *old = rounded(mixed);
        }
    }

    /// Returns the pixmap that `tiny-skia` draws on; `None` if it has no pixels.
    fn page(&mut self) -> Option<PixmapMut<'_>> {
        PixmapMut::from_bytes(&mut self.rgba, self.width as u32, self.height as u32)
    }

    /// Fills a rectangle with its sides rounded to whole pixels.
    pub(super) fn fill_rectangle(
        &mut self,
        from: (f64, f64),
        to: (f64, f64),
        colour: Rgb,
        cover: f64,
    ) {
        let [left, top, right, bottom] = [from.0, from.1, to.0, to.1].map(|x| x.round() as f32);
        let rectangle = Rect::from_ltrb(left, top, right, bottom);
        if let (Some(rectangle), Some(mut page)) = (rectangle, self.page()) {
            page.fill_rect(
                rectangle,
                &paint(colour, cover),
                Transform::identity(),
                None,
            );
        }
    }

    /// Strokes lines with round caps and joins. A single point gives a dot.
    pub(super) fn stroke(&mut self, lines: &[Vec<(f64, f64)>], pen: Pen) {
        let dash = (pen.dash).map(|lengths| lengths.map(|length| length as f32).to_vec());
        let stroke = Stroke {
            width: pen.width as f32,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            dash: dash.and_then(|lengths| StrokeDash::new(lengths, 0.0)),
            ..Stroke::default()
        };
        // The dash pattern continues over the whole line.
        let together = pen.dash.map_or(TOGETHER, |_| usize::MAX);
        let Some(mut page) = self.page() else {
            return;
        };
        for line in lines {
            for first in (0..line.len().max(2) - 1).step_by(together) {
                let end = first.saturating_add(together).saturating_add(1);
                if let Some(path) = path(&line[first..end.min(line.len())]).finish() {
                    let paint = paint(pen.colour, 1.0);
                    page.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
                }
            }
        }
    }

    pub(super) fn fill_disc(&mut self, (x, y): (f64, f64), radius: f64, colour: Rgb) {
        let mut circle = PathBuilder::new();
        circle.push_circle(x as f32, y as f32, radius as f32);
        self.fill(circle, colour);
    }

    /// Fills a polygon.
    pub(super) fn fill_polygon(&mut self, corners: &[(f64, f64)], colour: Rgb) {
        self.fill(path(corners), colour);
    }

    fn fill(&mut self, path: PathBuilder, colour: Rgb) {
        if let (Some(path), Some(mut page)) = (path.finish(), self.page()) {
            let rule = FillRule::Winding;
            page.fill_path(
                &path,
                &paint(colour, 1.0),
                rule,
                Transform::identity(),
                None,
            );
        }
    }

    /// Writes the picture to a file atomically.
    pub(super) fn write_png(&self, path: &Path) -> Result<(), IoError> {
        write_atomically(path, |out| self.encode(out))
    }

    /// Encodes the picture as PNG.
    pub(super) fn encode(&self, out: impl Write) -> io::Result<()> {
        let mut encoder = png::Encoder::new(out, self.width as u32, self.height as u32);
        encoder.set_color(match self.is_transparent {
            true => png::ColorType::Rgba,
            false => png::ColorType::Rgb,
        });
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_deflate_compression(COMPRESSION);
        encoder.set_pixel_dims(self.dpi.map(|dpi| {
            let per_metre = (dpi / 25.4e-3).round() as u32;
            png::PixelDimensions {
                xppu: per_metre,
                yppu: per_metre,
                unit: png::Unit::Meter,
            }
        }));
        let mut writer = encoder.write_header().map_err(encoding)?;
        let written = match self.is_transparent {
            true => writer.write_image_data(&self.rgba),
            false => writer.write_image_data(&self.rgb()),
        };
        written.map_err(encoding)?;
        writer.finish().map_err(encoding)
    }
}

/// Returns the nearest whole number of a number that is not negative. `f64::round` is a call of a function on processors
/// for which the program is compiled.
#[inline]
pub(super) fn rounded(number: f64) -> u8 {
    (number + 0.5) as u8
}

/// Returns a path through points.
fn path(places: &[(f64, f64)]) -> PathBuilder {
    let mut path = PathBuilder::new();
    for (k, &(x, y)) in places.iter().enumerate() {
        if k == 0 {
            path.move_to(x as f32, y as f32);
        }
        // Includes the first point, so that a single point gives a dot.
        path.line_to(x as f32, y as f32);
    }
    path
}

fn paint([r, g, b]: Rgb, cover: f64) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, (255.0 * cover).round() as u8);
    paint
}

/// Converts an error of the PNG encoder.
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
        assert_eq!(rgb, bitmap.rgb());
        assert_eq!(bitmap.pixel(3, 4), [200, 10, 30]);
        assert_eq!(bitmap.pixel(7, 4), WHITE);
    }

    fn pen(width: f64, dash: Option<[f64; 2]>) -> Pen {
        let colour = [0, 0, 0];
        Pen {
            width,
            colour,
            dash,
        }
    }

    /// Black area in pixels.
    fn inked(bitmap: &Bitmap) -> f64 {
        let values = bitmap.rgb().into_iter();
        values.map(|v| 1.0 - f64::from(v) / 255.0).sum::<f64>() / 3.0
    }

    #[test]
    fn a_stroke_covers_its_area_at_any_angle() {
        for angle in [0.0_f64, 0.3, 0.8, 1.2, std::f64::consts::FRAC_PI_2, 2.5] {
            let (dx, dy) = (60.0 * angle.cos(), 60.0 * angle.sin());
            let (a, b) = ((100.0 - dx, 100.0 - dy), (100.0 + dx, 100.0 + dy));
            let mut bitmap = Bitmap::white(200, 200);
            bitmap.stroke(&[vec![a, (100.0, 100.0), b]], pen(4.0, None));
            let dark = inked(&bitmap);
            // rectangle of 120 × 4 and two half discs of radius 2
            let area = 120.0 * 4.0 + std::f64::consts::PI * 4.0;
            assert!((dark - area).abs() < 0.02 * area, "{angle}: {dark}");
        }
    }

    #[test]
    fn a_polygon_covers_its_area_and_is_clipped_to_the_picture() {
        let mut bitmap = Bitmap::white(40, 40);
        bitmap.fill_polygon(&[(10.0, 10.0), (30.0, 10.0), (20.0, 25.0)], [0, 0, 0]);
        let dark = inked(&bitmap);
        assert!((dark - 150.0).abs() < 2.0, "{dark}");
        bitmap.fill_polygon(
            &[(-50.0, -50.0), (90.0, -50.0), (90.0, 90.0), (-50.0, 90.0)],
            INK,
        );
        assert_eq!(bitmap.pixel(0, 39), INK);
        bitmap.stroke(&[vec![(-1e9, 5.0), (1e9, 5.0)]], pen(3.0, None));
        assert_eq!(bitmap.pixel(20, 5), [0, 0, 0]);
    }

    #[test]
    fn dashes_dots_and_discs_cover_their_areas() {
        let disc = std::f64::consts::PI * 9.0;
        let area_of = |draw: &dyn Fn(&mut Bitmap)| {
            let mut bitmap = Bitmap::white(120, 60);
            draw(&mut bitmap);
            inked(&bitmap)
        };
        let dot = area_of(&|page| page.stroke(&[vec![(50.0, 30.0)]], pen(6.0, None)));
        let filled = area_of(&|page| page.fill_disc((50.0, 30.0), 3.0, [0, 0, 0]));
        assert!((dot - disc).abs() < 0.05 * disc, "{dot}");
        assert!((filled - disc).abs() < 0.05 * disc, "{filled}");
        // 100 = 2 × (20 + 18) + 20 + 4: three dashes with round caps, one of them around the corner
        let line = vec![(10.0, 10.0), (60.0, 10.0), (60.0, 40.0), (80.0, 40.0)];
        let dash = Some([20.0, 18.0]);
        let dashed = area_of(&|page| page.stroke(std::slice::from_ref(&line), pen(6.0, dash)));
        let area = 3.0 * (20.0 * 6.0 + disc);
        assert!((dashed - area).abs() < 0.02 * area, "{dashed} {area}");
    }

    #[test]
    fn long_lines_are_drawn_in_pieces_without_visible_joints() {
        let line: Vec<_> = (0..=4 * TOGETHER)
            .map(|k| {
                (
                    10.0 + 0.05 * k as f64,
                    60.0 + 40.0 * (0.02 * k as f64).sin(),
                )
            })
            .collect();
        let mut whole = Bitmap::white(140, 120);
        whole.stroke(std::slice::from_ref(&line), pen(4.0, Some([1e6, 1.0])));
        let mut pieces = Bitmap::white(140, 120);
        pieces.stroke(&[line], pen(4.0, None));
        let (whole, pieces) = (inked(&whole), inked(&pieces));
        assert!((whole - pieces).abs() < 2e-3 * whole, "{whole} {pieces}");
    }
}
