//! Closed surfaces and outlines with holes.

use pericles::space::Region;
use pericles_mesh::fill::{
    FillError, Filled, Lattice, Outline, PartialCells, TriangleSurface, WindingTree, fill,
    fill_nodes, fill_open, fill_open_nodes, fill_open_partially, fill_partially,
};

/// A boundary to be filled.
pub(super) enum Enclosure {
    Surface(TriangleSurface),
    Open(TriangleSurface),
    Outline(Outline),
}

impl Enclosure {
    pub(super) fn bounds(&self) -> [[f64; 3]; 2] {
        match self {
            Self::Surface(surface) | Self::Open(surface) => surface.bounds(),
            Self::Outline(outline) => outline.bounds(),
        }
    }

    /// Returns the enclosed volume, or area of an outline; `None` for an open surface.
    pub(super) fn enclosed(&self) -> Option<f64> {
        match self {
            Self::Surface(surface) => Some(surface.signed_volume().abs()),
            Self::Open(_) => None,
            Self::Outline(outline) => Some(outline.area()),
        }
    }

    pub(super) fn fill(&self, spacing: f64) -> Result<Filled, FillError> {
        match self {
            Self::Surface(surface) => fill(surface, [spacing; 3]),
            Self::Open(surface) => fill_open(surface, [spacing; 3]),
            Self::Outline(outline) => outline.fill([spacing; 2]),
        }
    }

    /// Returns the cells of a lattice whose centres are inside; the lattice need not cover the whole interior.
    pub(super) fn fill_nodes(&self, lattice: Lattice) -> Result<Filled, FillError> {
        match self {
            Self::Surface(surface) => fill_nodes(surface, lattice),
            Self::Open(surface) => {
                let tree = WindingTree::new(surface);
                Ok(fill_open_nodes(surface, &tree, lattice))
            }
            Self::Outline(outline) => Ok(outline.fill_nodes(lattice)),
        }
    }

    pub(super) fn fill_partially(&self, spacing: f64) -> Result<PartialCells, FillError> {
        match self {
            Self::Surface(surface) => fill_partially(surface, [spacing; 3]),
            Self::Open(surface) => fill_open_partially(surface, [spacing; 3]),
            Self::Outline(outline) => outline.fill_partially([spacing; 2]),
        }
    }

    /// Returns a predicate whether a position is inside.
    pub(super) fn inside(&self) -> Box<dyn Fn([f64; 3]) -> bool + Sync + '_> {
        match self {
            Self::Surface(surface) | Self::Open(surface) => {
                let sign = surface.signed_volume().signum();
                let tree = WindingTree::new(surface);
                Box::new(move |x| sign * tree.winding_number(x) > 0.5)
            }
            Self::Outline(outline) => Box::new(|[x, y, _]| outline.contains([x, y])),
        }
    }
}

/// The holes of a body within its bounding box.
pub(super) struct Holes<'a> {
    pub(super) regions: &'a [Region],
    pub(super) bounds: [[f64; 3]; 2],
    pub(super) tolerance: f64,
}

impl Holes<'_> {
    pub(super) fn contain(&self, place: [f64; 3]) -> bool {
        self.regions.iter().any(|hole| self.is_in(hole, place))
    }

    /// Returns whether a position is in a region.
    pub(super) fn is_in(&self, region: &Region, place: [f64; 3]) -> bool {
        region.contains(place, &self.bounds, self.tolerance)
    }
}
