//! Boxes of vectors.

use pericles::domain::Domain;

use crate::vector::V3;

/// Lowest and highest value of each component.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    low: V3,
    high: V3,
}

impl Span {
    pub(super) const NOTHING: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// The box of a single vector.
    pub(super) fn at(place: V3) -> Self {
        Self {
            low: place,
            high: place,
        }
    }

    pub(super) fn add(&mut self, c: usize, x: f64) {
        self.low[c] = self.low[c].min(x);
        self.high[c] = self.high[c].max(x);
    }

    pub(super) fn add_place(&mut self, place: V3) {
        (0..3).for_each(|c| self.add(c, place[c]));
    }

    pub(super) fn merge(&mut self, other: &Self) {
        for c in 0..3 {
            self.low[c] = self.low[c].min(other.low[c]);
            self.high[c] = self.high[c].max(other.high[c]);
        }
    }

    /// Merges each box with those of all processes, which must call it together.
    pub(super) fn agree(spans: &mut [Self], domain: &Domain) {
        if !domain.is_divided() {
            return;
        }
        let ends = spans
            .iter()
            .flat_map(|span| [span.low.map(|x| -x), span.high]);
        let mut numbers: Vec<f64> = ends.flatten().collect();
        domain.max_each(&mut numbers);
        for (span, ends) in spans.iter_mut().zip(numbers.chunks_exact(6)) {
            span.low = std::array::from_fn(|c| -ends[c]);
            span.high = std::array::from_fn(|c| ends[3 + c]);
        }
    }

    /// Square of the distance of two boxes.
    pub(super) fn gap(&self, other: &Self) -> f64 {
        let apart = |c: usize| {
            (self.low[c] - other.high[c])
                .max(other.low[c] - self.high[c])
                .max(0.0)
        };
        (0..3).map(|c| apart(c).powi(2)).sum()
    }

    /// Square of the largest difference of a vector of one box and a vector of the other.
    pub(super) fn spread(&self, other: &Self, dimension: usize) -> f64 {
        let most = |c: usize| (self.high[c] - other.low[c]).max(other.high[c] - self.low[c]);
        (0..dimension).map(|c| most(c).powi(2)).sum()
    }
}
