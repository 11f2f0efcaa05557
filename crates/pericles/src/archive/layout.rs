//! Layouts of arrays: which numbers belong to which points.

use super::{Archive, Entry, Number, Values};
use crate::error::Result;

/// How the numbers of an array belong to the points of a body, which may be divided among processes.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Layout {
    /// The array is equal on all processes.
    #[default]
    Shared,
    /// A component-major vector on the own points.
    Points,
    /// A component-major vector on these own points, which are in ascending order.
    Set(Vec<u32>),
    /// A row of numbers per own point, one row after another; their lengths.
    Rows(Vec<u32>),
    /// Counts of bonds or points of this process, `u64`: the counts of the body are their sums.
    Count,
    /// A [`BinnedSum`](crate::sum::BinnedSum) of terms of this process: the sum of the body is their sum.
    Sum,
}

impl Layout {
    /// Returns the layout of rows that begin at multiples of `start`, which has the end of the last row as its last
    /// entry; together they have `numbers` numbers.
    pub fn rows(start: &[usize], numbers: usize) -> Self {
        let last = start.last().copied().unwrap_or(0);
        let width = numbers.checked_div(last).unwrap_or(0);
        let length = |ends: &[usize]| ((ends[1] - ends[0]) * width) as u32;
        Self::Rows(start.windows(2).map(length).collect())
    }
}

/// A way to save state that needs more than the state itself; see [`saved!`](crate::saved).
pub trait Storage<S: ?Sized> {
    /// Adds the state to the archive.
    fn save(&self, state: &S, archive: &mut Archive);

    /// Restores the state.
    ///
    /// # Errors
    /// The errors of [`Checkpointed::restore`](crate::Checkpointed::restore).
    fn restore(&self, state: &mut S, archive: &Archive) -> Result<()>;
}

/// Saves an entry in an array with a given layout.
#[derive(Debug, Clone)]
pub struct Laid {
    name: String,
    layout: Layout,
}

impl Laid {
    /// An array with a given layout.
    pub fn new(name: impl Into<String>, layout: Layout) -> Self {
        Self {
            name: name.into(),
            layout,
        }
    }

    /// A component-major vector on a set of own points in ascending order.
    pub fn on(name: impl Into<String>, points: &[u32]) -> Self {
        Self::new(name, Layout::Set(points.to_vec()))
    }

    /// Equally many of `numbers` numbers for each of `points` own points, one point after another.
    pub fn per_point(name: impl Into<String>, points: usize, numbers: usize) -> Self {
        let length = numbers.checked_div(points).unwrap_or(0);
        Self::new(name, Layout::Rows(vec![length as u32; points]))
    }

    /// Rows of numbers; see [`Layout::rows`].
    pub fn rows(name: impl Into<String>, start: &[usize], numbers: usize) -> Self {
        Self::new(name, Layout::rows(start, numbers))
    }
}

impl<E: Entry> Storage<E> for Laid {
    fn save(&self, state: &E, archive: &mut Archive) {
        let mut numbers = Vec::with_capacity(state.count());
        state.append_to(&mut numbers);
        archive.put_as(&self.name, Number::values(numbers), self.layout.clone());
    }

    fn restore(&self, state: &mut E, archive: &Archive) -> Result<()> {
        let numbers = archive.exactly(&self.name, state.count())?;
        state.take_from(numbers);
        Ok(())
    }
}

impl Values {
    /// Number of entries.
    pub fn len(&self) -> usize {
        match self {
            Self::F64(numbers) => numbers.len(),
            Self::U64(numbers) => numbers.len(),
            Self::U8(numbers) => numbers.len(),
        }
    }

    /// Returns whether there are no entries.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
