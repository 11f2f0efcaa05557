//! Stored state: what a run must keep to go on as if it had never stopped.

use std::collections::BTreeMap;

use crate::error::{PericlesError, Result};

/// An array of an archive.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Floating-point numbers.
    F64(Vec<f64>),
    /// Counts.
    U64(Vec<u64>),
    /// Bytes.
    U8(Vec<u8>),
}

/// Named arrays; the file format is not this library's business.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Archive {
    arrays: BTreeMap<String, Values>,
}

/// Things that may carry state from step to step: operators (damage), boundaries, integrators, observers. One that carries none says so by an empty implementation.
pub trait Saved {
    /// Adds the state to the archive.
    fn save(&self, archive: &mut Archive) {
        let _ = archive;
    }

    /// Takes the state back.
    ///
    /// # Errors
    /// [`PericlesError::BadArchive`] if an array is missing or has another size; the object is then unchanged or to be thrown away.
    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let _ = archive;
        Ok(())
    }
}

impl Archive {
    /// Adds an array; an array of the same name is replaced.
    pub fn put(&mut self, name: impl Into<String>, values: Values) {
        self.arrays.insert(name.into(), values);
    }

    /// All arrays by name.
    pub fn arrays(&self) -> &BTreeMap<String, Values> {
        &self.arrays
    }

    /// All arrays, given away.
    pub fn into_arrays(self) -> BTreeMap<String, Values> {
        self.arrays
    }

    /// Fills `target` with the numbers stored under `name`.
    pub fn f64_into(&self, name: &str, target: &mut [f64]) -> Result<()> {
        match self.arrays.get(name) {
            Some(Values::F64(stored)) => copy(name, stored, target),
            _ => Err(missing(name)),
        }
    }

    /// Fills `target` with the bytes stored under `name`.
    pub fn u8_into(&self, name: &str, target: &mut [u8]) -> Result<()> {
        match self.arrays.get(name) {
            Some(Values::U8(stored)) => copy(name, stored, target),
            _ => Err(missing(name)),
        }
    }

    /// Fills `target` with the counts stored under `name`.
    pub fn u64_into(&self, name: &str, target: &mut [u64]) -> Result<()> {
        match self.arrays.get(name) {
            Some(Values::U64(stored)) => copy(name, stored, target),
            _ => Err(missing(name)),
        }
    }

    /// The array of counts stored under `name`, of any length.
    pub fn u64s(&self, name: &str) -> Result<&[u64]> {
        match self.arrays.get(name) {
            Some(Values::U64(stored)) => Ok(stored),
            _ => Err(missing(name)),
        }
    }

    /// The array of numbers stored under `name`, of any length.
    pub fn f64s(&self, name: &str) -> Result<&[f64]> {
        match self.arrays.get(name) {
            Some(Values::F64(stored)) => Ok(stored),
            _ => Err(missing(name)),
        }
    }
}

/// A count that goes on from a checkpoint. What a checkpoint holds may be any number, so it stays at the largest one in place of an overflow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) struct Counter(u64);

impl Counter {
    /// Counts `more`.
    pub(crate) fn add(&mut self, more: u64) {
        self.0 = self.0.saturating_add(more);
    }

    /// The count.
    pub(crate) fn get(self) -> u64 {
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

fn missing(name: &str) -> PericlesError {
    PericlesError::BadArchive {
        reason: format!("the array \"{name}\" is missing or of another type"),
    }
}

fn copy<T: Copy>(name: &str, stored: &[T], target: &mut [T]) -> Result<()> {
    if stored.len() != target.len() {
        return Err(PericlesError::BadArchive {
            reason: format!(
                "the array \"{name}\" has {} entries, the model needs {}",
                stored.len(),
                target.len()
            ),
        });
    }
    target.copy_from_slice(stored);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counters_stay_at_the_largest_number() {
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
