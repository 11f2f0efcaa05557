//! Memory layout of a lattice body for the stencil kernel.
//!
//! The rows along x of the bounding box of the lattice are padded to whole chunks of eight nodes and stored
//! consecutively, x fastest, so that a neighbour is a fixed number of places away. Neighbours beyond the end
//! of a row are places of another row, which are masked out. Before the first and after the last row there
//! are as many unused places as the distance of the farthest neighbour. Vectors on points outside of the
//! kernel are compact.
//!
//! Ghosts of other processes and images beyond periodic faces ([`Sites`]) have places in a larger box; no
//! force is computed for them.

use std::ops::Range;

use super::rows::{NodeRows, for_each_piece};
use super::runs::PointRuns;
use crate::domain::Field;
use crate::lanes::LANES;
use crate::space::{Lattice, Sites};

/// Eight nodes of a row, at least one of which is an own point.
#[derive(Debug, Clone, Copy)]
pub struct Chunk {
    /// Place of the first node in the padded rows, in chunks.
    pub place: u32,
    /// First own point of the chunk.
    pub point: u32,
    /// Bits of the nodes that are own points.
    pub lanes: u8,
}

impl Chunk {
    /// Returns the lanes that are points, with their points.
    pub fn points(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let lanes = self.lanes;
        (0..LANES)
            .filter(move |lane| lanes >> lane & 1 == 1)
            .zip(self.point as usize..)
    }
}

/// Consecutive chunks computed by one thread; their points are also consecutive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    pub first_chunk: usize,
    pub first_point: usize,
}

/// Points and their padded places.
#[derive(Debug, Clone)]
pub struct GridLayout {
    shape: [usize; 3],
    /// Number of places of a padded row.
    stride: usize,
    chunks: Vec<Chunk>,
    blocks: Vec<Block>,
    /// Chunk at each place (in chunks), or `NONE`.
    chunk_at: Vec<u32>,
    /// Own points by row.
    own: NodeRows,
    /// Own points, ghosts and images, if there are ghosts or images.
    seen: Option<Seen>,
}

/// Nodes of all sites.
#[derive(Debug, Clone)]
struct Seen {
    rows: NodeRows,
    /// Site of each node, in the order of nodes.
    site: Vec<u32>,
    /// Point of each node; ghosts are numbered after own points.
    point: Vec<u32>,
    /// Nodes that are sites, one byte per place (in chunks).
    present: Vec<u8>,
    runs: PointRuns,
}

const NONE: u32 = u32::MAX;

/// Number of rows computed together, so that neighbouring rows are loaded once for all of them; the working
/// set of a stencil of radius three fits the first-level cache.
const ROWS: usize = 8;

/// Largest part of a row in a block, in chunks: long rows of bars are divided among threads.
const LONGEST: usize = 256;

impl GridLayout {
    /// Creates the layout of the sites of a lattice.
    pub fn new(sites: &Sites, lattice: &Lattice) -> Self {
        if sites.are_points() {
            return Self::of_rows(NodeRows::new(lattice.shape, &lattice.node), lattice.shape);
        }
        let (mut corner, mut shape) = bounding_box(lattice);
        let owned = sites.cloud().len();
        // Own points begin with a whole chunk: ghosts before them would shift them into one more chunk per row.
        let along_x = |i: usize| lattice.coordinates(lattice.node[sites.of_point(i)])[0];
        let before = (0..owned).map(along_x).min().map_or(0, |x| x - corner[0]);
        let unused = (LANES - before as usize % LANES) % LANES;
        corner[0] -= unused as i32;
        shape[0] += unused;
        let inside = |site: usize| {
            let at = lattice.coordinates(lattice.node[site]);
            let [x, y, z] = std::array::from_fn(|c| (at[c] - corner[c]) as usize);
            (x + shape[0] * (y + shape[1] * z)) as u32
        };
        let own: Vec<u32> = (0..owned).map(|i| inside(sites.of_point(i))).collect();
        let mut layout = Self::of_rows(NodeRows::new(shape, &own), shape);
        let mut site: Vec<u32> = (0..sites.len() as u32).collect();
        site.sort_unstable_by_key(|&site| inside(site as usize));
        let nodes: Vec<u32> = site.iter().map(|&site| inside(site as usize)).collect();
        let mut present = vec![0; layout.chunk_at.len()];
        for &node in &nodes {
            let (row, x) = (node as usize / shape[0], node as usize % shape[0]);
            let place = row * layout.stride + x;
            present[place / LANES] |= 1 << (place % LANES);
        }
        let point = |&site: &u32| sites.point(site as usize) as u32;
        let point: Vec<u32> = site.iter().map(point).collect();
        let rows = NodeRows::new(shape, &nodes);
        layout.seen = Some(Seen {
            runs: PointRuns::new(&rows, &point, owned),
            rows,
            point,
            site,
            present,
        });
        layout
    }

