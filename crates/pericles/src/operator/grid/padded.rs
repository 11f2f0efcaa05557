//! Vectors on points copied to padded rows for an evaluation.

use std::ops::Range;

use super::numbers::GridNumber;
use super::wanted::WantedPoints;
use crate::domain::Field;
use crate::neighbourhood::GridLayout;

/// Size of a cache line, bytes; loads across two lines cost twice.
const LINE: usize = 64;

/// Origin and unit of a vector in floats. The origin belongs to a fixed point, so that results do not depend
/// on the requested points.
pub(in crate::operator) struct Frame<const D: usize> {
    origin: [f64; D],
    per_unit: f64,
}

impl<const D: usize> Frame<D> {
    /// Returns the frame of a field with the unit of length `unit`.
    pub fn of(field: Field<'_>, unit: f64) -> Self {
        let field = field.owned;
        let n = field.len() / D;
        Self {
            origin: std::array::from_fn(|c| field.get(c * n + n / 2).copied().unwrap_or(0.0)),
            per_unit: 1.0 / unit,
        }
    }
}

/// A vector field in padded rows (see [`GridLayout`]), allocated once and filled at each evaluation.
pub(in crate::operator) struct Padded<N, const D: usize> {
    values: Vec<N>,
    /// First used entry: rows start at cache lines.
    start: usize,
    places: usize,
    /// Number of unused places between the components and at both ends.
    margin: usize,
}

impl<N: GridNumber, const D: usize> Padded<N, D> {
    /// Allocates a vector field; neighbours are at most `farthest` places away.
    pub fn new(layout: &GridLayout, farthest: usize) -> Self {
        let per_line = LINE / size_of::<N>();
        let margin = farthest.next_multiple_of(per_line);
        let places = layout.places();
        let values = vec![N::default(); D * (places + margin) + margin + per_line];
        let start = values.as_ptr().align_offset(LINE).min(per_line);
        Self {
            values,
            start,
            places,
            margin,
        }
    }

    /// Copies all points.
    pub fn fill(&mut self, layout: &GridLayout, field: Field<'_>, frame: &Frame<D>) {
        let whole = 0..layout.row_length();
        self.copy(layout, field, frame, |_| whole.clone());
    }

    /// Copies at least the requested points and their neighbours.
    pub fn fill_around(
        &mut self,
        layout: &GridLayout,
        field: Field<'_>,
        frame: &Frame<D>,
        wanted: &WantedPoints,
    ) {
        self.copy(layout, field, frame, |row| wanted.columns(row));
    }

    fn copy(
        &mut self,
        layout: &GridLayout,
        field: Field<'_>,
        frame: &Frame<D>,
        columns: impl Fn(usize) -> Range<usize> + Sync,
    ) {
        let rows = self.values[self.start + self.margin..].chunks_mut(self.places + self.margin);
        for (c, padded) in rows.take(D).enumerate() {
            let (origin, per_unit) = (frame.origin[c], frame.per_unit);
            let number = |value| N::of(value, origin, per_unit);
            let padded = &mut padded[..self.places];
            layout.pad(field, (c, D), &columns, number, padded);
        }
    }

    /// Returns the components, each with the margins around it.
    pub fn components(&self) -> [&[N]; D] {
        std::array::from_fn(|c| {
            let from = self.start + c * (self.places + self.margin);
            &self.values[from..from + self.places + 2 * self.margin]
        })
    }

    /// Returns the number of places before the first row of each component.
    pub fn margin(&self) -> usize {
        self.margin
    }

    /// Returns the memory use of a field, bytes.
    pub fn bytes_for(layout: &GridLayout, farthest: usize) -> usize {
        let per_line = LINE / size_of::<N>();
        let margin = farthest.next_multiple_of(per_line);
        let numbers = D * (layout.places() + margin) + margin + per_line;
        numbers * size_of::<N>()
    }
}
