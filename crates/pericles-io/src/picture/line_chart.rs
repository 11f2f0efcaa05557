//! Charts of curves.

use std::path::Path;

use super::bitmap::{Bitmap, SIZES};
use super::clip::{clipped, inside};
use super::curve::{Axis, Curve, Pen};
use super::frame::{Area, AxisText, Frame, Header, Sizes};
use super::key::{Key, Pieces};
use super::text;
use super::units::quantity;
use crate::IoError;

/// Curves over a common axis.
#[derive(Debug, Clone)]
#[must_use = "nothing is drawn before `write`"]
pub struct LineChart {
    x: Axis,
    y: Axis,
    header: Header,
    curves: Vec<Curve>,
    width: u32,
    height: u32,
}

impl LineChart {
    /// A chart without curves yet.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self {
            x,
            y,
            header: Header::default(),
            curves: Vec::new(),
            width: 1200,
            height: 750,
        }
    }

    /// The line above the chart.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.header.title = title.into();
        self
    }

    /// The time in seconds, for the stamp in the upper right corner.
    pub fn time(self, time: f64) -> Self {
        self.stamp(format!("t = {}", quantity(time, "s")))
    }

    pub(super) fn stamp(mut self, stamp: String) -> Self {
        self.header.stamp = stamp;
        self
    }

    /// Adds a curve.
    pub fn curve(mut self, curve: Curve) -> Self {
        self.curves.push(curve);
        self
    }

    /// The width in pixels, from 200 to 16 000; 1200 if not chosen. The height follows at 5 : 8.
    pub fn width(self, width: u32) -> Self {
        let height = (f64::from(width) * 0.625).round() as u32;
        self.size(width, height.max(*SIZES.start()))
    }

    /// Width and height in pixels, from 200 to 16 000 each.
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.width = width;
        self.height = height;
        self
    }

    /// Draws the chart and writes it as PNG, whole or not at all.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        let path = path.as_ref();
        self.draw(path)?.write_png(path)
    }

    /// Draws the chart as PNG into memory; `name` stands for it in messages.
    pub fn to_png(&self, name: &str) -> Result<Vec<u8>, IoError> {
        let path = Path::new(name);
        let mut bytes = Vec::new();
        self.draw(path)?
            .encode(&mut bytes)
            .map_err(|error| IoError::writing(path, error))?;
        Ok(bytes)
    }

    pub(super) fn draw(&self, path: &Path) -> Result<Bitmap, IoError> {
        self.check(path)?;
        let sizes = Sizes::of_width(self.width as usize);
        let usable = |&(x, y): &(f64, f64)| self.x.allows(x) && self.y.allows(y);
        let all = || {
            self.curves
                .iter()
                .flat_map(|c| &c.points)
                .filter(|p| usable(p))
        };
        let (x_shown, x) = self.x.scale(all().map(|p| p.0));
        let (y_shown, y) = self.y.scale(all().map(|p| p.1));

        let top = self.header.height(&sizes).max(2.0 * sizes.gap).round();
        let bottom = (f64::from(self.height) - sizes.below()).round();
        let y_text = AxisText {
            ticks: y.ticks(((bottom - top) / (3.0 * sizes.tick_text)).clamp(2.0, 9.0) as usize),
            label: y_shown.label(&self.y.name),
        };
        let left = sizes.beside(&y_text.ticks).round();
        let mut right = (f64::from(self.width) - 2.0 * sizes.gap).round();
        let wanted = ((right - left) / (6.0 * sizes.tick_text)).clamp(2.0, 10.0) as usize;
        let x_text = AxisText {
            ticks: x.ticks(wanted),
            label: x_shown.label(&self.x.name),
        };
        // A label under the right end must not be cut.
        let overhang = x_text
            .ticks
            .longest(|label| text::width(label, sizes.tick_text));
        right -= (0.5 * overhang - sizes.gap).max(0.0).round();
        let frame_to = |right: f64| Frame {
            area: Area {
                left,
                top,
                right,
                bottom,
            },
            x,
            y,
        };
        // In pixels, with gaps where there is no number.
        let pieces_in = |frame: &Frame| -> Vec<Pieces> {
            let place = |point: &(f64, f64)| {
                frame.place(point.0 / x_shown.factor, point.1 / y_shown.factor)
            };
            let pieces = |curve: &Curve| {
                let runs = curve.points.split(|point| !usable(point));
                runs.map(|run| run.iter().map(place).collect()).collect()
            };
            self.curves.iter().map(pieces).collect()
        };
        let mut frame = frame_to(right);
        let mut drawn = pieces_in(&frame);
        let key = Key::new(&self.curves, frame.area.width(), &sizes);
        let mut key_at = (0.0, 0.0);
        if let Some(key) = &key {
            key_at = key.free_place(frame.area, &drawn).unwrap_or_else(|| {
                // Curves everywhere: beside them.
                frame = frame_to((right - key.width - sizes.gap).round());
                drawn = pieces_in(&frame);
                (frame.area.right + sizes.gap, top)
            });
        }
        let area = frame.area;

        let mut bitmap = Bitmap::white(self.width as usize, self.height as usize);
        frame.draw_grid(&mut bitmap, &x_text, &y_text, &sizes);
        for (number, (curve, pieces)) in self.curves.iter().zip(&drawn).enumerate() {
            let pen = Pen::of(number, curve, &sizes);
            if curve.line {
                let lines = pieces
                    .iter()
                    .flat_map(|piece| clipped(piece, area))
                    .collect();
                pen.stroke(&mut bitmap, lines);
            }
            if curve.markers {
                for &place in pieces
                    .iter()
                    .flatten()
                    .filter(|place| inside(**place, area))
                {
                    pen.mark(&mut bitmap, place);
                }
            }
        }
        frame.draw_axes(&mut bitmap, &x_text, &y_text, &sizes);
        if let Some(key) = &key {
            key.draw(&mut bitmap, key_at, &sizes);
        }
        self.header.draw(&mut bitmap, left, right, &sizes);
        Ok(bitmap)
    }

    fn check(&self, path: &Path) -> Result<(), IoError> {
        if !SIZES.contains(&self.width) || !SIZES.contains(&self.height) {
            let (width, height, least, most) =
                (self.width, self.height, SIZES.start(), SIZES.end());
            return Err(IoError::Unsuitable {
                path: path.to_path_buf(),
                reason: format!(
                    "a chart of {width} × {height} pixels; {least} to {most} are allowed"
                ),
            });
        }
        for curve in &self.curves {
            let (expected, given) = curve.lengths;
            if expected != given {
                return Err(IoError::Shape {
                    path: path.to_path_buf(),
                    what: format!("y of curve {:?}", curve.name),
                    expected,
                    given,
                });
            }
        }
        Ok(())
    }
}
