//! Blocks of chunks and those of their points that are wanted.

use super::grid_layout::Chunk;
use crate::family::LANES;

/// A block of chunks.
pub(super) struct ChunkBlock<'a> {
    pub chunks: &'a [Chunk],
    /// Number of the first chunk.
    pub first_chunk: usize,
    pub first_point: usize,
    pub wanted: Wanted<'a>,
}

/// The wanted points of a block.
pub(super) enum Wanted<'a> {
    All,
    Range(std::ops::Range<usize>),
    Set(&'a [u32]),
}

impl Wanted<'_> {
    /// The lanes of a chunk that are wanted.
    #[inline(always)]
    pub(super) fn lanes(&self, chunk: &Chunk) -> u8 {
        match self {
            Wanted::All => chunk.lanes,
            Wanted::Range(range) => {
                let first = chunk.point as usize;
                let last = first + chunk.len();
                if range.start <= first && last <= range.end {
                    return chunk.lanes;
                }
                ranked_lanes(chunk, |point| range.contains(&point))
            }
            Wanted::Set(set) => {
                let from = set.partition_point(|&i| i < chunk.point);
                let to =
                    from + set[from..].partition_point(|&i| i < chunk.point + chunk.len() as u32);
                match to - from {
                    0 => 0,
                    count if count == chunk.len() => chunk.lanes,
                    _ => ranked_lanes(chunk, |point| set[from..to].contains(&(point as u32))),
                }
            }
        }
    }
}

/// The lanes of a chunk whose point is wanted.
#[inline(always)]
fn ranked_lanes(chunk: &Chunk, wanted: impl Fn(usize) -> bool) -> u8 {
    let (mut left, mut lanes, mut point) = (chunk.lanes, 0, chunk.point as usize);
    while left != 0 {
        let lane = left & left.wrapping_neg();
        if wanted(point) {
            lanes |= lane;
        }
        left ^= lane;
        point += 1;
    }
    lanes
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
