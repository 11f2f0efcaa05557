//! Cells between points.

/// The cell type of a single point in VTK.
const VTK_VERTEX: u8 = 1;
/// That of a triangle.
const VTK_TRIANGLE: u8 = 5;

/// Cells of several kinds between points.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct VtuCells {
    pub(super) corners: Vec<u32>,
    ends: Vec<u64>,
    types: Vec<u8>,
}

impl VtuCells {
    /// Adds a cell: its type in VTK, such as 10 of tetrahedra and 12 of hexahedra, and its corners, numbers of points from 0.
    pub fn push(&mut self, vtk_type: u8, corners: &[u32]) {
        self.corners.extend_from_slice(corners);
        self.ends.push(self.corners.len() as u64);
        self.types.push(vtk_type);
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.types.len()
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

    /// The number of corners of the first cells.
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

    /// The k-th corner of all cells one after the other.
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
