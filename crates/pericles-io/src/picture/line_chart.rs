//! Charts of curves.

use std::path::Path;

use super::backdrop::Backdrop;
use super::bitmap::{INK, SIZES, WHITE};
use super::clip::{clipped, inside, length_inside};
use super::curve::{Axis, Curve, Look};
use super::drawing::Drawing;
use super::frame::{Area, AxisText, ColourBar, Frame, Header, Sizes};
use super::text::{self, Align, Style};
use super::write::write;
use crate::IoError;
use pericles::units::quantity;

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
    width: u32,
    height: u32,
}

/// Size of the legend in pixels: curve names with samples of their lines.
struct KeySize {
    sample: f64,
    /// Width of a name.
    room: f64,
    width: f64,
    height: f64,
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
            width: 1200,
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
        let height = (f64::from(width) * 0.625).round() as u32;
        self.size(width, height.max(*SIZES.start()))
    }

    /// Sets width and height in pixels, 200 to 16 000 each.
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.width = width;
        self.height = height;
        self
    }

    /// Draws the chart and writes it atomically: as SVG if the file name ends in `.svg`, otherwise as PNG.
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
        let sizes = Sizes::of_width(self.width as usize);
        let usable = |point: &(f64, f64)| self.allows(*point);
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
            ticks: self.y.ticks(
                &y,
                &y_shown,
                ((bottom - top) / (3.0 * sizes.tick_text)).clamp(2.0, 9.0) as usize,
            ),
            label: y_shown.label(&self.y.name),
        };
        let left = sizes.beside(&y_text.ticks).round();
        let mut right = (f64::from(self.width) - 2.0 * sizes.gap).round();
        let bar = self.backdrop.as_ref().map(|backdrop| {
            let bar = backdrop.bar();
            let ticks = bar.ticks(bottom - top, &sizes);
            (backdrop, bar, ticks)
        });
        let end = right;
        if let Some((_, _, ticks)) = &bar {
            right = (f64::from(self.width) - ColourBar::room(ticks, &sizes)).round();
        }
        let beside = self.key_beside && bar.is_none();
        if beside {
            // At most a third of the picture: longer names are shrunk.
            let key = self.key_size((right - left) / 3.0, &sizes);
            right -= (key.width + sizes.gap).round();
        }
        let wanted = ((right - left) / (6.0 * sizes.tick_text)).clamp(2.0, 10.0) as usize;
        let x_text = AxisText {
            ticks: self.x.ticks(&x, &x_shown, wanted),
            label: x_shown.label(&self.x.name),
        };
        // The label at the right end must not be clipped.
        let overhang = x_text
            .ticks
            .longest(|label| text::width(label, sizes.tick_text));
        if bar.is_none() && !beside {
            right -= (0.5 * overhang - sizes.gap).max(0.0).round();
        }
        let area = Area {
            left,
            top,
            right,
            bottom,
        };
        let frame = Frame { area, x, y };

        let mut drawing = Drawing::new(self.width as usize, self.height as usize);
        frame.draw_grid(&mut drawing, &x_text, &y_text, &sizes);
        if let Some((backdrop, bar, ticks)) = &bar {
            let factors = [x_shown.factor, y_shown.factor];
            backdrop.draw(&mut drawing, &frame, bar, factors);
            bar.draw(&mut drawing, area, ticks, &sizes);
        }
        let factors = [x_shown.factor, y_shown.factor];
        let curves = self.curves.iter().enumerate();
        let drawn: Vec<_> = curves
            .map(|(number, curve)| {
                let pieces = self.pieces(curve, &frame, factors);
                let look = Look::of(number, curve, &sizes);
                draw_curve(&mut drawing, curve, &pieces, (&look, area));
                pieces
            })
            .collect();
        frame.draw_axes(&mut drawing, &x_text, &y_text, &sizes);
        match beside {
            true => {
                let key = self.key_size((end - left) / 3.0, &sizes);
                let place = (area.right + sizes.gap, area.top);
                self.draw_key(&mut drawing, &key, place, &sizes);
            }
            false => self.draw_key_within(&mut drawing, area, &drawn, &sizes),
        }
        let end = if bar.is_some() || beside { end } else { right };
        self.header.draw(&mut drawing, left, end, &sizes);
        Ok(drawing)
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
        if !SIZES.contains(&self.width) || !SIZES.contains(&self.height) {
            let (width, height, least, most) =
                (self.width, self.height, SIZES.start(), SIZES.end());
            return Err(IoError::Unsuitable {
                path: path.to_path_buf(),
                reason: format!(
                    "the chart is {width} × {height} pixels; allowed: {least} to {most} each"
                ),
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

    /// Returns the named curves with their indices.
    fn named(&self) -> impl Iterator<Item = (usize, &Curve)> {
        let curves = self.curves.iter().enumerate();
        curves.filter(|(_, curve)| !curve.name.is_empty())
    }

    /// Returns the size of the legend for a maximum width.
    fn key_size(&self, most: f64, sizes: &Sizes) -> KeySize {
        let sample = 2.2 * sizes.tick_text;
        let room = most - sample - 3.0 * sizes.gap;
        let longest = self
            .named()
            .map(|(_, curve)| text::width(&curve.name, sizes.tick_text))
            .fold(0.0, f64::max);
        KeySize {
            sample,
            room,
            width: sample + 3.0 * sizes.gap + longest.min(room),
            height: 1.5 * sizes.tick_text * self.named().count() as f64 + sizes.gap,
        }
    }

    /// Draws the legend in the corner where it covers least of the curves.
    fn draw_key_within(
        &self,
        drawing: &mut Drawing,
        area: Area,
        drawn: &[Vec<Vec<(f64, f64)>>],
        sizes: &Sizes,
    ) {
        let gap = sizes.gap;
        let key = self.key_size(area.width() - 2.0 * gap, sizes);
        let KeySize { width, height, .. } = key;
        let places = [
            (area.right - gap - width, area.top + gap),
            (area.left + gap, area.top + gap),
            (area.right - gap - width, area.bottom - gap - height),
            (area.left + gap, area.bottom - gap - height),
        ];
        let hidden = |&(left, top): &(f64, f64)| {
            let area = Area {
                left,
                top,
                right: left + width,
                bottom: top + height,
            };
            let pieces = drawn.iter().flatten();
            pieces.map(|piece| length_inside(piece, area)).sum::<f64>()
        };
        let emptiest = places
            .into_iter()
            .min_by(|a, b| hidden(a).total_cmp(&hidden(b)));
        if let Some(place) = emptiest {
            self.draw_key(drawing, &key, place, sizes);
        }
    }

    /// Draws the legend with its upper left corner at a position.
    fn draw_key(&self, drawing: &mut Drawing, key: &KeySize, place: (f64, f64), sizes: &Sizes) {
        if self.named().next().is_none() {
            return;
        }
        let (gap, row) = (sizes.gap, 1.5 * sizes.tick_text);
        let corner = (place.0 + key.width, place.1 + key.height);
        drawing.fill_rectangle(place, corner, WHITE, 0.85);
        drawing.outline(place, corner, 1.0, [200, 200, 200]);
        for (line, (number, curve)) in self.named().enumerate() {
            let look = Look::of(number, curve, sizes);
            let y = place.1 + 0.5 * gap + row * (line as f64 + 0.5);
            let (from, to) = (place.0 + gap, place.0 + gap + key.sample);
            if curve.line {
                look.stroke(drawing, vec![vec![(from, y), (to, y)]]);
            }
            if curve.markers {
                look.mark(drawing, (0.5 * (from + to), y));
            }
            let style = Style::new(sizes.tick_text, Align::Start).fitted(&curve.name, key.room);
            drawing.text(&curve.name, (to + gap, y), style.colour(INK));
        }
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
