//! Axes and curves of a chart, and how a curve is drawn.

use super::bitmap::{Pen, Rgb};
use super::colour::CURVES;
use super::drawing::Drawing;
use super::frame::{Scale, Sizes, finite_range, widened};
use pericles::units::Shown;

/// White space beyond the data, as a part of the axis.
const MARGIN: f64 = 0.04;

/// One axis of a chart.
#[derive(Debug, Clone)]
#[must_use]
pub struct Axis {
    pub(super) name: String,
    unit: String,
    logarithmic: bool,
    range: Option<(f64, f64)>,
}

impl Axis {
    /// A quantity and its SI unit; empty for a pure number.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            logarithmic: false,
            range: None,
        }
    }

    /// Equal distances for equal ratios; numbers that are not positive are left out.
    pub fn logarithmic(mut self) -> Self {
        self.logarithmic = true;
        self
    }

    /// The ends of the axis; otherwise they follow the data.
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }

    /// Whether a number has a place on the axis.
    pub(super) fn allows(&self, value: f64) -> bool {
        value.is_finite() && (!self.logarithmic || value > 0.0)
    }

    /// How numbers are shown and the scale in shown numbers.
    pub(super) fn scale(&self, values: impl Iterator<Item = f64>) -> (Shown, Scale) {
        let logarithmic = self.logarithmic;
        let (low, high) = match self.range {
            Some((low, high)) if logarithmic && low > 0.0 && high > low => (low, high),
            Some((low, high)) if !logarithmic => widened(low, high),
            _ => {
                let (low, high) = finite_range(values);
                if logarithmic {
                    let (low, high) = if low <= high {
                        (low, high)
                    } else {
                        (1.0, 10.0)
                    };
                    // at least a factor of two, so that a tick finds its place
                    let factor = (2.0 * low / high).max(1.0).sqrt() * (high / low).powf(MARGIN);
                    (low / factor, high * factor)
                } else {
                    let (low, high) = widened(low, high);
                    let margin = MARGIN * (high - low);
                    (low - margin, high + margin)
                }
            }
        };
        let shown = if logarithmic {
            Shown::plain(&self.unit)
        } else {
            Shown::for_size(low.abs().max(high.abs()), &self.unit)
        };
        let scale = Scale {
            low: low / shown.factor,
            high: high / shown.factor,
            logarithmic,
        };
        (shown, scale)
    }
}

/// One curve of a chart.
#[derive(Debug, Clone)]
#[must_use]
pub struct Curve {
    pub(super) name: String,
    pub(super) points: Vec<(f64, f64)>,
    pub(super) lengths: (usize, usize),
    pub(super) line: bool,
    pub(super) markers: bool,
    dashed: bool,
    colour: Option<Rgb>,
}

impl Curve {
    /// A line through the points in their order; a point that is not finite interrupts it. A curve without a name is not in the key.
    pub fn line(name: impl Into<String>, x: &[f64], y: &[f64]) -> Self {
        Self {
            name: name.into(),
            points: x.iter().copied().zip(y.iter().copied()).collect(),
            lengths: (x.len(), y.len()),
            line: true,
            markers: false,
            dashed: false,
            colour: None,
        }
    }

    /// Markers at the points, and no line.
    pub fn points(name: impl Into<String>, x: &[f64], y: &[f64]) -> Self {
        let mut curve = Self::line(name, x, y).with_markers();
        curve.line = false;
        curve
    }

    /// Marks the points too.
    pub fn with_markers(mut self) -> Self {
        self.markers = true;
        self
    }

    /// Dashes instead of a full line, for a reference.
    pub fn dashed(mut self) -> Self {
        self.dashed = true;
        self
    }

    /// Its colour; otherwise the next of a set that colour-blind readers can tell apart.
    pub fn colour(mut self, colour: [u8; 3]) -> Self {
        self.colour = Some(colour);
        self
    }
}

/// How a curve is drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    number: usize,
    pen: Pen,
}

impl Look {
    pub(super) fn of(number: usize, curve: &Curve, sizes: &Sizes) -> Self {
        let width = 2.0 * sizes.line;
        let pen = Pen {
            width,
            colour: curve.colour.unwrap_or(CURVES[number % CURVES.len()]),
            dash: curve.dashed.then_some([4.0 * width, 3.6 * width]),
        };
        Self { number, pen }
    }

    pub(super) fn stroke(&self, drawing: &mut Drawing, lines: Vec<Vec<(f64, f64)>>) {
        drawing.stroke(lines, self.pen);
    }

    /// A disc, square, diamond or triangle, in turn.
    pub(super) fn mark(&self, drawing: &mut Drawing, (x, y): (f64, f64)) {
        let (r, colour) = (2.0 * self.pen.width, self.pen.colour);
        let corners: &[(f64, f64)] = match self.number % 4 {
            0 => return drawing.fill_disc((x, y), r, colour),
            1 => &[(-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)],
            2 => &[(0.0, -1.2), (1.2, 0.0), (0.0, 1.2), (-1.2, 0.0)],
            _ => &[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)],
        };
        let corners: Vec<_> = corners.iter().map(|c| (x + r * c.0, y + r * c.1)).collect();
        drawing.fill_polygon(corners, colour);
    }
}
