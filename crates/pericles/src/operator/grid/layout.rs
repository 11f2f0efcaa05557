//! How a lattice body lies in memory while the grid operator works on it.
//!
//! The rows of the lattice's bounding box along x are padded to whole chunks of eight nodes and follow each other, x fastest. So a
//! neighbour is a fixed number of places away; what lies beyond the end of a row is another row's, and masked out. Before the first and behind
//! the last row lie as many unused places as the farthest neighbour is away. Points keep their compact order outside.

use std::ops::Range;

use rayon::prelude::*;

use crate::lanes::LANES;
use crate::space::Lattice;

/// Eight nodes in a row, at least one of which is a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chunk {
    /// Place of the first node in the padded rows, in chunks.
    pub place: u32,
    /// The first point in it.
    pub point: u32,
    /// Which of its nodes are points.
    pub lanes: u8,
}

impl Chunk {
    /// Its lanes that are points, with the points.
    pub fn points(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let lanes = self.lanes;
        (0..LANES)
            .filter(move |lane| lanes >> lane & 1 == 1)
            .zip(self.point as usize..)
    }
}

/// Consecutive chunks that one thread computes; their points are consecutive too.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    pub first_chunk: usize,
    pub first_point: usize,
}

/// Points and their padded places.
#[derive(Debug, Clone)]
pub(super) struct GridLayout {
    shape: [usize; 3],
    /// Places of a padded row.
    stride: usize,
    chunks: Vec<Chunk>,
    blocks: Vec<Block>,
    /// The chunk at each place (in chunks), or `NONE`.
    chunk_at: Vec<u32>,
    /// The first point of each row, and the number of points at the end.
    row_start: Vec<u32>,
    /// Node of each point along x, only where some row has gaps.
    columns: Option<Vec<u32>>,
}

const NONE: u32 = u32::MAX;

/// Rows taken together, so that neighbouring rows are loaded once for all of them; the working set of a stencil of radius three fits the
/// first-level cache.
const ROWS: usize = 8;

/// The longest piece of a row in a block, in chunks: rows of a bar are shared among threads.
const LONGEST: usize = 256;

/// Numbers copied by one task.
const PIECE: usize = 4096;

impl GridLayout {
    /// The layout of a lattice's nodes.
    pub fn new(lattice: &Lattice) -> Self {
        let shape = lattice.shape;
        let rows = shape[1] * shape[2];
        let mut row_chunks = shape[0].div_ceil(LANES);
        // Rows a multiple of 1024 numbers apart would all compete for the same lines of a cache.
        if rows > 1 && row_chunks.is_multiple_of(16) {
            row_chunks += 1;
        }
        let stride = row_chunks * LANES;
        let mut layout = Self {
            shape,
            stride,
            chunks: Vec::new(),
            blocks: Vec::new(),
            chunk_at: vec![NONE; rows * row_chunks],
            row_start: Vec::with_capacity(rows + 1),
            columns: None,
        };
        let mut full = true;
        let mut point = 0;
        for row in 0..rows {
            layout.row_start.push(point as u32);
            let end = point
                + lattice.node[point..]
                    .partition_point(|&node| (node as usize) < (row + 1) * shape[0]);
            full &= end - point == shape[0] || end == point;
            point = end;
        }
        layout.row_start.push(point as u32);
        if !full {
            let column = |&node: &u32| (node as usize % shape[0]) as u32;
            layout.columns = Some(lattice.node.iter().map(column).collect());
        }
        let (tall, long) = if row_chunks > LONGEST {
            (1, LONGEST)
        } else {
            ((8 * LONGEST / row_chunks).clamp(1, ROWS), row_chunks)
        };
        for row in (0..rows).step_by(tall) {
            for from in (0..row_chunks).step_by(long) {
                layout.add_block(
                    row..(row + tall).min(rows),
                    from..(from + long).min(row_chunks),
                );
            }
        }
        layout
    }

    /// Adds the points of a piece of some rows. Chunks above each other follow each other, because they share most neighbours.
    fn add_block(&mut self, rows: Range<usize>, columns: Range<usize>) {
        let first_chunk = self.chunks.len();
        let mut first_point = usize::MAX;
        for column in columns {
            for row in rows.clone() {
                let (point, lanes) = self.points_of(row, column);
                if lanes != 0 {
                    let place = row * (self.stride / LANES) + column;
                    self.chunk_at[place] = self.chunks.len() as u32;
                    self.chunks.push(Chunk {
                        place: place as u32,
                        point: point as u32,
                        lanes,
                    });
                    first_point = first_point.min(point);
                }
            }
        }
        if self.chunks.len() > first_chunk {
            self.blocks.push(Block {
                first_chunk,
                first_point,
            });
        }
    }

