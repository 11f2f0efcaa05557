//! Axes, header and colour bar of a picture.

use super::bitmap::{INK, Rgb};
use super::category::Category;
use super::colour::ColourMap;
use super::drawing::Drawing;
use super::style::PictureStyle;
use super::text::{self, Align, Style};
use super::ticks::Ticks;
use pericles::units::Shown;

const GRID: Rgb = [224, 224, 224];

/// Sizes in pixels for a given width of the picture. Text is readable when a width of 1200 is shown on half a
/// page.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes {
    pub(super) tick_text: f64,
    pub(super) label_text: f64,
    pub(super) title_text: f64,
    pub(super) gap: f64,
    pub(super) tick: f64,
    pub(super) line: f64,
    /// Whether text has a given size, which is not reduced.
    is_fixed: bool,
}

impl Sizes {
    pub(super) fn of(style: &PictureStyle) -> Self {
        if let Some(print) = style.print {
            let text = print.pixels(print.font_size);
            return Self {
                tick_text: text,
                label_text: text,
                title_text: text,
                gap: 0.5 * text,
                tick: 0.35 * text,
                line: (text / 16.0).max(1.0),
                is_fixed: true,
            };
        }
        let unit = f64::from(style.width) / 1200.0;
        Self {
            tick_text: 21.0 * unit,
            label_text: 23.0 * unit,
            title_text: 26.0 * unit,
            gap: 12.0 * unit,
            tick: 8.0 * unit,
            line: (1.5 * unit).max(1.0),
            is_fixed: false,
        }
    }

    /// Returns the room for a tick in pixels, from heights of its text: `fixed` for text of a given size, which is large in
    /// relation to the picture, else `usual`.
    pub(super) fn tick_room(&self, usual: f64, fixed: f64) -> f64 {
        match self.is_fixed {
            true => fixed * self.tick_text,
            false => usual * self.tick_text,
        }
    }

    /// Returns how often a layout is repeated: the labels need space, which changes the size of the plot and thereby the
    /// labels.
    pub(super) fn rounds(&self) -> usize {
        match self.is_fixed {
            true => 4,
            false => 2,
        }
    }

    /// Draws a text that is shortened, or reduced in size if text has no given size, where it would be longer than `room`.
    pub(super) fn text_within(
        &self,
        drawing: &mut Drawing,
        text: &str,
        place: (f64, f64),
        (style, room): (Style, f64),
    ) {
        match self.is_fixed {
            true => drawing.text(&text::shortened(text, style.size, room), place, style),
            false => drawing.text(text, place, style.fitted(text, room)),
        }
    }

    /// Returns the room for the label of an axis between two ends on a page: text of a given size may be longer than the
    /// axis.
    fn room(&self, [from, to]: [f64; 2], page: f64) -> f64 {
        match self.is_fixed {
            true => (from + to).min(2.0 * page - from - to) - self.gap,
            false => to - from,
        }
    }

    /// Returns the space below a plot for ticks and a label.
    pub(super) fn below(&self) -> f64 {
        self.tick + 1.5 * self.tick_text + 1.3 * self.label_text + self.gap
    }

    /// Returns the space beside a plot for ticks and a vertical label.
    pub(super) fn beside(&self, ticks: &Ticks) -> f64 {
        let labels = ticks.longest(|label| text::width(label, self.tick_text));
        2.0 * self.gap + 1.3 * self.label_text + labels + 1.5 * self.tick
    }
}

/// A rectangle of the picture, in pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Area {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }
}

/// A range of values, linear or logarithmic.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) logarithmic: bool,
}

