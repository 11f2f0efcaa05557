//! Blocks of chunks and those of their points that are wanted.

use super::layout::Chunk;
use crate::lanes::LANES;

/// A block of chunks.
pub(super) struct ChunkBlock<'a> {
    pub chunks: &'a [Chunk],
    /// Number of the first chunk.
    pub first_chunk: usize,
    pub first_point: usize,
    /// The wanted lanes of each chunk; none if all points are wanted.
    pub lanes: Option<&'a [u8]>,
}

impl ChunkBlock<'_> {
    /// The lanes of the k-th chunk that are wanted.
    #[inline(always)]
    pub(super) fn wanted(&self, k: usize) -> u8 {
        match self.lanes {
            None => self.chunks[k].lanes,
            Some(lanes) => lanes[k],
        }
    }
}

/// Adds the numbers of the wanted lanes to their points.
#[inline(always)]
pub(super) fn scatter(
    numbers: [f64; LANES],
    chunk: &Chunk,
    lanes: u8,
    first_point: usize,
    out: &mut [f64],
) {
    let first = chunk.point as usize - first_point;
    if lanes == 0xFF {
        let out = &mut out[first..first + LANES];
        for k in 0..LANES {
            out[k] += numbers[k];
        }
        return;
    }
    let mut point = first;
    for k in 0..LANES {
        if lanes >> k & 1 == 1 {
            out[point] += numbers[k];
        }
        point += usize::from(chunk.lanes >> k & 1);
    }
}
