//! Volume fractions of cells inside a surface with holes.

use rayon::prelude::*;

use super::FillError;
use super::lattice::{Filled, Lattice};
use super::partial::{PartialCells, gathered};
use super::surface::TriangleSurface;
use super::winding::{WindingTree, fill_open_nodes};

/// Samples of a cell along each axis.
const SAMPLES: usize = 4;

/// Finds the cells of a lattice that are at least partly inside a surface with holes. The volume fraction of
/// a cell is the share of 4 × 4 × 4 samples with a winding number above ½, a multiple of 1/64. Only cells that may
/// intersect a triangle, and those with a neighbour on the other side, are sampled; the others are full or
/// empty. A cell with a fraction below 0.1 distributes its volume equally among its nearest neighbours above
/// 0.1.
///
/// # Errors
/// Returns an error for a lattice with too many nodes.
pub fn fill_open_partially(
    surface: &TriangleSurface,
    spacing: [f64; 3],
) -> Result<PartialCells, FillError> {
    let tree = WindingTree::new(surface);
    let lattice = Lattice::around(surface.bounds(), spacing)?;
    let filled = fill_open_nodes(surface, &tree, lattice);
    let outward = if filled.was_turned() { -1.0 } else { 1.0 };
    let mut is_sampled = cells_at_triangles(surface, &lattice);
    mark_sides(&filled, &mut is_sampled);
    let [nx, _, nz] = lattice.counts;
    let mut parts = vec![0.0; lattice.len()];
    parts
        .par_chunks_mut(nz)
        .enumerate()
        .for_each(|(column, parts)| {
            for (k, part) in parts.iter_mut().enumerate() {
                let cell = [column % nx, column / nx, k];
                *part = match is_sampled[column * nz + k] {
                    true => sampled(&tree, outward, &lattice, cell),
                    false if filled.contains(cell) => 1.0,
                    false => 0.0,
                };
            }
        });
    Ok(gathered(lattice, &parts))
}

/// Returns the fraction of the samples of a cell that are inside.
fn sampled(tree: &WindingTree, outward: f64, lattice: &Lattice, cell: [usize; 3]) -> f64 {
    let centre = lattice.position(cell);
    let offset = |sample: usize| (sample as f64 + 0.5) / SAMPLES as f64 - 0.5;
    let all = SAMPLES.pow(3);
    let is_inside = |&sample: &usize| {
        let at = [
            sample % SAMPLES,
            sample / SAMPLES % SAMPLES,
            sample / (SAMPLES * SAMPLES),
        ];
        let place = std::array::from_fn(|c| centre[c] + offset(at[c]) * lattice.spacing[c]);
        outward * tree.winding_number(place) > 0.5
    };
    (0..all).filter(is_inside).count() as f64 / all as f64
}

/// Marks the cells that intersect the bounding box of a triangle; columns along z.
fn cells_at_triangles(surface: &TriangleSurface, lattice: &Lattice) -> Vec<bool> {
    let [nx, _, nz] = lattice.counts;
    let mut meets = vec![false; lattice.len()];
    for triangle in 0..surface.len() {
        let corners = surface.corners(triangle);
        let ranges: [_; 3] = std::array::from_fn(|c| {
            let x = corners.map(|corner| corner[c]);
            let (low, high) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
            // The range is extended by one cell on both sides.
            lattice.range(c, low, high)
        });
        for j in ranges[1].clone() {
            for i in ranges[0].clone() {
                let column = (j * nx + i) * nz;
                meets[column + ranges[2].start..column + ranges[2].end].fill(true);
            }
        }
    }
    meets
}

/// Marks the cells that have a neighbour on the other side: at holes of the surface no triangle is near.
fn mark_sides(filled: &Filled, is_marked: &mut [bool]) {
    let [nx, ny, nz] = filled.lattice().counts;
    let place = |[i, j, k]: [usize; 3]| (j * nx + i) * nz + k;
    for j in 0..ny {
        for i in 0..nx {
            for k in 0..nz {
                let cell = [i, j, k];
                let counts = [nx, ny, nz];
                for c in (0..3).filter(|&c| cell[c] + 1 < counts[c]) {
                    let mut next = cell;
                    next[c] += 1;
                    if filled.contains(cell) != filled.contains(next) {
                        is_marked[place(cell)] = true;
                        is_marked[place(next)] = true;
                    }
                }
            }
        }
    }
}
