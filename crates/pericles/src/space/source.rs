//! Bodies whose points can be created in parts.
//!
//! A process creates its own points only. To divide a body, every process passes over all nodes of the lattice three
//! times: for an equal share of the points, from which all processes find the cuts; for the points between the cuts
//! and those around them; and for the ghosts among these. This is fast, needs no memory for the whole body, and no
//! points are sent between processes. Points from files, meshes and filled shapes, several pieces and refined grids
//! are created whole on every process, divided in the same way, and released.

use std::sync::Arc;

use super::{Point, PointCloud};
use crate::domain::{Alone, Domain};

/// Points of a body that can be created in parts: a process creates its own ones.
pub trait PointSource {
    /// Number of points of the body.
    fn count(&self) -> usize;

    /// Creates the points for which `is_wanted` returns true; it receives number and position (m) of each point, in ascending order
    /// of the numbers. The points, of which there may be none, have their numbers in the body in
    /// [`PointCloud::domain`] and no ghosts.
    fn points_where(&self, is_wanted: &mut dyn FnMut(u32, Point) -> bool) -> PointCloud;
}

impl PointSource for PointCloud {
    fn count(&self) -> usize {
        self.len()
    }

    fn points_where(&self, is_wanted: &mut dyn FnMut(u32, Point) -> bool) -> PointCloud {
        let all = 0..self.len() as u32;
        let numbers: Vec<u32> = all
            .filter(|&i| is_wanted(i, self.point(i as usize)))
            .collect();
        let own = numbers.len();
        self.part(Domain::new(numbers, own, Vec::new(), Arc::new(Alone)))
    }
}
