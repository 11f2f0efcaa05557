//! Which points of a block a loop over rows of bonds runs over.

use std::ops::Range;

use super::On;

/// Rows of a block: its first point, and which of its points are wanted.
pub struct Rows<'a> {
    /// The first point of the block.
    pub first: usize,
    which: Which<'a>,
}

/// The wanted points of a block, in ascending order.
enum Which<'a> {
    Range(Range<usize>),
    Set(&'a [u32]),
}

impl<'a> Rows<'a> {
    /// The wanted points of the block of `len` points from `first` on, none if there are none.
    pub fn of_block(on: &On<'a>, first: usize, len: usize) -> Option<Self> {
        let block = first..first + len;
        let which = match on {
            On::All => Which::Range(block),
            On::Range(range) => {
                let common = range.start.max(block.start)..range.end.min(block.end);
                if common.is_empty() {
                    return None;
                }
                Which::Range(common)
            }
            On::Set(set) => {
                let from = set.partition_point(|&i| (i as usize) < block.start);
                let to = set.partition_point(|&i| (i as usize) < block.end);
                if from == to {
                    return None;
                }
                Which::Set(&set[from..to])
            }
        };
        Some(Self { first, which })
    }

    /// Number of wanted points.
    #[inline(always)]
    pub fn count(&self) -> usize {
        match &self.which {
            Which::Range(range) => range.len(),
            Which::Set(set) => set.len(),
        }
    }

    /// The k-th wanted point.
    #[inline(always)]
    pub fn at(&self, k: usize) -> usize {
        match &self.which {
            Which::Range(range) => range.start + k,
            Which::Set(set) => set[k] as usize,
        }
    }
}
