//! Axes and curves of a chart.

use super::bitmap::{Pen, Rgb};
use super::colour::CURVES;
use super::drawing::Drawing;
use super::frame::{Scale, Sizes, finite_range, widened};
use super::ticks::Ticks;
use pericles::units::Shown;

/// White space beyond the data, as a fraction of the axis.
const MARGIN: f64 = 0.04;

/// One axis of a chart.
#[derive(Debug, Clone)]
#[must_use]
pub struct Axis {
    pub(super) name: String,
    unit: String,
    logarithmic: bool,
    range: Option<(f64, f64)>,
    marks: Vec<(f64, String)>,
}

impl Axis {
    /// Creates an axis of a quantity with its SI unit; empty for a dimensionless quantity.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            logarithmic: false,
            range: None,
            marks: Vec::new(),
        }
    }

    /// Labels positions by name, such as the symmetry points of a path through the Brillouin zone, instead of by numbers.
    pub fn marks(mut self, marks: Vec<(f64, String)>) -> Self {
        self.marks = marks;
        self
    }

    /// Returns the ticks of a scale; `wanted` is their approximate number.
    pub(super) fn ticks(&self, scale: &Scale, shown: &Shown, wanted: usize) -> Ticks {
        if self.marks.is_empty() {
            return scale.ticks(wanted);
        }
        let marks = self.marks.iter();
        Ticks {
            major: marks
                .map(|(value, name)| (value / shown.factor, name.clone()))
                .collect(),
            minor: Vec::new(),
        }
    }

    /// Makes the axis logarithmic; values that are not positive are omitted.
    pub fn logarithmic(mut self) -> Self {
        self.logarithmic = true;
        self
    }

    /// Sets the range of the axis; by default it follows the data.
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }

    /// Returns whether the axis can show a value.
    pub(super) fn allows(&self, value: f64) -> bool {
        value.is_finite() && (!self.logarithmic || value > 0.0)
    }

    /// Returns the unit prefix and the scale in shown numbers.
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
                    // at least a factor of two, so that it contains a tick
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
    /// Creates a line through the points in their order; it is interrupted at points that are not finite. A
    /// curve without a name is not in the legend.
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

    /// Creates markers at the points, without a line.
    pub fn points(name: impl Into<String>, x: &[f64], y: &[f64]) -> Self {
        let mut curve = Self::line(name, x, y).with_markers();
        curve.line = false;
        curve
    }

    /// Adds markers at the points.
    pub fn with_markers(mut self) -> Self {
        self.markers = true;
        self
    }

    /// Draws a dashed line, for a reference.
    pub fn dashed(mut self) -> Self {
        self.dashed = true;
        self
    }

    /// Sets the colour; by default the next one of a set that colour-blind readers can distinguish.
    pub fn colour(mut self, colour: [u8; 3]) -> Self {
        self.colour = Some(colour);
        self
    }
}

/// Style of a curve.
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

    /// Draws a marker: disc, square, diamond or triangle, in turn.
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
