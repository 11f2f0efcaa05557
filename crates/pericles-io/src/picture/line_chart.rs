//! Charts of curves.

use std::path::Path;

use super::backdrop::Backdrop;
use super::bitmap::SIZES;
use super::clip::{clipped, inside};
use super::curve::{Axis, Curve, Look};
use super::drawing::Drawing;
use super::frame::{Area, AxisText, ColourBar, Frame, Header, Scale, Sizes};
use super::legend::{Legend, LegendRows};
use super::style::PictureStyle;
use super::text;
use super::write::write;
use crate::IoError;
use pericles::units::{Shown, quantity};

/// A chart of curves over common axes.
#[derive(Debug, Clone)]
#[must_use = "nothing is drawn before `write`"]
pub struct LineChart {
    x: Axis,
    y: Axis,
    header: Header,
    curves: Vec<Curve>,
    backdrop: Option<Backdrop>,
    key_beside: bool,
    style: PictureStyle,
    height: u32,
}

impl LineChart {
    /// Creates a chart without curves.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self {
            x,
            y,
            header: Header::default(),
            curves: Vec::new(),
            backdrop: None,
            key_beside: false,
            style: PictureStyle::default(),
            height: 750,
        }
    }

    /// Sets the title above the chart.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.header.title = title.into();
        self
    }

    /// Sets the time in seconds, shown in the upper right corner.
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

    /// Sets a colour map of values below the curves. The axes should have the same range.
    pub fn backdrop(mut self, backdrop: Backdrop) -> Self {
        self.header.bar_label.clone_from(&backdrop.name);
        self.backdrop = Some(backdrop);
        self
    }

    /// Places the legend to the right of the plot, where it hides nothing; by default it is in the emptiest
    /// corner. It is not available with the colour bar of a backdrop.
    pub fn key_beside(mut self) -> Self {
        self.key_beside = true;
        self
    }

    /// Sets the width in pixels, 200 to 16 000; the default is 1200. The aspect ratio is 8 : 5.
    pub fn width(self, width: u32) -> Self {
        self.style(PictureStyle::of_width(width))
    }

    /// Sets size and style. The aspect ratio is 8 : 5.
    pub fn style(mut self, style: PictureStyle) -> Self {
        let height = (f64::from(style.width) * 0.625).round() as u32;
        self.height = height.max(*SIZES.start());
        self.style = style;
        self
    }

    /// Sets width and height in pixels, 200 to 16 000 each.
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.style.width = width;
        self.height = height;
        self
    }

    /// Draws the chart and writes it atomically: as SVG or PDF if the file name ends in `.svg` or `.pdf`, otherwise as PNG.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        let path = path.as_ref();
        write(&self.draw(path)?, path)
    }

    /// Encodes the chart as PNG in memory; `name` is used in messages.
    pub fn to_png(&self, name: &str) -> Result<Vec<u8>, IoError> {
        let path = Path::new(name);
        let mut bytes = Vec::new();
        self.draw(path)?
            .to_bitmap()
            .encode(&mut bytes)
            .map_err(|error| IoError::writing(path, error))?;
        Ok(bytes)
    }

    pub(super) fn draw(&self, path: &Path) -> Result<Drawing, IoError> {
        self.check(path)?;
        let sizes = Sizes::of(&self.style);
        let legend = Legend::of(&self.curves, &sizes);
        let (drawing, area, hidden) = self.drawn(&sizes, &legend, None);
        // Text of a given size may leave no corner for the legend.
        if hidden == 0.0 || self.style.print.is_none() {
            return Ok(drawing);
        }
        let rows = legend.rows(area.width());
        let (drawing, ..) = self.drawn(&sizes, &legend, Some(&rows));
        Ok(drawing)
    }

    /// Draws the chart with its legend in rows above the plot, or within or beside it; returns the plot and the length of the
    /// curves that the legend covers, in pixels.
    fn drawn(
        &self,
        sizes: &Sizes,
        legend: &Legend<'_>,
        rows: Option<&LegendRows>,
    ) -> (Drawing, Area, f64) {
        let (x_scale, y_scale) = self.scales();
        let header = self.shown_header();
        let above = rows.map_or(0.0, |rows| rows.height.round());
        let height = self.height as usize + above as usize;
        let top = header.height(sizes).max(2.0 * sizes.gap).round() + above;
        let bottom = (height as f64 - sizes.below()).round();
        let (y_shown, y) = y_scale;
        let wanted = (bottom - top) / sizes.tick_room(3.0, 2.0);
        let y_text = AxisText {
            ticks: self.y.ticks(&y, &y_shown, wanted.clamp(2.0, 9.0) as usize),
            label: y_shown.label(&self.y.name),
        };
        let left = sizes.beside(&y_text.ticks).round();
        let mut right = (f64::from(self.style.width) - 2.0 * sizes.gap).round();
        let bar = self.backdrop.as_ref().map(|backdrop| {
            let bar = backdrop.bar();
            let ticks = bar.ticks(bottom - top, sizes);
            (backdrop, bar, ticks)
        });
        let end = right;
        if let Some((_, _, ticks)) = &bar {
            right = (f64::from(self.style.width) - ColourBar::room(ticks, sizes)).round();
        }
        // At most a third of the picture: longer names are shrunk.
        let beside = (self.key_beside && bar.is_none()).then(|| legend.size((right - left) / 3.0));
        if let Some(size) = &beside {
            right -= (size.width + sizes.gap).round();
        }
        let (x_shown, x) = x_scale;
        let wanted = (right - left) / sizes.tick_room(6.0, 4.0);
        let x_text = AxisText {
            ticks: self.x.ticks(&x, &x_shown, wanted.clamp(2.0, 10.0) as usize),
            label: x_shown.label(&self.x.name),
        };
        // The label at the right end must not be clipped.
        let overhang = x_text
            .ticks
            .longest(|label| text::width(label, sizes.tick_text));
        if bar.is_none() && beside.is_none() {
            right -= (0.5 * overhang - sizes.gap).max(0.0).round();
        }
        let area = Area {
            left,
            top,
            right,
            bottom,
        };
        let frame = Frame { area, x, y };
        let factors = [x_shown.factor, y_shown.factor];
        let mut drawing = Drawing::new(&self.style, height);
        frame.draw_grid(&mut drawing, &x_text, &y_text, sizes);
        if let Some((backdrop, bar, ticks)) = &bar {
            backdrop.draw(&mut drawing, &frame, bar, factors);
            bar.draw(&mut drawing, area, ticks, sizes);
        }
        let pieces = self.draw_curves(&mut drawing, &frame, factors, sizes);
        frame.draw_axes(&mut drawing, &x_text, &y_text, sizes);
        let hidden = match (&beside, rows) {
            (_, Some(rows)) => {
                legend.draw_rows(&mut drawing, rows, (left, top - above - 0.5 * sizes.gap));
                0.0
            }
            (Some(size), None) => {
                legend.draw(&mut drawing, size, (area.right + sizes.gap, area.top));
                0.0
            }
            (None, None) => {
                let (place, hidden) = legend.emptiest(area, &pieces);
                let size = legend.size(area.width() - 2.0 * sizes.gap);
                legend.draw(&mut drawing, &size, place);
                hidden
            }
        };
        let end = if bar.is_some() || beside.is_some() {
            end
        } else {
            right
        };
        header.draw(&mut drawing, left, end, sizes);
        (drawing, area, hidden)
    }

    /// Returns the scales of both axes.
    fn scales(&self) -> ((Shown, Scale), (Shown, Scale)) {
        let usable = |point: &&(f64, f64)| self.allows(**point);
        let all = || {
            let points = self.curves.iter().flat_map(|curve| &curve.points);
            points.filter(usable)
        };
        let x = self.x.scale(all().map(|point| point.0));
        (x, self.y.scale(all().map(|point| point.1)))
    }

    /// Draws the curves; returns their pieces in pixels.
    fn draw_curves(
        &self,
        drawing: &mut Drawing,
        frame: &Frame,
        factors: [f64; 2],
        sizes: &Sizes,
    ) -> Vec<Vec<Vec<(f64, f64)>>> {
        let curves = self.curves.iter().enumerate();
        curves
            .map(|(number, curve)| {
                let pieces = self.pieces(curve, frame, factors);
                let look = Look::of(number, curve, sizes);
                draw_curve(drawing, curve, &pieces, (&look, frame.area));
                pieces
            })
            .collect()
    }

    /// Returns the lines above the plot.
    fn shown_header(&self) -> Header {
        let mut header = self.header.clone();
        if !self.style.titled {
            header.title.clear();
            header.stamp.clear();
        }
        header
    }

    /// Returns whether both axes can show a point.
    fn allows(&self, (x, y): (f64, f64)) -> bool {
        self.x.allows(x) && self.y.allows(y)
    }

    /// Returns the pieces of a curve in pixels, interrupted at missing values.
    fn pieces(&self, curve: &Curve, frame: &Frame, factors: [f64; 2]) -> Vec<Vec<(f64, f64)>> {
        let mut pieces = vec![Vec::new()];
        for point in &curve.points {
            if self.allows(*point) {
                let place = frame.place(point.0 / factors[0], point.1 / factors[1]);
                if let Some(piece) = pieces.last_mut() {
                    piece.push(place);
                }
            } else {
                pieces.push(Vec::new());
            }
        }
        pieces
    }

    fn check(&self, path: &Path) -> Result<(), IoError> {
        if let Some(problem) = self.style.problem() {
            return Err(IoError::Unsuitable {
                path: path.to_path_buf(),
                reason: problem,
            });
        }
        if !SIZES.contains(&self.height) {
            let (height, least, most) = (self.height, SIZES.start(), SIZES.end());
            return Err(IoError::Unsuitable {
                path: path.to_path_buf(),
                reason: format!("the height is {height} pixels; allowed: {least} to {most}"),
            });
        }
        if let Some(backdrop) = &self.backdrop {
            let (expected, given) = backdrop.lengths();
            if expected != given {
                return Err(IoError::Shape {
                    path: path.to_path_buf(),
                    what: "the backdrop".into(),
                    expected,
                    given,
                });
            }
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

/// Draws the line and the markers of a curve inside an area.
fn draw_curve(
    drawing: &mut Drawing,
    curve: &Curve,
    pieces: &[Vec<(f64, f64)>],
    (look, area): (&Look, Area),
) {
    if curve.line {
        let lines = pieces
            .iter()
            .flat_map(|piece| clipped(piece, area))
            .collect();
        look.stroke(drawing, lines);
    }
    if curve.markers {
        let places = pieces.iter().flatten();
        for &place in places.filter(|place| inside(**place, area)) {
            look.mark(drawing, place);
        }
    }
}
