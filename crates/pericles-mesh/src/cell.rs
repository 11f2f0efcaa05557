//! Cell types with their corners and facets.
//!
//! Corners are numbered around the bottom, then around the top, as in Gmsh, Abaqus, Exodus and VTK. Facets
//! are numbered as the sides of Exodus II, from 0.

use std::fmt;

/// The type of a cell by its corners. Second-order cells belong to these types; their nodes on edges and
/// faces are not used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CellKind {
    /// One node.
    Point,
    /// A line between two nodes.
    Line,
    /// A triangle.
    Triangle,
    /// A quadrilateral.
    Quadrilateral,
    /// A tetrahedron.
    Tetrahedron,
    /// A pyramid over a quadrilateral.
    Pyramid,
    /// A wedge (triangular prism).
    Wedge,
    /// A hexahedron.
    Hexahedron,
}

use CellKind::{Hexahedron, Line, Point, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};

/// A facet of a cell type: its own type and its corners among those of the cell.
pub type Facet = (CellKind, &'static [usize]);

impl CellKind {
    /// All types, by ascending dimension.
    pub const ALL: [Self; 8] = [
        Point,
        Line,
        Triangle,
        Quadrilateral,
        Tetrahedron,
        Pyramid,
        Wedge,
        Hexahedron,
    ];

    /// Returns the number of this type in VTK.
    pub fn vtk(self) -> u8 {
        match self {
            Point => 1,
            Line => 3,
            Triangle => 5,
            Quadrilateral => 9,
            Tetrahedron => 10,
            Hexahedron => 12,
            Wedge => 13,
            Pyramid => 14,
        }
    }

    /// Returns the type of a number in VTK; `None` for others.
    pub fn of_vtk(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.vtk() == number)
    }

    /// Returns the name for `count` cells of this type: "triangle", "triangles".
    pub fn word(self, count: usize) -> &'static str {
        let [one, several] = match self {
            Point => ["point", "points"],
            Line => ["line", "lines"],
            Triangle => ["triangle", "triangles"],
            Quadrilateral => ["quadrilateral", "quadrilaterals"],
            Tetrahedron => ["tetrahedron", "tetrahedra"],
            Pyramid => ["pyramid", "pyramids"],
            Wedge => ["wedge", "wedges"],
            Hexahedron => ["hexahedron", "hexahedra"],
        };
        if count == 1 { one } else { several }
    }

    /// Returns the number of corners.
    pub fn corners(self) -> usize {
        match self {
            Point => 1,
            Line => 2,
            Triangle => 3,
            Quadrilateral | Tetrahedron => 4,
            Pyramid => 5,
            Wedge => 6,
            Hexahedron => 8,
        }
    }

    /// Returns the dimension, 0 for points to 3 for solids.
    pub fn dimension(self) -> usize {
        match self {
            Point => 0,
            Line => 1,
            Triangle | Quadrilateral => 2,
            Tetrahedron | Pyramid | Wedge | Hexahedron => 3,
        }
    }

    /// Returns the facets: faces of solids, edges of plane cells, ends of lines.
    pub fn facets(self) -> &'static [Facet] {
        match self {
            Point => &[],
            Line => &[(Point, &[0]), (Point, &[1])],
            Triangle => &[(Line, &[0, 1]), (Line, &[1, 2]), (Line, &[2, 0])],
            Quadrilateral => &[
                (Line, &[0, 1]),
                (Line, &[1, 2]),
                (Line, &[2, 3]),
                (Line, &[3, 0]),
            ],
            Tetrahedron => &[
                (Triangle, &[0, 1, 3]),
                (Triangle, &[1, 2, 3]),
                (Triangle, &[0, 3, 2]),
                (Triangle, &[0, 2, 1]),
            ],
            Pyramid => &[
                (Triangle, &[0, 1, 4]),
                (Triangle, &[1, 2, 4]),
                (Triangle, &[2, 3, 4]),
                (Triangle, &[0, 4, 3]),
                (Quadrilateral, &[0, 3, 2, 1]),
            ],
            Wedge => &[
                (Quadrilateral, &[0, 1, 4, 3]),
                (Quadrilateral, &[1, 2, 5, 4]),
                (Quadrilateral, &[0, 3, 5, 2]),
                (Triangle, &[0, 2, 1]),
                (Triangle, &[3, 4, 5]),
            ],
            Hexahedron => &[
                (Quadrilateral, &[0, 1, 5, 4]),
                (Quadrilateral, &[1, 2, 6, 5]),
                (Quadrilateral, &[2, 3, 7, 6]),
                (Quadrilateral, &[0, 4, 7, 3]),
                (Quadrilateral, &[0, 3, 2, 1]),
                (Quadrilateral, &[4, 5, 6, 7]),
            ],
        }
    }
}

impl fmt::Display for CellKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Point => "point",
            Line => "line",
            Triangle => "tri",
            Quadrilateral => "quad",
            Tetrahedron => "tet",
            Pyramid => "pyramid",
            Wedge => "wedge",
            Hexahedron => "hex",
        })
    }
}
