//! Blocks of chunks and their requested points.

use crate::lanes::LANES;
use crate::neighbourhood::{Chunk, GridLayout};

/// A block of chunks.
pub(in crate::operator) struct ChunkBlock<'a> {
    pub chunks: &'a [Chunk],
    /// Index of the first chunk.
    pub first_chunk: usize,
    pub first_point: usize,
    /// Requested lanes of each chunk; `None` if all points are requested.
    pub lanes: Option<&'a [u8]>,
}

impl<'a> ChunkBlock<'a> {
    /// Returns a block of a layout; `None` if none of its points are requested.
    pub fn of(layout: &'a GridLayout, lanes: Option<&'a [u8]>, block: usize) -> Option<Self> {
        let range = layout.chunks_of(block);
        let lanes = lanes.map(|lanes| &lanes[range.clone()]);
        if lanes.is_some_and(|lanes| lanes.iter().all(|&lanes| lanes == 0)) {
            return None;
        }
        Some(Self {
            lanes,
            first_chunk: range.start,
            chunks: &layout.chunks()[range],
            first_point: layout.first_point(block),
        })
    }

    /// Returns the requested lanes of the k-th chunk.
    #[inline(always)]
    pub(in crate::operator) fn wanted(&self, k: usize) -> u8 {
        match self.lanes {
            None => self.chunks[k].lanes,
            Some(lanes) => lanes[k],
        }
    }
}

/// Sites that exert a force, one byte per place (in chunks).
pub(super) struct Partners(pub(super) Vec<u8>);

/// Adds the values of the requested lanes to their points.
#[inline(always)]
pub(in crate::operator) fn scatter(
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
