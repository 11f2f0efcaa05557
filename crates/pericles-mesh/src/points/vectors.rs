//! Area vectors of face sets, for pressure loads.

use super::MeshPoints;
use crate::element::{cross, dot};
use crate::raw::RawMesh;
use std::collections::HashSet;

type Point = [f64; 3];

fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|c| a[c] - b[c])
}

fn mean(points: &[Point]) -> Point {
    std::array::from_fn(|c| points.iter().map(|x| x[c]).sum::<f64>() / points.len() as f64)
}

/// Returns the area times the normal of a face, ∫ n dA; for an edge in the plane, its length times the
/// normal. The direction follows from the order of the corners.
fn area_vector(corners: &[Point]) -> Point {
    match *corners {
        [a, b] => [b[1] - a[1], a[0] - b[0], 0.0],
        [a, b, c] => cross(minus(b, a), minus(c, a)).map(|x| 0.5 * x),
        [a, b, c, d] => cross(minus(c, a), minus(d, b)).map(|x| 0.5 * x),
        _ => [0.0; 3],
    }
}

impl MeshPoints {
    /// Returns ∫ n dA (m²) for each point of a face set, over the faces of the set that its element owns,
    /// with the outward normal n of the element; for edges, times the thickness (m). Returns `None` if there
    /// is no face set of this name. `mesh`, `unit` and `thickness` must be those from which the points were
    /// created.
    ///
    /// A pressure p exerts the force −p ∫ n dA on each point. The sum over a closed surface is zero; a face
    /// between two elements of the set counts for both, with opposite directions.
    pub fn face_vectors(
        &self,
        mesh: &RawMesh,
        unit: f64,
        thickness: f64,
        set: &str,
    ) -> Option<Vec<Point>> {
        let set = self.set(set).filter(|set| !set.faces.is_empty())?;
        let key = |corners: &mut dyn Iterator<Item = u32>| {
            let mut sorted: Vec<u32> = corners.collect();
            sorted.sort_unstable();
            sorted
        };
        let faces: HashSet<Vec<u32>> = set
            .faces
            .iter()
            .map(|(_, corners)| key(&mut corners.iter().copied()))
            .collect();
        let scale = match self.dimension {
            2 => unit * thickness,
            _ => unit * unit,
        };
        let vector = |&point: &u32| {
            let cell = self.cells[point as usize] as usize;
            let corners = mesh.cells.corners(cell);
            let centre = mean(&mesh.corner_positions(corners));
            let mut sum = [0.0; 3];
            for (_, places) in mesh.cells.kind(cell).facets() {
                let nodes: Vec<u32> = places.iter().map(|&place| corners[place]).collect();
                if !faces.contains(&key(&mut nodes.iter().copied())) {
                    continue;
                }
                let positions = mesh.corner_positions(&nodes);
                let vector = area_vector(&positions);
                let outward = dot(vector, minus(mean(&positions), centre)).signum();
                for c in 0..3 {
                    sum[c] += outward * vector[c] * scale;
                }
            }
            sum
        };
        Some(set.points.iter().map(vector).collect())
    }
}