impl Scale {
    /// Returns the position of a value, 0 at the low and 1 at the high end.
    pub(super) fn fraction(&self, value: f64) -> f64 {
        if self.logarithmic {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    pub(super) fn ticks(&self, wanted: usize) -> Ticks {
        if self.logarithmic {
            Ticks::logarithmic(self.low, self.high, wanted)
        } else {
            Ticks::linear(self.low, self.high, wanted)
        }
    }
}

/// Label and ticks of an axis.
#[derive(Debug, Clone)]
pub(super) struct AxisText {
    pub(super) ticks: Ticks,
    pub(super) label: String,
}

/// A rectangle with coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub(super) area: Area,
    pub(super) x: Scale,
    pub(super) y: Scale,
}

impl Frame {
    /// Returns the position of a point in pixels.
    pub(super) fn place(&self, x: f64, y: f64) -> (f64, f64) {
        (
            self.area.left + self.x.fraction(x) * self.area.width(),
            self.area.bottom - self.y.fraction(y) * self.area.height(),
        )
    }

    pub(super) fn draw_grid(
        &self,
        drawing: &mut Drawing,
        x: &AxisText,
        y: &AxisText,
        sizes: &Sizes,
    ) {
        let area = self.area;
        for (value, _) in &x.ticks.major {
            let (place, _) = self.place(*value, self.y.low);
            drawing.rule((place, area.top), (place, area.bottom), sizes.line, GRID);
        }
        for (value, _) in &y.ticks.major {
            let (_, place) = self.place(self.x.low, *value);
            drawing.rule((area.left, place), (area.right, place), sizes.line, GRID);
        }
    }

    pub(super) fn draw_axes(
        &self,
        drawing: &mut Drawing,
        x: &AxisText,
        y: &AxisText,
        sizes: &Sizes,
    ) {
        let area = self.area;
        let corner = (area.right, area.bottom);
        drawing.outline((area.left, area.top), corner, sizes.line, INK);
        let tick = |drawing: &mut Drawing, from: (f64, f64), length: (f64, f64)| {
            let to = (from.0 + length.0, from.1 + length.1);
            drawing.rule(from, to, sizes.line, INK);
        };
        let short = sizes.tick / 2.0;
        for value in &x.ticks.minor {
            let (place, _) = self.place(*value, self.y.low);
            tick(drawing, (place, area.bottom), (0.0, short));
        }
        for value in &y.ticks.minor {
            let (_, place) = self.place(self.x.low, *value);
            tick(drawing, (area.left, place), (-short, 0.0));
        }
        let middle = area.bottom + sizes.tick + 0.8 * sizes.tick_text;
        for (value, label) in &x.ticks.major {
            let (place, _) = self.place(*value, self.y.low);
            tick(drawing, (place, area.bottom), (0.0, sizes.tick));
            let style = Style::new(sizes.tick_text, Align::Middle);
            drawing.text(label, (place, middle), style);
        }
        for (value, label) in &y.ticks.major {
            let (_, place) = self.place(self.x.low, *value);
            tick(drawing, (area.left, place), (-sizes.tick, 0.0));
            let style = Style::new(sizes.tick_text, Align::End);
            drawing.text(label, (area.left - 1.5 * sizes.tick, place), style);
        }
        let page = [drawing.width(), drawing.height()].map(|pixels| pixels as f64);
        let style = Style::new(sizes.label_text, Align::Middle);
        let style = style.fitted(&x.label, sizes.room([area.left, area.right], page[0]));
        let place = (
            (area.left + area.right) / 2.0,
            area.bottom + sizes.below() - sizes.gap - 0.5 * sizes.label_text,
        );
        drawing.text(&x.label, place, style);
        let style = Style::new(sizes.label_text, Align::Middle);
        let style = style.fitted(&y.label, sizes.room([area.top, area.bottom], page[1]));
        let place = (
            area.left - sizes.beside(&y.ticks) + sizes.gap + 0.5 * sizes.label_text,
            (area.top + area.bottom) / 2.0,
        );
        drawing.text(&y.label, place, style.up());
    }
}

/// The lines above the plot: title and time, and the label of the colour bar.
#[derive(Debug, Clone, Default)]
pub(super) struct Header {
    pub(super) title: String,
    pub(super) stamp: String,
    /// Note below the title.
    pub(super) note: String,
    pub(super) bar_label: String,
}

impl Header {
    pub(super) fn height(&self, sizes: &Sizes) -> f64 {
        sizes.gap + self.first_line(sizes) + self.second_line(sizes) + sizes.gap
    }

