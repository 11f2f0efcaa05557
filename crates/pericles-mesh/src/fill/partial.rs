//! Volume fractions of cells inside a closed surface.

use rayon::prelude::*;

use super::FillError;
use super::columns::crossing_height;
use super::lattice::Lattice;
use super::rows::Rows;
use super::surface::TriangleSurface;

/// Number of lines through a cell along x and along y.
const LINES: usize = 4;

/// Cells below this fraction distribute their volume among their nearest neighbours.
const LEAST: f64 = 0.1;

/// Cells of a lattice with their volume fractions inside a surface or an outline.
#[derive(Debug, Clone, PartialEq)]
pub struct PartialCells {
    /// The lattice.
    pub lattice: Lattice,
    /// The cells; x varies fastest, then y, then z.
    pub cells: Vec<[usize; 3]>,
    /// Volume fraction of each cell; above 1 where the volume of a neighbour was added.
    pub parts: Vec<f64>,
}

/// Finds the cells of a lattice that are at least partly inside a closed surface: along 4 × 4 lines through
/// each cell the length inside is exact up to rounding. A cell with a fraction below 0.1 distributes its
/// volume equally among its nearest neighbours above 0.1.
///
/// # Errors
/// The same as for [`fill`](super::fill).
pub fn fill_partially(
    surface: &TriangleSurface,
    spacing: [f64; 3],
) -> Result<PartialCells, FillError> {
    let lattice = Lattice::around(surface.bounds(), spacing)?;
    let rows = Rows::new(surface, lattice.divided(LINES));
    let outward = if surface.signed_volume() < 0.0 { -1 } else { 1 };
    let [nx, _, nz] = lattice.counts;
    let mut parts = vec![0.0; lattice.len()];
    let open: Vec<Vec<[f64; 2]>> = parts
        .par_chunks_mut(nx * nz)
        .enumerate()
        .map(|(row, parts)| {
            let lines = (0..LINES).flat_map(|line| {
                let row = LINES * row + line;
                fill_lines(&rows, row, outward, &lattice, parts)
            });
            lines.collect()
        })
        .collect();
    let columns = open.iter().map(Vec::len).sum();
    if let Some(&at) = open.iter().flatten().next() {
        let all = rows.lattice.counts[0] * rows.lattice.counts[1];
        let edges = surface.unmatched_edges();
        return Err(FillError::Open {
            columns,
            all,
            edges,
            at,
        });
    }
    Ok(gathered(lattice, &parts))
}

/// Adds the lengths of a row of lines to the volume fractions of the cells; returns the positions of lines
/// through open parts of the surface.
fn fill_lines(
    rows: &Rows<'_>,
    row: usize,
    outward: i32,
    lattice: &Lattice,
    parts: &mut [f64],
) -> Vec<[f64; 2]> {
    let y = rows.lattice.coordinate(1, row);
    let mut crossings: Vec<(usize, f64, i32)> = Vec::new();
    rows.crossings(row, |line, corners, up| {
        let height = crossing_height(corners, rows.lattice.coordinate(0, line), y);
        // Rounding must not lead outside the triangle.
        let z = corners.map(|corner| corner[2]);
        let (low, high) = (z[0].min(z[1]).min(z[2]), z[0].max(z[1]).max(z[2]));
        let height = if height.is_nan() {
            low
        } else {
            height.clamp(low, high)
        };
        crossings.push((line, height, up * outward));
    });
    // From above; at equal heights, entering crossings come first.
    crossings.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)).then(b.2.cmp(&a.2)));
    let nz = lattice.counts[2];
    let mut open = Vec::new();
    for of_line in crossings.chunk_by(|a, b| a.0 == b.0) {
        let line = of_line[0].0;
        let column = line / LINES;
        let cells = &mut parts[column * nz..(column + 1) * nz];
        let mut winding = 0;
        let mut top = 0.0;
        for &(_, z, step) in of_line {
            if winding >= 1 {
                add_length(lattice, cells, z, top);
            }
            winding += step;
            top = z;
        }
        if winding != 0 {
            open.push([rows.lattice.coordinate(0, line), y]);
        }
    }
    open
}

/// Adds the part of the interval from low to high in each cell of a column.
fn add_length(lattice: &Lattice, cells: &mut [f64], low: f64, high: f64) {
    let share = 1.0 / (LINES * LINES) as f64;
    let spacing = lattice.spacing[2];
    for k in lattice.range(2, low, high) {
        let centre = lattice.coordinate(2, k);
        let (bottom, top) = (centre - 0.5 * spacing, centre + 0.5 * spacing);
        let length = (high.min(top) - low.max(bottom)).max(0.0);
        cells[k] += share * (length / spacing);
    }
}

/// Returns the retained cells, including the volume of the cells removed.
pub(super) fn gathered(lattice: Lattice, parts: &[f64]) -> PartialCells {
    let [nx, ny, nz] = lattice.counts;
    let place = |[i, j, k]: [usize; 3]| (j * nx + i) * nz + k;
    let cells = || {
        let rows = (0..nz).flat_map(move |k| (0..ny).map(move |j| (j, k)));
        rows.flat_map(move |(j, k)| (0..nx).map(move |i| [i, j, k]))
    };
    let mut kept = parts.to_vec();
    for cell in cells().filter(|&cell| (0.0..LEAST).contains(&parts[place(cell)])) {
        let part = parts[place(cell)];
        let nearest = match part > 0.0 {
            true => nearest_kept(&lattice, cell, |other| parts[place(other)] >= LEAST),
            false => Vec::new(),
        };
        // A small fraction without retained neighbours, in a very thin body, is kept.
        if !nearest.is_empty() {
            kept[place(cell)] = 0.0;
        }
        for &other in &nearest {
            kept[place(other)] += part / nearest.len() as f64;
        }
    }
    let cells: Vec<[usize; 3]> = cells().filter(|&cell| kept[place(cell)] > 0.0).collect();
    let parts = cells.iter().map(|&cell| kept[place(cell)]).collect();
    PartialCells {
        lattice,
        cells,
        parts,
    }
}

/// Returns the nearest of the 26 neighbours that are retained, including ties.
fn nearest_kept(
    lattice: &Lattice,
    cell: [usize; 3],
    is_kept: impl Fn([usize; 3]) -> bool,
) -> Vec<[usize; 3]> {
    let mut nearest = Vec::new();
    let mut least = f64::INFINITY;
    let range = |c: usize| {
        let begin = cell[c].saturating_sub(1);
        begin..(cell[c] + 2).min(lattice.counts[c])
    };
    for k in range(2) {
        for j in range(1) {
            for i in range(0) {
                let other = [i, j, k];
                if other == cell || !is_kept(other) {
                    continue;
                }
                let steps = (0..3).filter(|&c| other[c] != cell[c]);
                let distance = steps.map(|c| lattice.spacing[c].powi(2)).sum::<f64>();
                if distance < least {
                    least = distance;
                    nearest.clear();
                }
                if distance == least {
                    nearest.push(other);
                }
            }
        }
    }
    nearest
}
