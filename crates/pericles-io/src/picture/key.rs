//! The key of a chart: which curve is which.

use super::bitmap::{Bitmap, INK, WHITE};
use super::clip::{inside, length_inside};
use super::curve::{Curve, Pen};
use super::frame::{Area, Sizes};
use super::text::{self, Align, Style};

/// A curve in pixels, cut where it has no number.
pub(super) type Pieces = Vec<Vec<(f64, f64)>>;

/// A box with a sample and a name for each named curve.
pub(super) struct Key<'a> {
    named: Vec<(usize, &'a Curve)>,
    sample: f64,
    row: f64,
    room: f64,
    pub(super) width: f64,
    height: f64,
    gap: f64,
}

/// Places that are tried along each axis.
const PLACES: usize = 9;

impl<'a> Key<'a> {
    /// For the curves that have a name, at most as wide as the chart's area; none if there are none.
    pub(super) fn new(curves: &'a [Curve], widest: f64, sizes: &Sizes) -> Option<Self> {
        let named: Vec<_> = (curves.iter().enumerate())
            .filter(|(_, curve)| !curve.name.is_empty())
            .collect();
        if named.is_empty() {
            return None;
        }
        let (gap, row) = (sizes.gap, 1.5 * sizes.tick_text);
        let sample = 2.2 * sizes.tick_text;
        let longest = named
            .iter()
            .map(|(_, curve)| text::width(&curve.name, sizes.tick_text))
            .fold(0.0, f64::max);
        let room = widest - sample - 5.0 * gap;
        Some(Self {
            width: sample + 3.0 * gap + longest.min(room),
            height: row * named.len() as f64 + gap,
            named,
            sample,
            row,
            room,
            gap,
        })
    }

    /// The upper left corner of a place where the key hides no curve, corners of the area first; none if there is no such place, and it could stand beside the area.
    pub(super) fn free_place(&self, area: Area, drawn: &[Pieces]) -> Option<(f64, f64)> {
        let (left, right) = (area.left + self.gap, area.right - self.gap - self.width);
        let (top, bottom) = (area.top + self.gap, area.bottom - self.gap - self.height);
        let along =
            |from: f64, to: f64, k: usize| from + (to - from) * k as f64 / (PLACES - 1) as f64;
        let corners = [(right, top), (left, top), (right, bottom), (left, bottom)];
        let between = (0..PLACES * PLACES).map(|k| {
            let (column, line) = (PLACES - 1 - k % PLACES, k / PLACES);
            (along(left, right, column), along(top, bottom, line))
        });
        let places: Vec<_> = corners.into_iter().chain(between).collect();
        let hidden: Vec<f64> = places.iter().map(|&at| self.hides(at, drawn)).collect();
        if let Some(free) = hidden.iter().position(|hidden| *hidden == 0.0) {
            return Some(places[free]);
        }
        // Beside it the curves would have less than two thirds of the area.
        let least = (0..places.len()).min_by(|&a, &b| hidden[a].total_cmp(&hidden[b]));
        let narrow = self.width > area.width() / 3.0;
        least.filter(|_| narrow).map(|k| places[k])
    }

    /// How much of the curves lies under the key, pixels.
    fn hides(&self, (left, top): (f64, f64), drawn: &[Pieces]) -> f64 {
        // With a little air.
        let area = Area {
            left: left - 0.5 * self.gap,
            top: top - 0.5 * self.gap,
            right: left + self.width + 0.5 * self.gap,
            bottom: top + self.height + 0.5 * self.gap,
        };
        let pieces = drawn.iter().flatten();
        pieces
            .map(|piece| {
                let points = piece.iter().filter(|place| inside(**place, area)).count();
                length_inside(piece, area) + points as f64
            })
            .sum()
    }

    pub(super) fn draw(&self, bitmap: &mut Bitmap, place: (f64, f64), sizes: &Sizes) {
        let corner = (place.0 + self.width, place.1 + self.height);
        bitmap.fill_rectangle(place, corner, WHITE, 0.85);
        bitmap.outline(place, corner, 1.0, [200, 200, 200]);
        for (line, (number, curve)) in self.named.iter().enumerate() {
            let pen = Pen::of(*number, curve, sizes);
            let y = place.1 + 0.5 * self.gap + self.row * (line as f64 + 0.5);
            let (from, to) = (place.0 + self.gap, place.0 + self.gap + self.sample);
            if curve.line {
                pen.stroke(bitmap, vec![vec![(from, y), (to, y)]]);
            }
            if curve.markers {
                pen.mark(bitmap, (0.5 * (from + to), y));
            }
            let style = Style::new(sizes.tick_text, Align::Start).fitted(&curve.name, self.room);
            text::draw(bitmap, &curve.name, (to + self.gap, y), style.colour(INK));
        }
    }
}
