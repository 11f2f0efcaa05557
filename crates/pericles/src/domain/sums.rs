//! Sums, maxima and counts over all processes.

use super::Domain;
use crate::sum::BinnedSum;

impl Domain {
    /// Returns Σ term(k) over k < n and all processes, independent of order and division; see [`sum`](crate::sum).
    pub fn sum(&self, n: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
        self.total(BinnedSum::of(n, term))
    }

    /// Returns the total of the sums of all processes.
    pub fn total(&self, own: BinnedSum) -> f64 {
        let [total] = self.totals([own]);
        total
    }

    /// Returns the totals of several sums of all processes, in the same number of messages as one. All processes must call it
    /// together.
    pub fn totals<const N: usize>(&self, own: [BinnedSum; N]) -> [f64; N] {
        self.merged(own).map(|sum| sum.value())
    }

    /// Returns the sums of the terms of all processes. All processes must call it together.
    pub(crate) fn merged<const N: usize>(&self, own: [BinnedSum; N]) -> [BinnedSum; N] {
        if self.comm.size() == 1 {
            return own;
        }
        let mut tops = own.map(|sum| f64::from(sum.top()));
        self.comm.max(&mut tops);
        let mut integers: [_; N] = std::array::from_fn(|k| own[k].integers(tops[k] as i32));
        self.comm.sum(integers.as_flattened_mut());
        std::array::from_fn(|k| BinnedSum::of_integers(tops[k] as i32, integers[k]))
    }

    /// Σ a_k b_k.
    pub fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        self.sum(a.len(), |k| a[k] * b[k])
    }

    /// √Σ a_k².
    pub fn norm(&self, a: &[f64]) -> f64 {
        self.dot(a, a).sqrt()
    }

    /// Returns the maximum over all processes; NaN if the value is NaN on any process.
    pub fn max(&self, value: f64) -> f64 {
        // The maximum of a communicator is defined for numbers other than NaN.
        let mut numbers = [
            if value.is_nan() { f64::INFINITY } else { value },
            f64::from(u8::from(value.is_nan())),
        ];
        self.comm.max(&mut numbers);
        if numbers[1] > 0.0 {
            f64::NAN
        } else {
            numbers[0]
        }
    }

    /// Returns the numbers of the process with the largest measure, the first of several: the properties of one point, which
    /// must be finite or infinite. All processes must call it together.
    pub fn of_largest<const N: usize>(&self, measure: f64, numbers: [f64; N]) -> [f64; N] {
        if !self.is_divided() {
            return numbers;
        }
        let rank = self.comm.rank() as f64;
        let mut largest = [measure];
        self.comm.max(&mut largest);
        let mut first = [if measure == largest[0] {
            -rank
        } else {
            f64::NEG_INFINITY
        }];
        self.comm.max(&mut first);
        let mut numbers = match first[0] == -rank {
            true => numbers,
            false => [f64::NEG_INFINITY; N],
        };
        self.comm.max(&mut numbers);
        numbers
    }

    /// Replaces each number by its maximum over all processes. None of them may be NaN.
    pub fn max_each(&self, numbers: &mut [f64]) {
        self.comm.max(numbers);
    }

    /// Returns the sum of a count over all processes.
    pub fn count(&self, own: u64) -> u64 {
        let mut numbers = [i128::from(own)];
        self.comm.sum(&mut numbers);
        u64::try_from(numbers[0]).unwrap_or(u64::MAX)
    }
}
