//! Lattices in closed surfaces and outlines.
//!
//! | what | function |
//! |---|---|
//! | nodes of a lattice inside a closed surface, exactly | [`fill`] |
//! | the same of a surface with holes, by the winding number | [`fill_open`] |
//! | the same for a given lattice, such as that of smaller cells in a part of the body | [`fill_nodes`], [`fill_open_nodes`], [`Outline::fill_nodes`] |
//! | parts of cells, for cells on the boundary | [`fill_partially`], [`fill_open_partially`] |
//! | nodes of a plane lattice inside polygons | [`Outline::fill`] |
//! | parts of plane cells | [`Outline::fill_partially`] |
//!
//! Results do not depend on the number of threads.

mod columns;
mod lattice;
mod open_parts;
mod outline;
mod partial;
mod rows;
mod surface;
mod winding;

pub use columns::{fill, fill_nodes};
pub use lattice::{Filled, Lattice};
pub use open_parts::fill_open_partially;
pub use outline::Outline;
pub use partial::{PartialCells, fill_partially};
pub use surface::TriangleSurface;
pub use winding::{WindingTree, fill_open, fill_open_nodes};

/// Why a surface or an outline cannot be filled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FillError {
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} (from 0) has the coordinate {value}; it must be a finite number")]
    NotFinite {
        /// The vertex, from 0.
        vertex: usize,
        /// The coordinate.
        value: f64,
    },
    /// A corner of a triangle is no vertex.
    #[error(
        "triangle {triangle} has the corner {corner}; there are {vertices} vertices, numbered from 0"
    )]
    NoSuchVertex {
        /// The triangle, from 0.
        triangle: usize,
        /// The corner.
        corner: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// There is nothing to fill.
    #[error("the surface has no triangles")]
    Empty,
    /// A polygon of an outline with too few corners.
    #[error("polygon {polygon} of the outline has {corners} corner(s); at least 3 are needed")]
    FewCorners {
        /// The polygon, from 0.
        polygon: usize,
        /// The number of its corners.
        corners: usize,
    },
    /// A spacing that is no positive number.
    #[error("the spacing is {value}; it must be a positive number")]
    Spacing {
        /// The spacing.
        value: f64,
    },
    /// A displacement of nodes that is too large.
    #[error("the amplitude is {value} spacings; allowed: from 0 to below 0.5")]
    Amplitude {
        /// The amplitude, in spacings.
        value: f64,
    },
    /// More nodes than there may be.
    #[error(
        "the lattice would have {nodes:.3e} nodes; at most {most:.3e} are possible. Use a larger spacing"
    )]
    TooMany {
        /// The number of nodes in the box.
        nodes: f64,
        /// The largest number.
        most: f64,
    },
    /// Lines through the surface that enter it more often than they leave it, or the reverse.
    #[error(
        "the surface is open: {columns} of {all} lines along z leave it more or less often than they enter it, one of them at {}. Close the surface, or fill it by the winding number",
        crate::digits::place(*at)
    )]
    Open {
        /// The number of these lines.
        columns: usize,
        /// The number of all lines.
        all: usize,
        /// x and y of one of them, m.
        at: [f64; 2],
    },
}
