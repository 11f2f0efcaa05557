//! Vectors on points, copied to padded rows for one evaluation.

use std::ops::Range;

use super::layout::GridLayout;
use super::wanted::WantedPoints;
use crate::parallel::components;

/// Bytes of a cache line; numbers loaded across two lines cost twice.
const LINE: usize = 64;

/// One vector field in padded rows (see [`GridLayout`]), made once and filled at each evaluation.
pub(super) struct Padded<const D: usize> {
    values: Vec<f64>,
    /// First number used, so that rows start on cache lines.
    start: usize,
    places: usize,
    /// Unused places between the components and at both ends.
    margin: usize,
}

impl<const D: usize> Padded<D> {
    /// Room for a vector field; neighbours are at most `farthest` places away.
    pub fn new(layout: &GridLayout, farthest: usize) -> Self {
        let per_line = LINE / size_of::<f64>();
        let margin = farthest.next_multiple_of(per_line);
        let places = layout.places();
        let values = vec![0.0; D * (places + margin) + margin + per_line];
        let start = values.as_ptr().align_offset(LINE).min(per_line);
        Self {
            values,
            start,
            places,
            margin,
        }
    }

    /// Copies all points.
    pub fn fill(&mut self, layout: &GridLayout, field: &[f64]) {
        let whole = 0..layout.row_length();
        self.copy(layout, field, |_| whole.clone());
    }

    /// Copies at least the wanted points and their neighbours.
    pub fn fill_around(&mut self, layout: &GridLayout, field: &[f64], wanted: &WantedPoints) {
        self.copy(layout, field, |row| wanted.columns(row));
    }

    fn copy(
        &mut self,
        layout: &GridLayout,
        field: &[f64],
        columns: impl Fn(usize) -> Range<usize> + Sync,
    ) {
        let field = components::<D>(field, field.len() / D);
        let rows = self.values[self.start + self.margin..].chunks_mut(self.places + self.margin);
        for (padded, values) in rows.zip(field) {
            layout.pad(values, &columns, &mut padded[..self.places]);
        }
    }

    /// The components, each with the margins around it.
    pub fn components(&self) -> [&[f64]; D] {
        std::array::from_fn(|c| {
            let from = self.start + c * (self.places + self.margin);
            &self.values[from..from + self.places + 2 * self.margin]
        })
    }

    /// Places before the first row of each component.
    pub fn margin(&self) -> usize {
        self.margin
    }

    /// Memory of one field, bytes.
    pub fn bytes_for(layout: &GridLayout, farthest: usize) -> usize {
        let per_line = LINE / size_of::<f64>();
        let margin = farthest.next_multiple_of(per_line);
        let numbers = D * (layout.places() + margin) + margin + per_line;
        numbers * size_of::<f64>()
    }
}
