//! Nodes inside a closed surface, from the signed crossings of lines along z.
//!
//! All decisions are signs of determinants, computed exactly (Shewchuk 1997). A node stands for the point
//! (x + ε, y + ε², z + ε³): if a surface passes through a node, the node is inside exactly one of two bodies
//! that share the surface. Counts are integers, so that the result does not depend on threads.

use rayon::prelude::*;
use robust::{Coord3D, orient2d, orient3d};

use super::FillError;
use super::lattice::{Filled, Lattice};
use super::rows::{Rows, coord, sign};
use super::surface::TriangleSurface;

/// Finds the nodes of a lattice inside a closed surface: those with a winding number of at least one. Volume
/// enclosed twice counts once; cavities are empty.
///
/// # Errors
/// Returns an error for an open surface and for a lattice with too many nodes.
pub fn fill(surface: &TriangleSurface, spacing: [f64; 3]) -> Result<Filled, FillError> {
    fill_nodes(surface, Lattice::around(surface.bounds(), spacing)?)
}

/// Like [`fill`] with a given lattice, which need not cover the surface.
///
/// # Errors
/// Returns an error for an open surface.
pub fn fill_nodes(surface: &TriangleSurface, lattice: Lattice) -> Result<Filled, FillError> {
    let rows = Rows::new(surface, lattice);
    let enclosed = surface.signed_volume();
    let outward = if enclosed < 0.0 { -1 } else { 1 };
    let [nx, _, nz] = lattice.counts;
    let mut inside = vec![false; lattice.len()];
    let open: Vec<OpenColumns> = inside
        .par_chunks_mut(nx * nz)
        .enumerate()
        .map_init(
            || vec![0i32; nx * (nz + 1)],
            |changes, (row, inside)| fill_row(&rows, row, outward, changes, inside),
        )
        .collect();
    let columns = open.iter().map(|open| open.count).sum();
    if let Some((row, column)) = open
        .iter()
        .enumerate()
        .find_map(|(row, open)| Some((row, open.first?)))
    {
        return Err(FillError::Open {
            columns,
            all: nx * lattice.counts[1],
            edges: surface.unmatched_edges(),
            at: [lattice.coordinate(0, column), lattice.coordinate(1, row)],
        });
    }
    Ok(Filled {
        lattice,
        inside,
        enclosed: enclosed.abs(),
        was_turned: enclosed < 0.0,
    })
}

/// Lines of a row whose signed crossings do not sum to zero.
struct OpenColumns {
    count: usize,
    first: Option<usize>,
}

/// Fills a row of columns; `changes` has one entry more than a column has nodes, all zero before and after.
fn fill_row(
    rows: &Rows<'_>,
    row: usize,
    outward: i32,
    changes: &mut [i32],
    inside: &mut [bool],
) -> OpenColumns {
    let lattice = &rows.lattice;
    let nz = lattice.counts[2];
    let y = lattice.coordinate(1, row);
    rows.crossings(row, |column, corners, up| {
        let x = lattice.coordinate(0, column);
        let above = first_above(lattice, corners, up, x, y);
        changes[column * (nz + 1) + above] += up * outward;
    });
    let mut open = OpenColumns {
        count: 0,
        first: None,
    };
    let columns = changes
        .chunks_mut(nz + 1)
        .zip(inside.chunks_mut(nz))
        .enumerate();
    for (column, (changes, inside)) in columns {
        // A crossing changes all nodes below it.
        let mut winding = changes[nz];
        for (change, inside) in changes[..nz].iter().zip(inside).rev() {
            *inside = winding >= 1;
            winding += change;
        }
        changes.fill(0);
        if winding != 0 {
            open.count += 1;
            open.first.get_or_insert(column);
        }
    }
    open
}

/// Returns the number of the first node above a triangle that a line crosses.
fn first_above(lattice: &Lattice, corners: &[[f64; 3]; 3], up: i32, x: f64, y: f64) -> usize {
    let nz = lattice.counts[2];
    let height = crossing_height(corners, x, y);
    let guess = (height - lattice.coordinate(2, 0)) / lattice.spacing[2];
    // The cast clamps the number to the range and maps NaN to zero.
    let mut node = (guess.ceil().max(0.0) as usize).min(nz);
    let above = |node: usize| up * side_of(corners, [x, y, lattice.coordinate(2, node)]) > 0;
    while node < nz && !above(node) {
        node += 1;
    }
    while node > 0 && above(node - 1) {
        node -= 1;
    }
    node
}

/// Returns z of the intersection of a line along z with the plane of a triangle, rounded.
pub(super) fn crossing_height(corners: &[[f64; 3]; 3], x: f64, y: f64) -> f64 {
    let [a, b, c] = *corners;
    let (p, q) = (
        [b[0] - a[0], b[1] - a[1], b[2] - a[2]],
        [c[0] - a[0], c[1] - a[1], c[2] - a[2]],
    );
    let normal = crate::element::cross(p, q);
    a[2] - (normal[0] * (x - a[0]) + normal[1] * (y - a[1])) / normal[2]
}

/// Returns the side of a triangle's plane on which the point q + (ε, ε², ε³) lies: 1 in the direction of the
/// normal.
fn side_of(corners: &[[f64; 3]; 3], q: [f64; 3]) -> i32 {
    let point = |[x, y, z]: [f64; 3]| Coord3D { x, y, z };
    let [a, b, c] = *corners;
    let exact = -sign(orient3d(point(a), point(b), point(c), point(q)));
    if exact != 0 {
        return exact;
    }
    // q is in the plane: the first non-zero component of the normal decides.
    let component = |c1: usize, c2: usize| {
        let [a, b, c] = corners.map(|corner| coord(corner[c1], corner[c2]));
        sign(orient2d(a, b, c))
    };
    let components = [component(1, 2), component(2, 0), component(0, 1)];
    components.into_iter().find(|&s| s != 0).unwrap_or(0)
}
