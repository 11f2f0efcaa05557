//! Data shared by the pictures of plane bodies and solids.

use super::bitmap::Rgb;
use super::frame::{ColourBar, Header};
use super::polygon::Coloured;
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
    /// Points without a cell of a mesh.
    pub(super) cells: Vec<Drawn>,
    /// Cells of a plane body, faces of a solid.
    pub(super) polygons: Vec<Coloured>,
    /// Triangles of a surface, drawn instead of cells.
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
    /// Lines on the body, m.
    pub(super) lines: Vec<Vec<[f64; 3]>>,
    /// Triangles of rigid bodies in space, m.
    pub(super) rigid: Vec<[[f64; 3]; 3]>,
}

impl Scene {
    /// Returns whether nothing of the body is drawn.
    pub(super) fn is_empty(&self) -> bool {
        self.cells.is_empty() && self.polygons.is_empty() && self.facets.is_empty()
    }

    /// Returns the corners of everything that is drawn, m.
    pub(super) fn corners(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let boxes = self.cells.iter().flat_map(|cell| {
            (0..8).map(|corner| {
                std::array::from_fn(|c| match corner >> c & 1 {
                    0 => cell.middle[c] - cell.half[c],
                    _ => cell.middle[c] + cell.half[c],
                })
            })
        });
        let polygons = self.polygons.iter().flat_map(|polygon| polygon.corners);
        let facets = self.facets.iter().flat_map(|facet| facet.corners);
        let rigid = self.rigid.iter().flatten().copied();
        boxes.chain(polygons).chain(facets).chain(rigid)
    }
}