    /// The first point of a chunk and which of its nodes are points.
    fn points_of(&self, row: usize, column: usize) -> (usize, u8) {
        let (from, to) = (
            self.row_start[row] as usize,
            self.row_start[row + 1] as usize,
        );
        if from == to {
            return (from, 0);
        }
        let x = column * LANES;
        match &self.columns {
            None => {
                let len = self.shape[0].saturating_sub(x).min(LANES);
                (from + x, if len == 0 { 0 } else { 0xFF >> (LANES - len) })
            }
            Some(columns) => {
                let row = &columns[from..to];
                let first = row.partition_point(|&c| (c as usize) < x);
                let inside = row[first..]
                    .iter()
                    .take_while(|&&c| (c as usize) < x + LANES);
                (
                    from + first,
                    inside.fold(0, |lanes, &c| lanes | 1 << (c as usize - x)),
                )
            }
        }
    }

    /// All chunks, block by block.
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Numbers of a block's chunks.
    pub fn chunks_of(&self, block: usize) -> Range<usize> {
        let end = self
            .blocks
            .get(block + 1)
            .map_or(self.chunks.len(), |next| next.first_chunk);
        self.blocks[block].first_chunk..end
    }

    /// The first point of a block; behind the last block, the number of points.
    pub fn first_point(&self, block: usize) -> usize {
        match self.blocks.get(block) {
            Some(block) => block.first_point,
            None => self.row_start[self.row_start.len() - 1] as usize,
        }
    }

    /// The block of a chunk.
    pub fn block_of(&self, chunk: usize) -> usize {
        self.blocks
            .partition_point(|block| block.first_chunk <= chunk)
            - 1
    }

    /// Places per step along each axis.
    pub fn strides(&self) -> [usize; 3] {
        [1, self.stride, self.stride * self.shape[1]]
    }

    /// Places of all rows.
    pub fn places(&self) -> usize {
        self.chunk_at.len() * LANES
    }

    /// The chunk and lane of a place.
    pub fn chunk_at(&self, place: usize) -> (usize, usize) {
        (self.chunk_at[place / LANES] as usize, place % LANES)
    }

    /// Integer coordinates of a place; x may lie beyond the body.
    pub fn coordinates(&self, place: usize) -> [usize; 3] {
        let row = place / self.stride;
        [
            place % self.stride,
            row % self.shape[1],
            row / self.shape[1],
        ]
    }

    /// Which of the nodes a step `cell` away from a chunk's points are points themselves.
    pub fn neighbours(&self, chunk: &Chunk, cell: [i32; 3]) -> u8 {
        self.neighbour_bits(chunk, cell, |chunk| chunk.lanes) & chunk.lanes
    }

    /// One bit for each node a step `cell` away from a chunk's nodes, out of one byte per chunk; zero outside the body.
    pub fn neighbour_bits(&self, chunk: &Chunk, cell: [i32; 3], bits: impl Fn(&Chunk) -> u8) -> u8 {
        let [x, y, z] = self.coordinates(chunk.place as usize * LANES);
        let y = y as i64 + i64::from(cell[1]);
        let z = z as i64 + i64::from(cell[2]);
        if !(0..self.shape[1] as i64).contains(&y) || !(0..self.shape[2] as i64).contains(&z) {
            return 0;
        }
        let row_chunks = self.stride / LANES;
        let row = (y as usize + self.shape[1] * z as usize) * row_chunks;
        let x = x as i64 + i64::from(cell[0]);
        let column = x.div_euclid(LANES as i64);
        let byte = |column: i64| -> u16 {
            if !(0..row_chunks as i64).contains(&column) {
                return 0;
            }
            match self.chunk_at[row + column as usize] {
                NONE => 0,
                chunk => u16::from(bits(&self.chunks[chunk as usize])),
            }
        };
        ((byte(column) | byte(column + 1) << LANES) >> x.rem_euclid(LANES as i64)) as u8
    }

    /// The point at a place that has one.
    pub fn point_at(&self, place: usize) -> usize {
        let (chunk, lane) = self.chunk_at(place);
        let chunk = &self.chunks[chunk];
        let before = chunk.lanes & !(0xFF << lane);
        chunk.point as usize + before.count_ones() as usize
    }

    /// The place of a point.
    pub fn place_of(&self, point: usize) -> usize {
        let row = self
            .row_start
            .partition_point(|&start| start as usize <= point)
            - 1;
        let column = match &self.columns {
            None => point - self.row_start[row] as usize,
            Some(columns) => columns[point] as usize,
        };
        row * self.stride + column
    }

