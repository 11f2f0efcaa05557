//! Shaded triangles of a surface whose vertices are the points.

use super::scene::Facet;
use pericles::vector::normal;

/// Returns the triangles with finite corners. Values are not interpolated if they are identification numbers.
pub(super) fn facets(
    triangles: &[[u32; 3]],
    places: &[[f64; 3]],
    values: &[f64],
    are_numbers: bool,
) -> Vec<Facet> {
    let corners = |triangle: [u32; 3]| triangle.map(|point| places[point as usize]);
    let is_finite =
        |triangle: &&[u32; 3]| corners(**triangle).iter().flatten().all(|x| x.is_finite());
    let mut normals = vec![[0.0; 3]; places.len()];
    for triangle in triangles.iter().filter(is_finite) {
        let normal = normal(corners(*triangle));
        for &point in triangle {
            for c in 0..3 {
                normals[point as usize][c] += normal[c];
            }
        }
    }
    triangles
        .iter()
        .filter(is_finite)
        .map(|triangle| Facet {
            corners: corners(*triangle),
            normals: triangle.map(|point| normals[point as usize]),
            values: match are_numbers {
                true => [values[triangle[0] as usize]; 3],
                false => triangle.map(|point| values[point as usize]),
            },
        })
        .collect()
}
