//! Requested points of a block in loops over rows of bonds.

use std::ops::Range;

use super::PointSubset;

/// Rows of a block: its first point and its requested points.
pub struct Rows<'a> {
    /// The first point of the block.
    pub first: usize,
    which: Which<'a>,
}

/// The requested points of a block, in ascending order.
enum Which<'a> {
    Range(Range<usize>),
    Set(&'a [u32]),
}

impl<'a> Rows<'a> {
    /// Returns the requested points of the block of `len` points from `first` on; `None` if there are none.
    pub fn of_block(on: &PointSubset<'a>, first: usize, len: usize) -> Option<Self> {
        let block = first..first + len;
        let which = match on {
            PointSubset::All => Which::Range(block),
            PointSubset::Range(range) => {
                let common = range.start.max(block.start)..range.end.min(block.end);
                if common.is_empty() {
                    return None;
                }
                Which::Range(common)
            }
            PointSubset::Set(set) => {
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

    /// Returns the number of requested points.
    #[inline(always)]
    pub fn count(&self) -> usize {
        match &self.which {
            Which::Range(range) => range.len(),
            Which::Set(set) => set.len(),
        }
    }

    /// Returns the k-th requested point.
    #[inline(always)]
    pub fn at(&self, k: usize) -> usize {
        match &self.which {
            Which::Range(range) => range.start + k,
            Which::Set(set) => set[k] as usize,
        }
    }
}