    fn first_line(&self, sizes: &Sizes) -> f64 {
        if self.title.is_empty() && self.stamp.is_empty() {
            0.0
        } else {
            1.5 * sizes.title_text
        }
    }

    fn second_line(&self, sizes: &Sizes) -> f64 {
        if self.bar_label.is_empty() && self.note.is_empty() {
            0.0
        } else {
            1.5 * sizes.label_text
        }
    }

    /// Draws between `left` and `right`, from the top of the picture on.
    pub(super) fn draw(&self, drawing: &mut Drawing, left: f64, right: f64, sizes: &Sizes) {
        let middle = sizes.gap + 0.5 * self.first_line(sizes);
        let style = Style::new(sizes.title_text, Align::End);
        drawing.text(&self.stamp, (right, middle), style);
        let mut room = right - left;
        if !self.stamp.is_empty() {
            room -= text::width(&self.stamp, sizes.title_text) + sizes.title_text;
        }
        let style = Style::new(sizes.title_text, Align::Start);
        sizes.text_within(drawing, &self.title, (left, middle), (style, room));

        let middle = sizes.gap + self.first_line(sizes) + 0.5 * self.second_line(sizes);
        let style = Style::new(sizes.label_text, Align::Start);
        drawing.text(&self.note, (left, middle), style);
        let mut room = right - left;
        if !self.note.is_empty() {
            room -= text::width(&self.note, sizes.label_text) + sizes.label_text;
        }
        let style = Style::new(sizes.label_text, Align::End);
        sizes.text_within(drawing, &self.bar_label, (right, middle), (style, room));
    }
}

/// Colour bar to the right of the plot.
#[derive(Debug, Clone)]
pub(super) struct ColourBar {
    pub(super) map: ColourMap,
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) shown: Shown,
    /// Whether values lie beyond the low and the high end; arrows show it.
    pub(super) clipped: [bool; 2],
    /// Categories shown in place of a continuous scale, from the top; empty for quantities.
    pub(super) categories: Vec<Category>,
}

impl ColourBar {
    /// Returns the bar for identification numbers with these names: a colour for each of the most frequent ones.
    pub(super) fn of_numbers(numbers: &[f64], names: &[String]) -> Self {
        Self {
            map: ColourMap::Viridis,
            low: 0.0,
            high: 1.0,
            shown: Shown::for_size(1.0, ""),
            clipped: [false; 2],
            categories: Category::legend(numbers, names),
        }
    }

    pub(super) fn colour(&self, value: f64) -> Rgb {
        if let Some(last) = self.categories.last() {
            let own = self.categories.iter().find(|entry| entry.number == value);
            return own.unwrap_or(last).colour;
        }
        self.map.colour((value - self.low) / (self.high - self.low))
    }

    /// Returns the ticks for a bar of this height in pixels.
    pub(super) fn ticks(&self, height: f64, sizes: &Sizes) -> Ticks {
        if !self.categories.is_empty() {
            let count = self.categories.len();
            let place =
                |k: usize| self.high - (k as f64 + 0.5) / count as f64 * (self.high - self.low);
            let labels = self.categories.iter().enumerate();
            return Ticks {
                major: labels
                    .map(|(k, entry)| (place(k), entry.label.clone()))
                    .collect(),
                ..Ticks::default()
            };
        }
        let factor = self.shown.factor;
        let wanted = (height / sizes.tick_room(3.0, 2.0)).clamp(2.0, 8.0) as usize;
        Ticks::linear(self.low / factor, self.high / factor, wanted)
    }

    fn thickness(sizes: &Sizes) -> f64 {
        1.3 * sizes.label_text
    }

