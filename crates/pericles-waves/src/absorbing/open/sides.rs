//! Open sides of a plate and the parameters of their layers.

use pericles::space::{Face, PointCloud};

use super::error::OpenError;
use super::plate::{End, Line};

/// The open sides of a plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct OpenSides {
    /// Cells of the layer at the lower and upper end along x and y; `None` if the side is not open.
    pub cells: [[Option<usize>; 2]; 2],
    /// Axes along which opposite sides are joined.
    pub periodic: [bool; 2],
}

/// Parameters of the layers in units of c_P/Δx, the speed of long longitudinal waves over the spacing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenOptions {
    /// Largest rate σ₀ of the stretching.
    pub stretching: f64,
    /// Largest rate g₀ of the filter of short waves.
    pub filter: f64,
    /// Decay rate α of the memory.
    pub decay: f64,
}

impl Default for OpenOptions {
    fn default() -> Self {
        Self {
            stretching: 3.0,
            filter: 8.0,
            decay: 0.01,
        }
    }
}

impl OpenOptions {
    /// Longest time between two passes of the filter, in units of Δx/c_P. Fewer passes in long steps would filter less.
    const FILTER_INTERVAL: f64 = 0.35;

    /// Number of passes of the filter in a step of length dt, in units of Δx/c_P.
    pub(super) fn passes(dt: f64) -> usize {
        (dt / Self::FILTER_INTERVAL).ceil().max(1.0) as usize
    }

    /// σ of the cells of a layer, relative to c_P/Δx.
    pub fn profile(&self, cells: usize) -> Vec<f64> {
        let depth = |n: usize| (n as f64 + 0.5) / cells as f64;
        (0..cells)
            .map(|n| self.stretching * depth(n).powi(2))
            .collect()
    }

    /// g of a node at a depth of a layer, relative to c_P/Δx.
    pub fn filter_at(&self, depth: isize, cells: usize) -> f64 {
        self.filter * (depth.max(0) as f64 / cells as f64).powi(2)
    }
}

impl OpenSides {
    /// The least number of cells of a layer.
    pub const LEAST: usize = 8;
    /// The largest number of cells of a layer.
    pub const MOST: usize = 64;

    /// Opens a side with a layer of some cells.
    pub fn open(&mut self, face: Face, cells: usize) {
        if let Some(ends) = self.cells.get_mut(face.axis) {
            ends[usize::from(face.upper)] = Some(cells);
        }
    }

    /// The open sides with the cells of their layers.
    pub fn open_sides(&self) -> impl Iterator<Item = (Face, usize)> + '_ {
        let all = (0..2).flat_map(|axis| [false, true].map(|upper| Face { axis, upper }));
        all.filter_map(|face| Some((face, self.cells[face.axis][usize::from(face.upper)]?)))
    }

    /// Returns the points in the layers and at most `margin` nodes before them, in ascending order; empty without a
    /// lattice.
    pub fn points(&self, cloud: &PointCloud, margin: usize) -> Vec<u32> {
        let Some(lattice) = cloud.lattice() else {
            return Vec::new();
        };
        let lines = self.lines([lattice.shape[0], lattice.shape[1]]);
        let columns = lattice.shape[0];
        let inside = |node: u32| {
            let node = [node as usize % columns, node as usize / columns];
            (0..2).any(|axis| lines[axis].is_near(node[axis], margin))
        };
        let points = (0u32..).zip(&lattice.node);
        points
            .filter(|&(_, &node)| inside(node))
            .map(|(point, _)| point)
            .collect()
    }

    /// Number of points of the whole body in the layers: those whose motion is stretched and filtered.
    pub fn layer_points(&self, cloud: &PointCloud) -> usize {
        let shape = cloud
            .lattice()
            .map_or([0; 2], |lattice| [lattice.shape[0], lattice.shape[1]]);
        let layers = self
            .cells
            .map(|cells| cells.iter().flatten().sum::<usize>());
        let inner = (0..2).map(|axis| shape[axis].saturating_sub(layers[axis]));
        shape[0] * shape[1] - inner.product::<usize>()
    }

    pub(super) fn lines(&self, shape: [usize; 2]) -> [Line; 2] {
        [0, 1].map(|axis| Line {
            nodes: shape[axis],
            ends: self.cells[axis].map(|cells| match cells {
                Some(cells) => End::Open(cells),
                None if self.periodic[axis] => End::Periodic,
                None => End::Free,
            }),
        })
    }

    /// Checks sides, cells and the room between the layers for bonds of a reach.
    pub(super) fn check(&self, shape: [usize; 2], reach: usize) -> Result<(), OpenError> {
        let least = Self::LEAST.max(reach);
        for (face, cells) in self.open_sides() {
            let side = face;
            let across = 1 - face.axis;
            if self.cells[across] == [None; 2] && !self.periodic[across] {
                let across = ['x', 'y'][across];
                return Err(OpenError::Guided { side, across });
            }
            if self.periodic[face.axis] && self.cells[face.axis].contains(&None) {
                return Err(OpenError::Periodic { side });
            }
            if !(least..=Self::MOST).contains(&cells) {
                return Err(OpenError::Cells {
                    side,
                    cells,
                    least,
                    most: Self::MOST,
                });
            }
        }
        for axis in 0..2 {
            let open = self.cells[axis].iter().flatten();
            let layers: usize = open.sum();
            let least = layers + 2 * reach + 1;
            if shape[axis] < least {
                return Err(OpenError::NoRoom {
                    axis: ['x', 'y'][axis],
                    nodes: shape[axis],
                    layers,
                    least,
                });
            }
        }
        Ok(())
    }
}
