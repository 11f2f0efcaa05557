//! Nodes of a lattice row by row.

use std::ops::Range;

use rayon::prelude::*;

use crate::lanes::LANES;

/// Number of entries that are copied in one call.
const PIECE: usize = 4096;
/// Smallest number of calls in a task.
const PIECES: usize = 4;

/// Calls `fill` for the given columns of all rows of `stride` places in parallel, with the row and the first column of each piece
/// of a row.
pub(super) fn for_each_piece<N: Send>(
    stride: usize,
    columns: impl Fn(usize) -> Range<usize> + Sync,
    padded: &mut [N],
    fill: impl Fn((usize, usize), &mut [N]) + Sync,
) {
    // A task copies whole rows, or a part of a very long row.
    if stride <= PIECE {
        let rows = PIECE / stride;
        padded
            .par_chunks_mut(rows * stride)
            .with_min_len(PIECES)
            .enumerate()
            .for_each(|(group, padded)| {
                for (k, padded) in padded.chunks_mut(stride).enumerate() {
                    let row = group * rows + k;
                    let columns = columns(row);
                    if !columns.is_empty() {
                        fill((row, columns.start), &mut padded[columns]);
                    }
                }
            });
    } else {
        for (row, padded) in padded.chunks_mut(stride).enumerate() {
            let columns = columns(row);
            if !columns.is_empty() {
                padded[columns.clone()]
                    .par_chunks_mut(PIECE)
                    .with_min_len(PIECES)
                    .enumerate()
                    .for_each(|(k, padded)| fill((row, columns.start + k * PIECE), padded));
            }
        }
    }
}

/// A subset of the nodes of a box in ascending order, x fastest.
#[derive(Debug, Clone)]
pub struct NodeRows {
    /// Number of nodes of a row of the box.
    length: usize,
    /// First node of each row, followed by the number of nodes.
    start: Vec<u32>,
    /// Column of each node along x, only if a row has gaps.
    columns: Option<Vec<u32>>,
}

impl NodeRows {
    /// Creates the rows of nodes `x + shape[0] (y + shape[1] z)`, ascending.
    pub fn new(shape: [usize; 3], nodes: &[u32]) -> Self {
        let (length, rows) = (shape[0], shape[1] * shape[2]);
        let mut start = Vec::with_capacity(rows + 1);
        let (mut full, mut first) = (true, 0);
        for row in 0..rows {
            start.push(first as u32);
            let before = |&node: &u32| (node as usize) < (row + 1) * length;
            let end = first + nodes[first..].partition_point(before);
            full &= end - first == length || end == first;
            first = end;
        }
        start.push(first as u32);
        let column = |&node: &u32| (node as usize % length) as u32;
        Self {
            length,
            start,
            columns: (!full).then(|| nodes.iter().map(column).collect()),
        }
    }

    /// Returns the number of nodes.
    pub fn len(&self) -> usize {
        self.start[self.start.len() - 1] as usize
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.start.len() - 1
    }

    /// Returns the nodes of a row.
    pub fn row(&self, row: usize) -> Range<usize> {
        self.start[row] as usize..self.start[row + 1] as usize
    }

    /// Returns the columns along x, only if a row has gaps.
    pub fn columns(&self) -> Option<&[u32]> {
        self.columns.as_deref()
    }

    /// Returns the row of a node.
    pub fn row_of(&self, node: usize) -> usize {
        self.start.partition_point(|&start| start as usize <= node) - 1
    }

    /// Returns the column of a node of this row.
    pub fn column(&self, row: usize, node: usize) -> usize {
        match &self.columns {
            None => node - self.start[row] as usize,
            Some(columns) => columns[node] as usize,
        }
    }

    /// Returns the node of a row at a column that has one.
    pub fn node(&self, row: usize, x: usize) -> usize {
        let Range { start, end } = self.row(row);
        match &self.columns {
            None => start + x,
            Some(columns) => {
                start + columns[start..end].partition_point(|&column| (column as usize) < x)
            }
        }
    }

    /// Returns the first node of eight columns of a row, and which columns have nodes.
    pub fn chunk(&self, row: usize, chunk: usize) -> (usize, u8) {
        let Range { start, end } = self.row(row);
        if start == end {
            return (start, 0);
        }
        let x = chunk * LANES;
        match &self.columns {
            None => {
                let len = self.length.saturating_sub(x).min(LANES);
                (start + x, if len == 0 { 0 } else { 0xFF >> (LANES - len) })
            }
            Some(columns) => {
                let row = &columns[start..end];
                let first = row.partition_point(|&column| (column as usize) < x);
                let inside = row[first..]
                    .iter()
                    .take_while(|&&column| (column as usize) < x + LANES);
                let lanes = inside.fold(0, |lanes, &column| lanes | 1 << (column as usize - x));
                (start + first, lanes)
            }
        }
    }

    /// Copies the points of a row to a piece of it that begins at column `x`, and converts the numbers; places without a node are
    /// unchanged.
    pub fn pad_piece<N>(
        &self,
        (row, x): (usize, usize),
        values: &[f64],
        number: &impl Fn(f64) -> N,
        padded: &mut [N],
    ) {
        let Range {
            start: from,
            end: to,
        } = self.row(row);
        match &self.columns {
            None => {
                let from = (from + x).min(to);
                let len = padded.len().min(to - from);
                for (place, &value) in padded[..len].iter_mut().zip(&values[from..from + len]) {
                    *place = number(value);
                }
            }
            Some(columns) => {
                let first =
                    from + columns[from..to].partition_point(|&column| (column as usize) < x);
                for node in first..to {
                    match padded.get_mut(columns[node] as usize - x) {
                        Some(place) => *place = number(values[node]),
                        None => break,
                    }
                }
            }
        }
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.start[..]) + self.columns.as_deref().map_or(0, size_of_val)
    }
}
