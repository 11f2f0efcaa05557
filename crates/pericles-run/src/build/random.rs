//! Points with random positions.

use pericles::space::{Grid, ListedPoints, PointCloud};
use pericles_deck::Positions;
use pericles_mesh::fill::{FillError, Lattice};
use pericles_mesh::random::{Inside, blue_noise, jittered, nearest_volumes};

/// A region to be filled with points.
pub(super) struct Space<'a> {
    pub(super) dimension: usize,
    /// Bounding box, m.
    pub(super) bounds: [[f64; 3]; 2],
    /// Mean distance of the points, m.
    pub(super) spacing: f64,
    /// Area of a bar (m²), thickness of a body in two dimensions (m), 1 in three dimensions.
    pub(super) section: f64,
    pub(super) inside: &'a Inside<'a>,
}

/// Nodes of a lattice.
pub(super) type Nodes = (Lattice, Vec<[usize; 3]>);

impl Space<'_> {
    /// Creates random points in the body. Jittered nodes keep the volumes of their cells; points of blue noise have
    /// the volume of their Voronoi cells.
    pub(super) fn points(
        &self,
        positions: Positions,
        nodes: impl FnOnce() -> Nodes,
    ) -> Result<ListedPoints, FillError> {
        let Self {
            dimension,
            bounds,
            spacing,
            section,
            inside,
        } = *self;
        let cell = section * spacing.powi(dimension as i32);
        let (positions, volumes) = match positions {
            Positions::Lattice => {
                let (lattice, nodes) = nodes();
                let places = nodes.iter().map(|&node| lattice.position(node));
                (places.collect(), vec![cell; nodes.len()])
            }
            Positions::Jittered { jitter, seed } => {
                let (lattice, nodes) = nodes();
                let places = jittered(&lattice, &nodes, dimension, jitter, seed, inside)?;
                (places, vec![cell; nodes.len()])
            }
            Positions::BlueNoise { seed } => {
                let places = blue_noise(bounds, dimension, spacing, seed, inside)?;
                let mut volumes = nearest_volumes(&places, bounds, dimension, spacing, inside)?;
                volumes.iter_mut().for_each(|volume| *volume *= section);
                (places, volumes)
            }
        };
        let blocks = vec![1; positions.len()];
        Ok(ListedPoints {
            positions,
            blocks,
            volumes,
        })
    }
}

/// Returns the nodes of a grid for the points of a cloud.
pub(super) fn nodes_of(grid: &Grid, cloud: &PointCloud) -> Option<Nodes> {
    let lattice = cloud.lattice()?;
    let coordinates = |node: u32| lattice.coordinates(node).map(|c| c as usize);
    let first = coordinates(*lattice.node.first()?);
    let place = cloud.point(0);
    let counts = lattice.shape;
    // Node i of n is at centre + (2 i − n + 1) spacing / 2.
    let centre = |c: usize| {
        let steps = 2.0 * first[c] as f64 - (counts[c] as f64 - 1.0);
        place[c] - steps * (0.5 * grid.spacing)
    };
    let nodes = lattice.node.iter().map(|&node| coordinates(node)).collect();
    let lattice = Lattice {
        centre: std::array::from_fn(centre),
        spacing: [grid.spacing; 3],
        counts,
    };
    Some((lattice, nodes))
}
