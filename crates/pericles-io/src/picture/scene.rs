//! What the pictures of plane bodies and of solids have in common.

use super::bitmap::Rgb;
use super::frame::{ColourBar, Header};

/// Where a cell is drawn, its half edges, and its colour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drawn {
    pub(super) middle: [f64; 3],
    pub(super) half: [f64; 3],
    pub(super) colour: Rgb,
}

/// A triangle of a surface as it is drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facet {
    pub(super) corners: [[f64; 3]; 3],
    /// Sums of the normals of the triangles that meet in each corner.
    pub(super) normals: [[f64; 3]; 3],
    pub(super) values: [f64; 3],
}

/// The cells or triangles of a body with what stands around them.
#[derive(Debug)]
pub(super) struct Scene {
    pub(super) width: usize,
    pub(super) cells: Vec<Drawn>,
    /// Triangles in place of cells.
    pub(super) facets: Vec<Facet>,
    /// Opposite corners of the part that is shown.
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
    /// Whether these corners were asked for: they then are not drawn together to what is there.
    pub(super) window: bool,
    pub(super) bar: ColourBar,
    pub(super) header: Header,
    /// The unit of lengths; empty for pure numbers.
    pub(super) length_unit: &'static str,
    pub(super) view: [f64; 3],
}
