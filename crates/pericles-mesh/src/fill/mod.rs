//! Lattices in closed surfaces and outlines.
//!
//! | result | function |
//! |---|---|
//! | nodes of a lattice inside a closed surface, exactly | [`fill`] |
//! | nodes inside a surface with holes, by the winding number | [`fill_open`] |
//! | nodes of a given lattice, such as smaller cells in a region of the body | [`fill_nodes`], [`fill_open_nodes`], [`Outline::fill_nodes`] |
//! | volume fractions of cells, for cells on the boundary | [`fill_partially`], [`fill_open_partially`] |
//! | nodes of a plane lattice inside polygons | [`Outline::fill`] |
//! | area fractions of plane cells | [`Outline::fill_partially`] |
//!
//! Results do not depend on the number of threads.

mod columns;
mod lattice;
mod open_parts;
mod orientation;
mod outline;
mod partial;
mod rows;
mod surface;
mod winding;

pub use columns::{fill, fill_nodes};
pub use lattice::{Filled, Lattice};
pub use open_parts::fill_open_partially;
pub use orientation::Reversed;
pub use outline::Outline;
pub use partial::{PartialCells, fill_partially};
pub use surface::TriangleSurface;
pub use winding::{WindingTree, fill_open, fill_open_nodes};

/// Errors of filling a surface or an outline.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FillError {
    /// A coordinate that is NaN or infinite.
    #[error("vertex {vertex} (from 0) has the coordinate {value}; it must be a finite number")]
    NotFinite {
        /// The vertex, from 0.
        vertex: usize,
        /// The coordinate.
        value: f64,
    },
    /// A corner that is not the number of a vertex.
    #[error(
        "triangle {triangle} refers to vertex {corner}; there are only {vertices} vertices, numbered from 0"
    )]
    NoSuchVertex {
        /// The triangle, from 0.
        triangle: usize,
        /// The invalid corner.
        corner: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// A surface without triangles.
    #[error("the surface has no triangles")]
    Empty,
    /// A polygon with fewer than three corners.
    #[error("polygon {polygon} of the outline has {corners} corner(s); at least 3 are required")]
    FewCorners {
        /// The polygon, from 0.
        polygon: usize,
        /// The number of its corners.
        corners: usize,
    },
    /// A spacing that is not a positive number.
    #[error("the spacing is {value}; it must be a positive number")]
    Spacing {
        /// The spacing.
        value: f64,
    },
    /// An amplitude of random displacements outside its range.
    #[error("the amplitude is {value} spacings; allowed: at least 0 and below 0.5")]
    Amplitude {
        /// The amplitude, in spacings.
        value: f64,
    },
    /// A lattice with too many nodes.
    #[error(
        "the lattice would have {nodes:.3e} nodes; allowed: at most {most:.3e}. Use a larger spacing"
    )]
    TooMany {
        /// The number of nodes in the box.
        nodes: f64,
        /// The maximum number.
        most: f64,
    },
    /// An open surface: lines along z do not enter and leave it equally often.
    #[error(
        "the surface is open: {columns} of {all} lines along z do not enter and leave it equally often, one of them at {}. Close the surface, which has {edges} triangle edges without a neighbour, or fill it by the winding number",
        crate::digits::place(*at)
    )]
    Open {
        /// The number of these lines.
        columns: usize,
        /// The number of all lines.
        all: usize,
        /// The number of triangle edges without an opposite one.
        edges: usize,
        /// x and y of one of them, m.
        at: [f64; 2],
    },
}
