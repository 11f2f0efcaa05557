//! Colour map of values on a grid, below the curves of a chart.

use super::colour::ColourMap;
use super::drawing::Drawing;
use super::frame::{ColourBar, Frame, finite_range, widened};
use pericles::units::Shown;

/// Values over both axes of a [`LineChart`](super::LineChart), drawn by colour with a colour bar.
#[derive(Debug, Clone)]
#[must_use]
pub struct Backdrop {
    pub(super) name: String,
    unit: String,
    /// Boundaries of the columns, ascending.
    columns: Vec<f64>,
    y: (f64, f64),
    rows: usize,
    values: Vec<f64>,
    range: Option<(f64, f64)>,
}

impl Backdrop {
    /// Creates a backdrop from `values`, column by column, each from the bottom up. `columns` are the
    /// boundaries of the columns along x, one more than there are columns; the rows divide the range `y`
    /// equally.
    pub fn new(columns: &[f64], y: (f64, f64), rows: usize, values: &[f64]) -> Self {
        Self {
            name: String::new(),
            unit: String::new(),
            columns: columns.to_vec(),
            y,
            rows,
            values: values.to_vec(),
            range: None,
        }
    }

    /// Sets the quantity and its unit.
    pub fn label(mut self, name: impl Into<String>, unit: impl Into<String>) -> Self {
        self.name = name.into();
        self.unit = unit.into();
        self
    }

    /// Sets the values at the ends of the colour bar; by default the minimum and maximum.
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }

    /// Returns the expected and the given number of values.
    pub(super) fn lengths(&self) -> (usize, usize) {
        let columns = self.columns.len().saturating_sub(1);
        (columns * self.rows, self.values.len())
    }

    pub(super) fn bar(&self) -> ColourBar {
        let (low, high) = self
            .range
            .unwrap_or_else(|| finite_range(self.values.iter().copied()));
        let (low, high) = widened(low, high);
        ColourBar {
            map: ColourMap::default(),
            low,
            high,
            shown: Shown::for_size(low.abs().max(high.abs()), &self.unit),
            clipped: [false; 2],
            categories: Vec::new(),
        }
    }

    /// Fills the cells; `factors` convert values to shown numbers on both axes.
    pub(super) fn draw(
        &self,
        drawing: &mut Drawing,
        frame: &Frame,
        bar: &ColourBar,
        factors: [f64; 2],
    ) {
        let area = frame.area;
        let place = |x: f64, y: f64| {
            let (x, y) = frame.place(x / factors[0], y / factors[1]);
            // Whole pixels avoid gaps between neighbouring cells.
            (
                x.clamp(area.left, area.right).round(),
                y.clamp(area.top, area.bottom).round(),
            )
        };
        let height = (self.y.1 - self.y.0) / self.rows as f64;
        for (number, ends) in self.columns.windows(2).enumerate() {
            for row in 0..self.rows {
                let low = self.y.0 + row as f64 * height;
                let (left, bottom) = place(ends[0], low);
                let (right, top) = place(ends[1], low + height);
                let colour = bar.colour(self.values[number * self.rows + row]);
                drawing.fill_rectangle((left, top), (right, bottom), colour, 1.0);
            }
        }
    }
}