    /// Creates the layout of own points.
    fn of_rows(own: NodeRows, shape: [usize; 3]) -> Self {
        let rows = shape[1] * shape[2];
        let mut row_chunks = shape[0].div_ceil(LANES);
        // Rows at distances of a multiple of 1024 numbers would compete for the same cache lines.
        if rows > 1 && row_chunks.is_multiple_of(16) {
            row_chunks += 1;
        }
        let mut layout = Self {
            shape,
            stride: row_chunks * LANES,
            chunks: Vec::new(),
            blocks: Vec::new(),
            chunk_at: vec![NONE; rows * row_chunks],
            own,
            seen: None,
        };
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

    /// Adds the points of some columns of some rows. Chunks of the same columns are consecutive, because they
    /// share most neighbours.
    fn add_block(&mut self, rows: Range<usize>, columns: Range<usize>) {
        let first_chunk = self.chunks.len();
        let mut first_point = usize::MAX;
        for column in columns {
            for row in rows.clone() {
                let (point, lanes) = self.own.chunk(row, column);
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

    /// Returns all chunks, block by block.
    pub fn chunks(&self) -> &[Chunk] {
        &self.chunks
    }

    /// Returns the number of blocks.
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Returns the indices of the chunks of a block.
    pub fn chunks_of(&self, block: usize) -> Range<usize> {
        let end = self
            .blocks
            .get(block + 1)
            .map_or(self.chunks.len(), |next| next.first_chunk);
        self.blocks[block].first_chunk..end
    }

    /// Returns the first point of a block; after the last block, the number of points.
    pub fn first_point(&self, block: usize) -> usize {
        match self.blocks.get(block) {
            Some(block) => block.first_point,
            None => self.own.len(),
        }
    }

    /// Returns the block of a chunk.
    pub fn block_of(&self, chunk: usize) -> usize {
        self.blocks
            .partition_point(|block| block.first_chunk <= chunk)
            - 1
    }

    /// Returns the strides along each axis, in places.
    pub fn strides(&self) -> [usize; 3] {
        [1, self.stride, self.stride * self.shape[1]]
    }

    /// Returns the number of places of all rows.
    pub fn places(&self) -> usize {
        self.chunk_at.len() * LANES
    }

    /// Returns the chunk and lane of a place.
    pub fn chunk_at(&self, place: usize) -> (usize, usize) {
        (self.chunk_at[place / LANES] as usize, place % LANES)
    }

    /// Returns the integer coordinates of a place; x may lie beyond the body.
    pub fn coordinates(&self, place: usize) -> [usize; 3] {
        let row = place / self.stride;
        [
            place % self.stride,
            row % self.shape[1],
            row / self.shape[1],
        ]
    }

    /// Returns which of the nodes at the offset `cell` from the points of a chunk are sites.
    pub fn neighbours(&self, chunk: &Chunk, cell: [i32; 3]) -> u8 {
        let there = match &self.seen {
            None => self.neighbour_bits(chunk, cell, |place| match self.chunk_at[place] {
                NONE => 0,
                chunk => self.chunks[chunk as usize].lanes,
            }),
            Some(seen) => self.neighbour_bits(chunk, cell, |place| seen.present[place]),
        };
        there & chunk.lanes
    }

    /// Returns one bit for each node at the offset `cell` from the nodes of a chunk, from `bits`, one byte
    /// per place (in chunks); zero outside the box.
    pub fn neighbour_bits(&self, chunk: &Chunk, cell: [i32; 3], bits: impl Fn(usize) -> u8) -> u8 {
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
            u16::from(bits(row + column as usize))
        };
        ((byte(column) | byte(column + 1) << LANES) >> x.rem_euclid(LANES as i64)) as u8
    }

    /// Returns one byte per place (in chunks) with the marked sites. `marks` contains all points, ghosts
    /// after own points.
    pub fn marked(&self, marks: impl Fn(usize) -> bool) -> Vec<u8> {
        let mut bytes = vec![0; self.chunk_at.len()];
        match &self.seen {
            None => {
                for chunk in &self.chunks {
                    for (lane, _) in chunk.points().filter(|&(_, i)| marks(i)) {
                        bytes[chunk.place as usize] |= 1 << lane;
                    }
                }
            }
            Some(seen) => {
                for row in 0..seen.rows.rows() {
                    let nodes = seen.rows.row(row);
                    for node in nodes.filter(|&node| marks(seen.point[node] as usize)) {
                        let place = row * self.stride + seen.rows.column(row, node);
                        bytes[place / LANES] |= 1 << (place % LANES);
                    }
                }
            }
        }
        bytes
    }

    /// Returns a value per place: the value of its site, or the default without a site.
    pub fn at_places<T: Clone + Default>(&self, of_site: impl Fn(usize) -> T) -> Vec<T> {
        let mut numbers = vec![T::default(); self.places()];
        let nodes = self.nodes();
        for row in 0..nodes.rows() {
            for node in nodes.row(row) {
                let site = self
                    .seen
                    .as_ref()
                    .map_or(node, |seen| seen.site[node] as usize);
                numbers[row * self.stride + nodes.column(row, node)] = of_site(site);
            }
        }
        numbers
    }

    /// Returns the site at a place that has one.
    pub fn site_at(&self, place: usize) -> usize {
        match &self.seen {
            None => self.point_at(place),
            Some(seen) => {
                seen.site[seen.rows.node(place / self.stride, place % self.stride)] as usize
            }
        }
    }

    /// Returns the point at a place that has a site; ghosts are numbered after own points.
    pub fn point_at(&self, place: usize) -> usize {
        if let Some(seen) = &self.seen {
            return seen.point[seen.rows.node(place / self.stride, place % self.stride)] as usize;
        }
        let (chunk, lane) = self.chunk_at(place);
        let chunk = &self.chunks[chunk];
        let before = chunk.lanes & !(0xFF << lane);
        chunk.point as usize + before.count_ones() as usize
    }

    /// Returns the place of an own point.
    pub fn place_of(&self, point: usize) -> usize {
        let row = self.own.row_of(point);
        row * self.stride + self.own.column(row, point)
    }

    /// Returns whether all sites are points.
    pub fn is_of_points(&self) -> bool {
        self.seen.is_none()
    }

    /// Copies the given columns of each row of component `c` of `components` of a vector field to padded rows, and converts the
    /// numbers; other places are unchanged.
    pub fn pad<N: Send>(
        &self,
        field: Field<'_>,
        (c, components): (usize, usize),
        columns: impl Fn(usize) -> Range<usize> + Sync,
        number: impl Fn(f64) -> N + Sync,
        padded: &mut [N],
    ) {
        match &self.seen {
            None => {
                let n = field.owned.len() / components;
                let values = &field.owned[c * n..(c + 1) * n];
                for_each_piece(self.stride, columns, padded, |piece, padded| {
                    self.own.pad_piece(piece, values, &number, padded);
                });
            }
            Some(seen) => for_each_piece(self.stride, columns, padded, |piece, padded| {
                (seen.runs).pad_piece(piece, field, (c, components), &number, padded);
            }),
        }
    }

    /// Returns the rows of all nodes with values.
    pub fn nodes(&self) -> &NodeRows {
        self.seen.as_ref().map_or(&self.own, |seen| &seen.rows)
    }

    /// Calls `visit(row, [first column, end], chunk, lanes)` for each chunk with points of a range. Ranges
    /// must come in ascending order: the search for the row of the first point starts at `row`, which is set
    /// to the row of the last point.
    pub fn for_each_chunk_of(
        &self,
        run: Range<usize>,
        row: &mut usize,
        mut visit: impl FnMut(usize, [u32; 2], usize, u8),
    ) {
        let mut point = run.start;
        while point < run.end {
            while self.own.row(*row).end <= point {
                *row += 1;
            }
            let Range { start: first, end } = self.own.row(*row);
            let end = run.end.min(end);
            while point < end {
                let (from, last, bits);
                match self.own.columns() {
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

    /// Calls `visit` for a row and all rows within `radius` along y and z, in rows.
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

    /// Returns the number of places of a padded row.
    pub fn row_length(&self) -> usize {
        self.stride
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.own.rows()
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.chunks[..])
            + size_of_val(&self.blocks[..])
            + size_of_val(&self.chunk_at[..])
            + self.own.bytes()
            + self.seen.as_ref().map_or(0, |seen| {
                seen.rows.bytes()
                    + 2 * size_of_val(&seen.site[..])
                    + seen.present.len()
                    + seen.runs.bytes()
            })
    }
}

/// Returns the bounding box of a lattice: its corner, and the number of nodes along each axis.
fn bounding_box(lattice: &Lattice) -> ([i32; 3], [usize; 3]) {
    if lattice.node.is_empty() {
        return ([0; 3], [1; 3]);
    }
    let (mut low, mut high) = ([i32::MAX; 3], [i32::MIN; 3]);
    for &node in &lattice.node {
        let at = lattice.coordinates(node);
        for c in 0..3 {
            (low[c], high[c]) = (low[c].min(at[c]), high[c].max(at[c]));
        }
    }
    let side = |c: usize| (high[c] - low[c] + 1) as usize;
    (low, std::array::from_fn(side))
}
