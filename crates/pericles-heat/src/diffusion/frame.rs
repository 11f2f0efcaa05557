//! Places of the sites of a lattice body in padded rows, and the chunks of eight places that the loops compute.

use std::collections::BTreeSet;

use pericles::domain::Domain;
use pericles::lanes::LANES;
use pericles::space::{Lattice, Sites};

use super::kernels::Chunk;

/// The box of all sites of a process. Its rows along x are padded to whole chunks of eight nodes.
///
/// Chunks begin at the same nodes of the whole body for every division among processes: the loops compute a chunk in one of two
/// ways, which round differently.
pub(super) struct Frame {
    /// Coordinates of the sites in the lattice of the whole body.
    at: Vec<[i32; 3]>,
    low: [i32; 3],
    high: [i32; 3],
    strides: [isize; 3],
    /// Number of places.
    pub places: usize,
}

impl Frame {
    /// Creates the frame of the sites of a body, which are on `lattice`. All processes must call it together.
    pub fn new(sites: &Sites, lattice: &Lattice) -> Self {
        let body = sites.cloud().lattice().unwrap_or(lattice).shape;
        // The lattice of the sites has as many periods before the body as after it.
        let before: [i32; 3] =
            std::array::from_fn(|c| ((lattice.shape[c] / body[c] - 1) / 2 * body[c]) as i32);
        let at: Vec<[i32; 3]> = lattice
            .node
            .iter()
            .map(|&node| {
                let inside = lattice.coordinates(node);
                std::array::from_fn(|c| inside[c] - before[c])
            })
            .collect();
        let mut low: [i32; 3] = std::array::from_fn(|c| at.iter().map(|x| x[c]).min().unwrap_or(0));
        let high: [i32; 3] = std::array::from_fn(|c| at.iter().map(|x| x[c]).max().unwrap_or(0));
        let first = match at.is_empty() {
            true => f64::INFINITY,
            false => f64::from(low[0]),
        };
        let first = -sites.cloud().domain().max(-first);
        if !at.is_empty() {
            low[0] -= (low[0] - first as i32).rem_euclid(LANES as i32);
        }
        let side = |c: usize| (high[c] - low[c]) as usize + 1;
        let mut row = side(0).next_multiple_of(LANES);
        // Rows at distances of a multiple of 1024 numbers would compete for the same cache lines.
        if row.is_multiple_of(128) {
            row += LANES;
        }
        Self {
            strides: [1, row as isize, (row * side(1)) as isize],
            places: row * side(1) * side(2),
            at,
            low,
            high,
        }
    }

    /// Returns the places of the sites.
    pub fn site_places(&self) -> impl Iterator<Item = usize> + '_ {
        self.at.iter().map(|&x| self.place(x))
    }

    /// Returns the distance in places of nodes that are `steps` apart.
    pub fn shift(&self, steps: [i32; 3]) -> isize {
        (0..3).map(|c| steps[c] as isize * self.strides[c]).sum()
    }

    /// Returns the place that is `steps` from a site; `None` outside the box.
    pub fn place_beside(&self, site: usize, steps: [i32; 3]) -> Option<usize> {
        let there: [i32; 3] = std::array::from_fn(|c| self.at[site][c] + steps[c]);
        let inside = (0..3).all(|c| (self.low[c]..=self.high[c]).contains(&there[c]));
        inside.then(|| self.place(there))
    }

    fn place(&self, x: [i32; 3]) -> usize {
        self.shift(std::array::from_fn(|c| x[c] - self.low[c])) as usize
    }

    /// Returns the chunks of own points, whose coordinates ascend with x fastest, and the chunk and lane of each point.
    pub fn chunks(&self, sites: &Sites) -> (Vec<Chunk>, Vec<(u32, u8)>) {
        let n = sites.cloud().len();
        let mut chunks: Vec<Chunk> = Vec::new();
        let mut slots = Vec::with_capacity(n);
        for i in 0..n {
            let place = self.place(self.at[sites.of_point(i)]);
            let (first, lane) = (place / LANES * LANES, place % LANES);
            if chunks
                .last()
                .is_none_or(|chunk| chunk.place as usize != first)
            {
                chunks.push(Chunk {
                    place: first as u32,
                    point: i as u32,
                    lanes: 0,
                    is_plain: false,
                });
            }
            let number = chunks.len() - 1;
            chunks[number].lanes |= 1 << lane;
            slots.push((number as u32, lane as u8));
        }
        (chunks, slots)
    }

    /// Marks a chunk as plain only if all processes that own points of it do. All processes must call it together.
    pub fn agree_on_plain(&self, domain: &Domain, chunks: &mut [Chunk]) {
        if !domain.is_divided() {
            return;
        }
        let is_shared = |chunk: &Chunk| chunk.lanes != u8::MAX;
        let own = chunks.iter();
        let own = own.filter(|chunk| is_shared(chunk) && !chunk.is_plain);
        let own = own.flat_map(|chunk| self.first_node(chunk).map(f64::from));
        let all = domain.collect_everywhere(own.collect()).concat();
        let all: BTreeSet<[i32; 3]> = all
            .chunks_exact(3)
            .map(|node| std::array::from_fn(|c| node[c] as i32))
            .collect();
        for chunk in chunks.iter_mut().filter(|chunk| is_shared(chunk)) {
            chunk.is_plain &= !all.contains(&self.first_node(chunk));
        }
    }

    /// Returns the coordinates of the first node of a chunk in the lattice of the whole body.
    fn first_node(&self, chunk: &Chunk) -> [i32; 3] {
        let place = chunk.place as usize;
        let [_, row, layer] = self.strides.map(|stride| stride as usize);
        let inside = [place % row, place % layer / row, place / layer];
        std::array::from_fn(|c| self.low[c] + inside[c] as i32)
    }
}
