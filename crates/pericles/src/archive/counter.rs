//! Counters that are saved in checkpoints.

/// A counter that is saved in checkpoints. A checkpoint may contain any number, so the counter saturates instead of
/// overflowing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Counter(u64);

impl Counter {
    /// Adds `more` to the count.
    pub fn add(&mut self, more: u64) {
        self.0 = self.0.saturating_add(more);
    }

    /// Returns the count.
    pub fn get(self) -> u64 {
        self.0
    }
}

impl From<u64> for Counter {
    fn from(count: u64) -> Self {
        Self(count)
    }
}

impl std::iter::Sum for Counter {
    fn sum<I: Iterator<Item = Self>>(counters: I) -> Self {
        counters.fold(Self::default(), |mut sum, counter| {
            sum.add(counter.0);
            sum
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counters_saturate_at_the_largest_number() {
        let mut counter = Counter::from(u64::MAX - 1);
        counter.add(1);
        counter.add(7);
        assert_eq!(counter.get(), u64::MAX);
        let sum: Counter = [3, u64::MAX, 5].map(Counter::from).into_iter().sum();
        assert_eq!(sum.get(), u64::MAX);
        let sum: Counter = [3, 4].map(Counter::from).into_iter().sum();
        assert_eq!(sum.get(), 7);
    }
}
