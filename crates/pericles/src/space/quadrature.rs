//! Bars with Gauss points.

use super::PointCloud;
use super::cell_count::whole_cells;
use crate::error::{PericlesError, Result};

/// Makes a bar with the two Gauss–Legendre nodes of every cell, at ± spacing/(2√3) from its centre, each with half
/// the volume of the cell. The integral over neighbours is of fourth order for smooth integrands; weights are
/// equal, so that the stiffness is symmetric.
///
/// Nodes 2i and 2i+1 lie in cell i. They do not form a lattice.
///
/// # Errors
/// A length that is not a whole number of cells.
pub fn gauss_bar(origin: f64, length: f64, spacing: f64, section: f64) -> Result<PointCloud> {
    let cells = whole_cells(length, spacing)?;
    const LIMIT: u64 = u32::MAX as u64 / 2 - 1;
    if cells > LIMIT as f64 {
        return Err(PericlesError::TooManyPoints {
            cells,
            limit: LIMIT,
        });
    }
    let away = 0.5 * spacing / 3.0f64.sqrt();
    let positions: Vec<f64> = (0..2 * cells as usize)
        .map(|k| {
            let middle = origin + ((k / 2) as f64 + 0.5) * spacing;
            if k % 2 == 0 {
                middle - away
            } else {
                middle + away
            }
        })
        .collect();
    let volumes = vec![0.5 * spacing * section; positions.len()];
    PointCloud::new(1, positions, volumes, section)
}
