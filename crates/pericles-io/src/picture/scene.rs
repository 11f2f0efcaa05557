//! Data shared by the pictures of plane bodies and solids.

use super::bitmap::Rgb;
use super::frame::{ColourBar, Header};
use super::style::PictureStyle;

/// A cell to draw: position, half edges and colour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drawn {
    pub(super) middle: [f64; 3],
    pub(super) half: [f64; 3],
    pub(super) colour: Rgb,
}

/// A triangle of a surface to draw.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facet {
    pub(super) corners: [[f64; 3]; 3],
    /// Sums of the normals of the triangles that share each corner.
    pub(super) normals: [[f64; 3]; 3],
    pub(super) values: [f64; 3],
}

/// The cells or triangles of a body with title, time and colour bar.
#[derive(Debug)]
pub(super) struct Scene {
    pub(super) style: PictureStyle,
    /// Whether the body is a bar, whose height has no meaning.
    pub(super) is_strip: bool,
    pub(super) cells: Vec<Drawn>,
    /// Triangles, drawn instead of cells.
    pub(super) facets: Vec<Facet>,
    /// Opposite corners of the region shown.
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
    /// Whether the region was set explicitly; otherwise it is reduced to the visible content.
    pub(super) window: bool,
    pub(super) bar: ColourBar,
    pub(super) header: Header,
    /// Length unit; empty for dimensionless lengths.
    pub(super) length_unit: &'static str,
    pub(super) view: [f64; 3],
    /// Lines on a plane body, m.
    pub(super) lines: Vec<Vec<[f64; 2]>>,
    /// Triangles of rigid bodies in space, m.
    pub(super) rigid: Vec<[[f64; 3]; 3]>,
}
