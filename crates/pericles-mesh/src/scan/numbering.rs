//! Mapping from node or element numbers of a file to indices.

use std::collections::HashMap;
use std::num::NonZeroU32;

/// Map from numbers in a file to indices. Nearly consecutive numbers take four bytes each.
#[derive(Debug, Clone, Default)]
pub(crate) struct Numbering {
    /// Index + 1 by number.
    dense: Vec<Option<NonZeroU32>>,
    sparse: HashMap<i64, u32>,
    len: usize,
}

impl Numbering {
    /// Assigns an index to a number; returns `false` if it already has one.
    pub(crate) fn insert(&mut self, number: i64, place: u32) -> bool {
        let next = place.checked_add(1).and_then(NonZeroU32::new);
        let limit = 4 * self.len + 1024;
        let index = usize::try_from(number).ok().filter(|&n| n < limit);
        match (index, next) {
            (Some(index), Some(next)) if !self.sparse.contains_key(&number) => {
                if index >= self.dense.len() {
                    self.dense.resize(index + 1, None);
                }
                if self.dense[index].is_some() {
                    return false;
                }
                self.dense[index] = Some(next);
            }
            _ => {
                if self.get(number).is_some() {
                    return false;
                }
                self.sparse.insert(number, place);
            }
        }
        self.len += 1;
        true
    }

    /// Returns the index of a number.
    pub(crate) fn get(&self, number: i64) -> Option<u32> {
        let dense = usize::try_from(number).ok();
        let dense = dense.and_then(|index| self.dense.get(index).copied().flatten());
        match dense {
            Some(next) => Some(next.get() - 1),
            None if self.sparse.is_empty() => None,
            None => self.sparse.get(&number).copied(),
        }
    }
}