    /// Copies the named columns of each row of one component of a vector on points to its padded rows, as the numbers they become there; other places keep what they have.
    pub fn pad<N: Send>(
        &self,
        values: &[f64],
        columns: impl Fn(usize) -> Range<usize> + Sync,
        number: &(impl Fn(f64) -> N + Sync),
        padded: &mut [N],
    ) {
        // Whole rows to a task, or pieces of a very long one.
        if self.stride <= PIECE {
            let rows = PIECE / self.stride;
            padded
                .par_chunks_mut(rows * self.stride)
                .enumerate()
                .for_each(|(group, padded)| {
                    for (k, padded) in padded.chunks_mut(self.stride).enumerate() {
                        let row = group * rows + k;
                        let columns = columns(row);
                        if !columns.is_empty() {
                            self.pad_piece(
                                row,
                                columns.start,
                                values,
                                number,
                                &mut padded[columns],
                            );
                        }
                    }
                });
        } else {
            for (row, padded) in padded.chunks_mut(self.stride).enumerate() {
                let columns = columns(row);
                if !columns.is_empty() {
                    padded[columns.clone()]
                        .par_chunks_mut(PIECE)
                        .enumerate()
                        .for_each(|(k, padded)| {
                            self.pad_piece(row, columns.start + k * PIECE, values, number, padded);
                        });
                }
            }
        }
    }

    /// Copies the points of a row from column x on.
    fn pad_piece<N>(
        &self,
        row: usize,
        x: usize,
        values: &[f64],
        number: &impl Fn(f64) -> N,
        padded: &mut [N],
    ) {
        let (from, to) = (
            self.row_start[row] as usize,
            self.row_start[row + 1] as usize,
        );
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
                for point in first..to {
                    match padded.get_mut(columns[point] as usize - x) {
                        Some(place) => *place = number(values[point]),
                        None => break,
                    }
                }
            }
        }
    }

    /// Calls `visit(row, [first column, end], chunk, lanes)` for every chunk with points of a run of consecutive ones. Runs must come in ascending order:
    /// `row` is where the search for the first one's row begins, and ends up at the last one's.
    pub fn for_each_chunk_of(
        &self,
        run: Range<usize>,
        row: &mut usize,
        mut visit: impl FnMut(usize, [u32; 2], usize, u8),
    ) {
        let mut point = run.start;
        while point < run.end {
            while self.row_start[*row + 1] as usize <= point {
                *row += 1;
            }
            let first = self.row_start[*row] as usize;
            let end = run.end.min(self.row_start[*row + 1] as usize);
            while point < end {
                let (from, last, bits);
                match &self.columns {
                    None => {
                        from = point - first;
                        let behind = (from / LANES + 1) * LANES;
                        let to = behind.min(end - first);
                        bits = 0xFF << (from % LANES) & 0xFF >> (behind - to);
                        last = to - 1;
                        point = first + to;
                    }
                    Some(columns) => {
                        from = columns[point] as usize;
                        let inside = columns[point..end]
                            .iter()
                            .take_while(|&&column| column as usize / LANES == from / LANES);
                        let (lanes, count) = inside.fold((0, 0), |(lanes, count), &column| {
                            (lanes | 1 << (column as usize % LANES), count + 1)
                        });
                        bits = lanes;
                        last = columns[point + count - 1] as usize;
                        point += count;
                    }
                }
                let place = from / LANES;
                let chunk = self.chunk_at[*row * (self.stride / LANES) + place] as usize;
                visit(*row, [from as u32, last as u32 + 1], chunk, bits);
            }
        }
    }

    /// Calls `visit` for a row and those within `radius` of it along y and z, in rows.
    pub fn for_each_row_around(
        &self,
        row: usize,
        radius: [usize; 2],
        mut visit: impl FnMut(usize),
    ) {
        let (y, z) = (row % self.shape[1], row / self.shape[1]);
        for z in z.saturating_sub(radius[1])..=(z + radius[1]).min(self.shape[2] - 1) {
            let low = y.saturating_sub(radius[0]) + self.shape[1] * z;
            let high = (y + radius[0]).min(self.shape[1] - 1) + self.shape[1] * z;
            (low..=high).for_each(&mut visit);
        }
    }

    /// Places of a padded row.
    pub fn row_length(&self) -> usize {
        self.stride
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.row_start.len() - 1
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.chunks[..])
            + size_of_val(&self.blocks[..])
            + size_of_val(&self.chunk_at[..])
            + size_of_val(&self.row_start[..])
            + self.columns.as_deref().map_or(0, size_of_val)
    }
}

/// Which points exert a force, one byte per chunk.
pub(super) struct Partners(pub(super) Vec<u8>);
