//! The shape of a body in its pictures.

use pericles::family::Crack;
use pericles::space::PointCloud;
use pericles_deck::Model;
use pericles_io::observers::{BodyShape, CellMesh};

use super::MOST_CELLS;
use crate::build::{Meshes, Sets, is_on_grid};

/// Returns the cells of a body and the lines on it for its pictures: pre-cracks, interfaces of materials, borders of
/// refined parts. Cells are the elements of meshes and the boxes of grids; other points, and large bodies, have none.
/// `None` for surfaces, and for points of which other processes have a part.
pub fn body_shape(
    model: &Model,
    cloud: &PointCloud,
    sets: &Sets,
    meshes: &Meshes,
    cracks: &[Crack],
) -> Option<BodyShape> {
    if cloud.domain().is_divided() || model.body.solid().is_none() {
        return None;
    }
    let is_on_grid = is_on_grid(model, cloud);
    let mesh = match (cloud.len() > MOST_CELLS, is_on_grid) {
        (true, _) => None,
        (false, true) => Some(CellMesh::of_boxes(cloud)),
        (false, false) => meshes.cells(),
    };
    let classes = match is_on_grid && cloud.dimension() == 2 {
        true => classes(model, cloud, sets),
        false => Vec::new(),
    };
    Some(BodyShape::new(cloud, mesh.as_ref(), cracks, &classes))
}

/// Returns a number for each point that differs between points of different material or cell size.
fn classes(model: &Model, cloud: &PointCloud, sets: &Sets) -> Vec<u32> {
    let ratio = |i: usize| (cloud.spacing() / cloud.cell_size(i)).round() as u32;
    let mut class: Vec<u32> = (0..cloud.len()).map(|i| 1000 * ratio(i)).collect();
    for (number, assignment) in model.assignments.iter().enumerate() {
        let is_assigned = |name: &String| assignment.sets.contains(name);
        for (_, points) in sets.iter().filter(|(name, _)| is_assigned(name)) {
            for &i in points {
                class[i as usize] = 1000 * ratio(i as usize) + number as u32 + 1;
            }
        }
    }
    class
}
