//! Lattices and subsets of their nodes.

use super::FillError;

/// Tolerance, in spacings, by which a side may exceed a multiple of the spacing without an additional node.
const SLACK: f64 = 1e-9;

/// Maximum number of nodes in the box of a lattice.
const MOST_NODES: f64 = 4e9;

/// The nodes of a lattice in a box, symmetric about its centre: node i of n along an axis is at centre + (2 i
/// − n + 1) spacing / 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// Centre of the box.
    pub centre: [f64; 3],
    /// Spacings along the axes.
    pub spacing: [f64; 3],
    /// Numbers of nodes along the axes.
    pub counts: [usize; 3],
}

impl Lattice {
    /// Returns the smallest lattice whose cells cover a box, with n = ⌈side / spacing⌉ nodes along each axis,
    /// at least one.
    ///
    /// # Errors
    /// Returns an error for a spacing that is not positive and for more than 4·10⁹ nodes.
    pub fn around(bounds: [[f64; 3]; 2], spacing: [f64; 3]) -> Result<Self, FillError> {
        let mut counts = [1; 3];
        let mut nodes = 1.0;
        for c in 0..3 {
            if !(spacing[c] > 0.0 && spacing[c].is_finite()) {
                return Err(FillError::Spacing { value: spacing[c] });
            }
            let count = ((bounds[1][c] - bounds[0][c]) / spacing[c] - SLACK)
                .ceil()
                .max(1.0);
            nodes *= count;
            if nodes > MOST_NODES || nodes.is_nan() {
                let most = MOST_NODES;
                return Err(FillError::TooMany { nodes, most });
            }
            counts[c] = count as usize;
        }
        Ok(Self {
            centre: std::array::from_fn(|c| 0.5 * (bounds[0][c] + bounds[1][c])),
            spacing,
            counts,
        })
    }

    /// Returns the coordinate along an axis of the nodes with this number.
    pub fn coordinate(&self, axis: usize, number: usize) -> f64 {
        let steps = 2.0 * number as f64 - (self.counts[axis] as f64 - 1.0);
        self.centre[axis] + steps * (0.5 * self.spacing[axis])
    }

    /// Returns the position of a node.
    pub fn position(&self, node: [usize; 3]) -> [f64; 3] {
        std::array::from_fn(|c| self.coordinate(c, node[c]))
    }

    /// Returns the number of nodes in the box.
    pub fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// Always false: there is at least one node.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the volume of a cell.
    pub fn cell_volume(&self) -> f64 {
        self.spacing.iter().product()
    }

    /// Returns the numbers along an axis of the nodes with coordinates between `low` and `high`, extended by
    /// one on both sides against rounding.
    pub(super) fn range(&self, axis: usize, low: f64, high: f64) -> std::ops::Range<usize> {
        let first = self.coordinate(axis, 0);
        let place = |x: f64| (x - first) / self.spacing[axis];
        // Casts clamp numbers to the range and map NaN to zero.
        let begin = (place(low).floor() - 1.0).max(0.0) as usize;
        let end = (place(high).ceil() + 2.0).max(0.0) as usize;
        let count = self.counts[axis];
        begin.min(count)..end.min(count)
    }

    /// Returns the lattice of the sub-cells of a box of cells that begins at `first` and has `counts` cells:
    /// each is divided into `ratio` along the first `dimension` axes.
    pub fn divided_box(
        &self,
        first: [usize; 3],
        counts: [usize; 3],
        dimension: usize,
        ratio: usize,
    ) -> Self {
        let mut fine = *self;
        for c in 0..dimension {
            let ends = [first[c], first[c] + counts[c].max(1) - 1];
            let [low, high] = ends.map(|number| self.coordinate(c, number));
            fine.centre[c] = 0.5 * (low + high);
            fine.spacing[c] /= ratio as f64;
            fine.counts[c] = counts[c] * ratio;
        }
        fine
    }

    /// Returns the lattice of sub-cells: each cell is divided into `parts` along x and y.
    pub(super) fn divided(&self, parts: usize) -> Self {
        let mut fine = *self;
        for c in 0..2 {
            fine.counts[c] *= parts;
            fine.spacing[c] /= parts as f64;
        }
        fine
    }
}

/// The nodes of a lattice inside a surface or an outline.
#[derive(Debug, Clone, PartialEq)]
pub struct Filled {
    pub(super) lattice: Lattice,
    /// Columns (x fastest, then y), each along z.
    pub(super) inside: Vec<bool>,
    pub(super) enclosed: f64,
    pub(super) was_turned: bool,
}

impl Filled {
    /// Returns the lattice.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Returns whether a node is inside.
    pub fn contains(&self, [i, j, k]: [usize; 3]) -> bool {
        let [nx, _, nz] = self.lattice.counts;
        self.inside[(j * nx + i) * nz + k]
    }

    /// Returns the nodes inside; x varies fastest, then y, then z.
    pub fn nodes(&self) -> impl Iterator<Item = [usize; 3]> {
        let [nx, ny, nz] = self.lattice.counts;
        let all =
            (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])));
        all.filter(|&node| self.contains(node))
    }

    /// Returns the number of nodes inside.
    pub fn len(&self) -> usize {
        self.inside.iter().filter(|inside| **inside).count()
    }

    /// Returns whether no node is inside.
    pub fn is_empty(&self) -> bool {
        !self.inside.contains(&true)
    }

    /// Returns the total volume of the cells of the nodes inside; for an outline their area.
    pub fn volume(&self) -> f64 {
        self.len() as f64 * self.lattice.cell_volume()
    }

    /// Returns the enclosed volume of the surface, Σ a · (b × c) / 6 over its triangles: volume enclosed
    /// twice counts twice. For an outline its area.
    pub fn enclosed_volume(&self) -> f64 {
        self.enclosed
    }

    /// Returns whether all triangles pointed inwards, so that the orientation of the surface was reversed.
    pub fn was_turned(&self) -> bool {
        self.was_turned
    }
}
