//! Requested points of an evaluation on a lattice body.

use crate::neighbourhood::GridLayout;
use crate::operator::PointSubset;
use crate::parallel::runs;

/// Requested points of an evaluation on a part of the body; allocated once, set at each evaluation.
pub(in crate::operator) struct WantedPoints {
    /// Requested lanes of each chunk.
    lanes: Vec<u8>,
    /// Range of columns of the requested points of each row.
    own: Vec<[u32; 2]>,
    /// Range of columns of the requested points and their neighbours in each row.
    seen: Vec<[u32; 2]>,
}

/// Empty range.
const NONE: [u32; 2] = [u32::MAX, 0];

impl WantedPoints {
    pub(in crate::operator) fn new(layout: &GridLayout) -> Self {
        Self {
            lanes: vec![0; layout.chunks().len()],
            own: vec![NONE; layout.rows()],
            seen: vec![NONE; layout.rows()],
        }
    }

    /// Sets the points `on`, whose neighbours are at most `radius` cells away along each axis. The cost is
    /// proportional to the number of rows plus chunks of these points.
    pub(in crate::operator) fn set(
        &mut self,
        layout: &GridLayout,
        on: &PointSubset<'_>,
        radius: [usize; 3],
    ) {
        self.lanes.fill(0);
        self.own.fill(NONE);
        let Self { lanes, own, .. } = self;
        let mut row = 0;
        let mut take = |run: std::ops::Range<usize>| {
            layout.for_each_chunk_of(run, &mut row, |row, [from, to], chunk, bits| {
                lanes[chunk] |= bits;
                own[row] = union(own[row], [from, to]);
            });
        };
        match on {
            PointSubset::All => take(0..layout.first_point(layout.blocks())),
            PointSubset::Range(range) => take(range.clone()),
            PointSubset::Set(points) => runs(points).for_each(take),
        }
        self.look_around(layout, radius);
    }

    fn look_around(&mut self, layout: &GridLayout, [x, y, z]: [usize; 3]) {
        self.seen.fill(NONE);
        for (row, &[from, to]) in self.own.iter().enumerate() {
            if from >= to {
                continue;
            }
            let span = [
                from.saturating_sub(x as u32),
                (to + x as u32).min(layout.row_length() as u32),
            ];
            layout.for_each_row_around(row, [y, z], |near| {
                self.seen[near] = union(self.seen[near], span);
            });
        }
    }

    /// Returns the requested lanes of each chunk.
    pub(in crate::operator) fn lanes(&self) -> &[u8] {
        &self.lanes
    }

    /// Returns the columns of the requested points and their neighbours in a row.
    pub(in crate::operator) fn columns(&self, row: usize) -> std::ops::Range<usize> {
        let [from, to] = self.seen[row];
        from as usize..(to as usize).max(from as usize)
    }

    /// Returns the memory use for a layout, bytes.
    pub(in crate::operator) fn bytes_for(layout: &GridLayout) -> usize {
        layout.chunks().len() + 2 * layout.rows() * size_of::<[u32; 2]>()
    }
}

fn union(a: [u32; 2], b: [u32; 2]) -> [u32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}
