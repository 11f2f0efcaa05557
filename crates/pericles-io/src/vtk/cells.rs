//! Cells between points.

/// VTK cell type of a single point.
const VTK_VERTEX: u8 = 1;
/// VTK cell type of a triangle.
const VTK_TRIANGLE: u8 = 5;

/// Cells of several types between points.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct VtuCells {
    pub(super) corners: Vec<u32>,
    ends: Vec<u64>,
    types: Vec<u8>,
}

impl VtuCells {
    /// Adds a cell by its VTK type, such as 10 for tetrahedra and 12 for hexahedra, and its corners (point
    /// numbers from 0).
    pub fn push(&mut self, vtk_type: u8, corners: &[u32]) {
        self.corners.extend_from_slice(corners);
        self.ends.push(self.corners.len() as u64);
        self.types.push(vtk_type);
    }

    /// Returns the number of cells.
    pub fn len(&self) -> usize {
        self.types.len()
    }

    /// The corners of all cells, one cell after the other.
    pub fn corners(&self) -> &[u32] {
        &self.corners
    }

    /// The corners of one cell.
    pub fn corners_of(&self, cell: usize) -> &[u32] {
        let start = cell.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.corners[start as usize..self.ends[cell] as usize]
    }

    /// Returns VTK's type of a cell.
    pub(crate) fn vtk_type(&self, cell: usize) -> u8 {
        self.types[cell]
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.types.is_empty()
    }
}

/// The cells of a file.
pub(super) enum Cells<'a> {
    Vertices(usize),
    Triangles(&'a [[u32; 3]]),
    Mixed(&'a VtuCells),
}

impl Cells<'_> {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Vertices(points) => *points,
            Self::Triangles(triangles) => triangles.len(),
            Self::Mixed(cells) => cells.len(),
        }
    }

    /// Returns the number of corners of the first `cells` cells.
    pub(super) fn end(&self, cells: usize) -> usize {
        match self {
            Self::Vertices(_) => cells,
            Self::Triangles(_) => 3 * cells,
            Self::Mixed(mixed) => match cells {
                0 => 0,
                cells => mixed.ends[cells - 1] as usize,
            },
        }
    }

    /// Returns the k-th corner in the concatenated list of all cells.
    pub(super) fn corner(&self, k: usize) -> i64 {
        match self {
            Self::Vertices(_) => k as i64,
            Self::Triangles(triangles) => i64::from(triangles[k / 3][k % 3]),
            Self::Mixed(cells) => i64::from(cells.corners[k]),
        }
    }

    pub(super) fn vtk_type(&self, cell: usize) -> u8 {
        match self {
            Self::Vertices(_) => VTK_VERTEX,
            Self::Triangles(_) => VTK_TRIANGLE,
            Self::Mixed(cells) => cells.types[cell],
        }
    }
}
