//! Legends of charts.

use super::bitmap::{INK, WHITE};
use super::clip::length_inside;
use super::curve::{Curve, Look};
use super::drawing::Drawing;
use super::frame::{Area, Sizes};
use super::text::{self, Align, Style};

/// The named curves of a chart, each with a sample of its line.
pub(super) struct Legend<'c> {
    /// The curves and their numbers.
    curves: Vec<(usize, &'c Curve)>,
    sizes: Sizes,
}

/// Size of a legend in pixels.
pub(super) struct LegendSize {
    /// Width of a name.
    room: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

/// A legend in rows above the plot.
pub(super) struct LegendRows {
    columns: usize,
    /// Width of a column.
    column: f64,
    pub(super) height: f64,
}

impl<'c> Legend<'c> {
    /// Creates the legend of the curves that have a name.
    pub(super) fn of(curves: &'c [Curve], sizes: &Sizes) -> Self {
        let curves = curves.iter().enumerate();
        Self {
            curves: curves.filter(|(_, curve)| !curve.name.is_empty()).collect(),
            sizes: *sizes,
        }
    }

    fn sample(&self) -> f64 {
        2.2 * self.sizes.tick_text
    }

    fn row(&self) -> f64 {
        1.5 * self.sizes.tick_text
    }

    fn longest(&self) -> f64 {
        let names = self.curves.iter().map(|(_, curve)| &curve.name);
        names
            .map(|name| text::width(name, self.sizes.tick_text))
            .fold(0.0, f64::max)
    }

    /// Returns the size for a maximum width.
    pub(super) fn size(&self, most: f64) -> LegendSize {
        let beside = self.sample() + 3.0 * self.sizes.gap;
        let room = most - beside;
        LegendSize {
            room,
            width: beside + self.longest().min(room),
            height: self.row() * self.curves.len() as f64 + self.sizes.gap,
        }
    }

    /// Returns the corner of the plot where the legend covers least of the curves, and the covered length in pixels.
    pub(super) fn emptiest(&self, area: Area, drawn: &[Vec<Vec<(f64, f64)>>]) -> ((f64, f64), f64) {
        let gap = self.sizes.gap;
        let LegendSize { width, height, .. } = self.size(area.width() - 2.0 * gap);
        let places = [
            (area.right - gap - width, area.top + gap),
            (area.left + gap, area.top + gap),
            (area.right - gap - width, area.bottom - gap - height),
            (area.left + gap, area.bottom - gap - height),
        ];
        let hidden = |(left, top): (f64, f64)| {
            let area = Area {
                left,
                top,
                right: left + width,
                bottom: top + height,
            };
            let pieces = drawn.iter().flatten().filter(|_| !self.curves.is_empty());
            pieces.map(|piece| length_inside(piece, area)).sum::<f64>()
        };
        let all = places.map(|place| (place, hidden(place)));
        let least = all.into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
        least.unwrap_or((places[0], 0.0))
    }

    /// Draws the legend in a box with its upper left corner at a position.
    pub(super) fn draw(&self, drawing: &mut Drawing, size: &LegendSize, place: (f64, f64)) {
        if self.curves.is_empty() {
            return;
        }
        let gap = self.sizes.gap;
        let corner = (place.0 + size.width, place.1 + size.height);
        drawing.fill_rectangle(place, corner, WHITE, 0.85);
        drawing.outline(place, corner, self.sizes.line / 1.5, [200, 200, 200]);
        for line in 0..self.curves.len() {
            let y = place.1 + 0.5 * gap + self.row() * (line as f64 + 0.5);
            self.entry(drawing, line, (place.0 + gap, y), size.room);
        }
    }

    /// Returns the rows of a legend of at most this width.
    pub(super) fn rows(&self, most: f64) -> LegendRows {
        let column = self.sample() + 3.0 * self.sizes.gap + self.longest();
        let columns = ((most / column) as usize).clamp(1, self.curves.len().max(1));
        let rows = self.curves.len().div_ceil(columns);
        LegendRows {
            columns,
            column: column.min(most),
            height: self.row() * rows as f64,
        }
    }

    /// Draws rows with their upper left corner at a position.
    pub(super) fn draw_rows(&self, drawing: &mut Drawing, rows: &LegendRows, place: (f64, f64)) {
        let room = rows.column - self.sample() - 3.0 * self.sizes.gap;
        for k in 0..self.curves.len() {
            let x = place.0 + rows.column * (k % rows.columns) as f64;
            let y = place.1 + self.row() * ((k / rows.columns) as f64 + 0.5);
            self.entry(drawing, k, (x, y), room);
        }
    }

    /// Draws an entry from its left end on.
    fn entry(&self, drawing: &mut Drawing, entry: usize, (from, y): (f64, f64), room: f64) {
        let (number, curve) = self.curves[entry];
        let look = Look::of(number, curve, &self.sizes);
        let to = from + self.sample();
        if curve.line {
            look.stroke(drawing, vec![vec![(from, y), (to, y)]]);
        }
        if curve.markers {
            look.mark(drawing, (0.5 * (from + to), y));
        }
        let style = Style::new(self.sizes.tick_text, Align::Start).colour(INK);
        let place = (to + self.sizes.gap, y);
        self.sizes
            .text_within(drawing, &curve.name, place, (style, room));
    }
}
