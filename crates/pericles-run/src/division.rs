//! Division of a body among processes.

use pericles::PericlesError;
use pericles::division::{Cuts, Points, bisect};
use pericles::domain::Alone;
use pericles::space::PointCloud;

/// Returns where the cuts between the parts of a body lie: lattices are divided into boxes, which keep the rows of the stencil
/// whole; other points into parts of equal size.
pub fn cuts_of(cloud: &PointCloud) -> Cuts {
    match cloud.lattice() {
        Some(_) => Cuts::Planes,
        None => Cuts::Anywhere,
    }
}

/// Returns the process that owns each point of a body.
///
/// # Errors
/// None at present; weights of points may require a search for neighbours within `reach` (m).
pub fn owners(
    cloud: &PointCloud,
    _reach: f64,
    processes: usize,
) -> Result<Vec<u32>, PericlesError> {
    let numbers: Vec<u32> = (0..cloud.len() as u32).collect();
    let points = Points {
        dimension: cloud.dimension(),
        positions: cloud.positions(),
        numbers: &numbers,
        weights: &[],
    };
    Ok(bisect(&Alone, &points, processes, cuts_of(cloud)).owners(&points))
}
