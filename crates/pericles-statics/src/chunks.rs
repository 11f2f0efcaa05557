//! Parallel loops over the entries of vectors; short vectors of coarse levels use one thread.

use pericles::parallel;

/// Length up to which a vector is processed by one thread.
const SHORT: usize = 8192;

/// Calls `work(first entry, entries)` for the entries of a vector in one or several chunks, in parallel for
/// long vectors. The work on an entry must not depend on the chunk.
pub(crate) fn for_each_chunk<T: Send>(entries: &mut [T], work: &(dyn Fn(usize, &mut [T]) + Sync)) {
    if entries.len() <= SHORT {
        work(0, entries);
    } else {
        parallel::for_each_chunk(entries, work);
    }
}