    /// Returns the width from the plot to the right edge of the picture.
    pub(super) fn room(ticks: &Ticks, sizes: &Sizes) -> f64 {
        let labels = ticks.longest(|label| text::width(label, sizes.tick_text));
        2.0 * sizes.gap + Self::thickness(sizes) + 1.5 * sizes.tick + labels + sizes.gap
    }

    /// Draws the bar to the right of the plot, over its whole height.
    pub(super) fn draw(&self, drawing: &mut Drawing, plot: Area, ticks: &Ticks, sizes: &Sizes) {
        let left = (plot.right + 2.0 * sizes.gap).round();
        let right = (left + Self::thickness(sizes)).round();
        let (mut top, mut bottom) = (plot.top.round(), plot.bottom.round());
        let arrow = Self::thickness(sizes).round();
        let middle = 0.5 * (left + right);
        if self.clipped[1] {
            let corners = vec![(left, top + arrow), (right, top + arrow), (middle, top)];
            drawing.fill_polygon(corners, self.map.colour(1.0));
            top += arrow;
        }
        if self.clipped[0] {
            let corners = vec![
                (left, bottom - arrow),
                (right, bottom - arrow),
                (middle, bottom),
            ];
            drawing.fill_polygon(corners, self.map.colour(0.0));
            bottom -= arrow;
        }
        let height = bottom - top;
        let count = self.categories.len() as f64;
        for row in 0..height as usize {
            let fraction = 1.0 - (row as f64 + 0.5) / height;
            let j = top + row as f64;
            let colour = match self.categories.get(((1.0 - fraction) * count) as usize) {
                Some(entry) => entry.colour,
                None => self.map.colour(fraction),
            };
            // Each row extends into the row below, which is drawn over it: SVG viewers show gaps between
            // neighbours.
            let end = (j + 2.0).min(bottom);
            drawing.fill_rectangle((left, j), (right, end), colour, 1.0);
        }
        drawing.outline((left, top), (right, bottom), sizes.line, INK);
        let scale = Scale {
            low: self.low / self.shown.factor,
            high: self.high / self.shown.factor,
            logarithmic: false,
        };
        for (value, label) in &ticks.major {
            let place = bottom - scale.fraction(*value) * height;
            drawing.rule((right, place), (right + sizes.tick, place), sizes.line, INK);
            let style = Style::new(sizes.tick_text, Align::Start);
            drawing.text(label, (right + 1.5 * sizes.tick, place), style);
        }
    }
}

/// Widens a range that is not finite or narrower than rounding errors.
pub(super) fn widened(low: f64, high: f64) -> (f64, f64) {
    if !low.is_finite() || !high.is_finite() || low > high {
        return (0.0, 1.0);
    }
    let size = low.abs().max(high.abs());
    if size == 0.0 {
        (0.0, 1.0)
    } else if high - low > 1e-9 * size {
        (low, high)
    } else {
        (low - 0.05 * size, high + 0.05 * size)
    }
}

/// Returns the minimum and maximum of the finite values.
pub(super) fn finite_range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_of_zero_width_are_widened() {
        assert_eq!(widened(0.0, 0.0), (0.0, 1.0));
        assert_eq!(widened(2.0, 2.0), (1.9, 2.1));
        assert_eq!(widened(-1.0, 3.0), (-1.0, 3.0));
        assert_eq!(
            finite_range([].into_iter()),
            (f64::INFINITY, f64::NEG_INFINITY)
        );
        assert_eq!(widened(f64::INFINITY, f64::NEG_INFINITY), (0.0, 1.0));
        assert_eq!(finite_range([3.0, f64::NAN, -1.0].into_iter()), (-1.0, 3.0));
    }

    #[test]
    fn decades_have_equal_width_on_a_logarithmic_scale() {
        let scale = Scale {
            low: 1e-2,
            high: 1e2,
            logarithmic: true,
        };
        assert!((scale.fraction(1e-1) - 0.25).abs() < 1e-12);
        assert!((scale.fraction(1e2) - 1.0).abs() < 1e-12);
    }
}
