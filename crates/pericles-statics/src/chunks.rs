//! Loops over the entries of vectors, of which those of coarse levels are short.

use pericles::parallel;

/// Vectors up to this length are not worth waking other threads for.
const SHORT: usize = 8192;

/// Calls `work(first entry, entries)` for the entries of a vector in one or several chunks, on all cores if it is long. The work on an entry must not depend on the chunk that it is in.
pub(crate) fn for_each_chunk<T: Send>(entries: &mut [T], work: &(dyn Fn(usize, &mut [T]) + Sync)) {
    if entries.len() <= SHORT {
        work(0, entries);
    } else {
        parallel::for_each_chunk(entries, work);
    }
}
