//! Points and sets as plain data.

use std::sync::Arc;

use pericles::family::{Crack, EndRule};
use pericles::space::{PointCloud, PointSet};
use pericles_deck::{Body, BuildError, Fault, KeyPath, Model, ModelWarning};
use pericles_manifold::surface::Surface;

use super::mesh_body::Meshes;
use super::program::Conditions;
use super::rejection::at_path;

/// Named sets of points, each in ascending order.
pub type Sets = Vec<(String, PointSet)>;

/// The points of a model with their sets: plain arrays that a program may inspect, change or replace before
/// [`assemble`](crate::assemble).
#[derive(Debug, Clone)]
pub struct Discretisation {
    /// The points with their volumes; own points if the body is divided among several processes.
    pub cloud: Arc<PointCloud>,
    /// The grids of the points.
    pub grids: Grids,
    /// The surface, if the body is one; its vertices are the points.
    pub surface: Option<Arc<Surface>>,
    /// The meshes whose elements the points are.
    pub meshes: Arc<Meshes>,
    /// The sets of these points with their names: "all", the sets of a mesh, the sets of the deck.
    pub sets: Sets,
    /// The surfaces of the pre-cracks.
    pub cracks: Vec<(Crack, EndRule)>,
    /// Initial state, loads and motions that a program adds to those of the model.
    pub conditions: Conditions,
    /// Warnings about the points.
    pub warnings: Vec<ModelWarning>,
}

/// Returns whether the points of a body are the centres of boxes.
pub(crate) fn is_on_grid(model: &Model, cloud: &PointCloud) -> bool {
    let shape = model.body.solid().map(|solid| &solid.shape);
    cloud.cell_sides().is_some() || shape.is_some_and(|shape| shape.is_refined())
}

/// The grids of a body with refined parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grids {
    /// Refinement ratio of each grid: 1 for the whole body, then the ratios of the refined parts.
    pub ratios: Vec<u32>,
    /// The grid of each point, by its number in `ratios`.
    pub of_point: Vec<u8>,
}

impl Grids {
    /// Returns a single grid for `points` points.
    pub fn one(points: usize) -> Self {
        Self {
            ratios: vec![1],
            of_point: vec![0; points],
        }
    }
}

impl Discretisation {
    /// Returns the points of a set.
    pub fn set(&self, name: &str) -> Option<&PointSet> {
        let found = self.sets.iter().find(|(known, _)| known == name);
        found.map(|(_, points)| points)
    }

    /// Returns the points of a set for modification; they must stay in ascending order.
    pub fn set_mut(&mut self, name: &str) -> Option<&mut PointSet> {
        let found = self.sets.iter_mut().find(|(known, _)| known == name);
        found.map(|(_, points)| points)
    }

    /// Checks that points, grids and sets are consistent with each other and with the body. Results of [`discretise`]
    /// are; those changed by a program may not be.
    pub(super) fn check(&self, body: &Body) -> Result<(), BuildError> {
        let points = self.cloud.len();
        let reject =
            |keys: KeyPath, reason: String| Err(at_path(keys, Fault::BadDiscretisation { reason }));
        let (found, needed) = (self.cloud.dimension(), body.dimension());
        if found != needed {
            let reason = format!("the points have {found} dimensions, the body has {needed}");
            return reject("body".into(), reason);
        }
        let grids = &self.grids;
        let known = |&grid: &u8| usize::from(grid) < grids.ratios.len();
        if grids.of_point.len() != points || !grids.of_point.iter().all(known) {
            let reason = format!("the grids do not match the {points} points");
            return reject("body.refine".into(), reason);
        }
        if let Some(surface) = self.surface.as_ref().filter(|s| s.len() != points) {
            let reason = format!(
                "the surface has {} vertices, but there are {points} points",
                surface.len()
            );
            return reject("body".into(), reason);
        }
        for (name, set) in &self.sets {
            let rising = set.windows(2).all(|pair| pair[0] < pair[1]);
            if !rising || set.last().is_some_and(|&last| last as usize >= points) {
                let reason = format!(
                    "the set `{name}` does not contain points from 0 to {} in ascending order",
                    points.saturating_sub(1)
                );
                return reject(KeyPath::from("sets").key(name), reason);
            }
        }
        Ok(())
    }
}
