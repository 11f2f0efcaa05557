//! Cells of plane bodies and faces of solids as polygons.

use super::bitmap::Rgb;
use super::colour::shaded;
use super::projection::View;
use super::raster::{Rank, Raster};
use pericles::vector::{cross, dot, minus};

/// A triangle or quadrilateral with the value of a point: a cell of a plane body, or a face of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polygon {
    /// Displaced positions of the corners in order, m; a triangle repeats its last corner.
    pub corners: [[f64; 3]; 4],
    /// The point whose value the polygon shows.
    pub point: u32,
}

/// The polygons of a body at one time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Polygons {
    /// The polygons.
    pub all: Vec<Polygon>,
    /// For each point of the body whether it has a cell, which may be hidden inside the body. Other points are drawn as
    /// squares or cubes.
    pub has_cell: Vec<bool>,
}

/// A polygon to draw.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coloured {
    pub(super) corners: [[f64; 3]; 4],
    pub(super) colour: Rgb,
}

/// Edges of polygons, as a fraction of the colour of the polygon.
const EDGE: f64 = 0.45;

/// Draws polygons: faces of a solid in a view, or cells of a plane body. `place` maps positions to pixels and the distance
/// from the viewer; `edge` is the width of drawn edges in pixels.
pub(super) fn draw(
    raster: &mut Raster,
    polygons: &[Coloured],
    place: impl Fn([f64; 3]) -> [f64; 3],
    view: Option<&View>,
    edge: Option<f64>,
) {
    let mut placed: Vec<_> = polygons
        .iter()
        .zip(0_u32..)
        .map(|(polygon, number)| (polygon.corners.map(&place), number, polygon))
        .collect();
    // From front to back, so that few hidden pixels are coloured.
    let nearest =
        |corners: &[[f64; 3]; 4]| corners.iter().map(|x| x[2]).fold(f64::INFINITY, f64::min);
    placed.sort_by(|(a, ..), (b, ..)| nearest(a).total_cmp(&nearest(b)));
    for (corners, number, polygon) in placed {
        let normal = normal(polygon.corners);
        let light = view.map_or(1.0, |view| view.light_on_face(normal));
        let colour = shaded(polygon.colour, light);
        let lined = shaded(colour, EDGE);
        // The border of a face turned away would show beside the faces that hide it.
        let is_seen = view.is_none_or(|view| dot(normal, view.eye) >= 0.0);
        let seam = is_seen.then(|| longest_side(polygon.corners));
        for (triangle, outer) in triangles(corners) {
            let heights = heights(triangle);
            raster.triangle(triangle, Rank { number, seam }, |shares| match edge {
                Some(width) if (0..3).any(|k| outer[k] && shares[k] * heights[k] < 0.5 * width) => {
                    lined
                }
                _ => colour,
            });
        }
    }
}

/// Splits a polygon along its shorter diagonal. With each triangle go flags for its corners: whether the opposite side is
/// a side of the polygon.
fn triangles([a, b, c, d]: [[f64; 3]; 4]) -> Vec<([[f64; 3]; 3], [bool; 3])> {
    let length = |p: [f64; 3], q: [f64; 3]| (q[0] - p[0]).hypot(q[1] - p[1]);
    if c == d {
        return vec![([a, b, c], [true; 3])];
    }
    match length(a, c) <= length(b, d) {
        true => vec![
            ([a, b, c], [true, false, true]),
            ([a, c, d], [true, true, false]),
        ],
        false => vec![
            ([a, b, d], [false, true, true]),
            ([b, c, d], [true, false, true]),
        ],
    }
}

/// Returns the distance of each corner of a triangle from the opposite side, on the screen.
fn heights([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    let side = |p: [f64; 3], q: [f64; 3]| (q[0] - p[0]).hypot(q[1] - p[1]);
    [side(b, c), side(c, a), side(a, b)].map(|side| doubled.abs() / side)
}

/// Returns the normal of a polygon, by its diagonals.
fn normal([a, b, c, d]: [[f64; 3]; 4]) -> [f64; 3] {
    cross(minus(c, a), minus(d, b))
}

fn longest_side(corners: [[f64; 3]; 4]) -> f64 {
    let side = |k: usize| {
        let (p, q) = (corners[k], corners[(k + 1) % 4]);
        (0..3).map(|c| (q[c] - p[c]).powi(2)).sum::<f64>().sqrt()
    };
    (0..4).map(side).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quadrilateral_is_split_without_its_diagonal_as_an_edge() {
        let corners = [[0.0; 3], [4.0, 0.0, 0.0], [5.0, 2.0, 0.0], [1.0, 2.0, 0.0]];
        let area = |[a, b, c]: [[f64; 3]; 3]| {
            0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]))
        };
        for turned in 0..4 {
            let mut turn = corners;
            turn.rotate_left(turned);
            let parts = triangles(turn);
            let total: f64 = parts.iter().map(|(triangle, _)| area(*triangle)).sum();
            assert!((total - 8.0).abs() < 1e-14);
            // The sides of the polygon have the lengths 4, 4, √5, √5.
            let mut sides: Vec<f64> = Vec::new();
            for (triangle, outer) in &parts {
                let heights = heights(*triangle);
                let sides_of = (0..3).filter(|k| outer[*k]);
                sides.extend(sides_of.map(|k| 2.0 * area(*triangle) / heights[k]));
            }
            sides.sort_by(f64::total_cmp);
            let expected = [5_f64.sqrt(), 5_f64.sqrt(), 4.0, 4.0];
            assert!(
                sides
                    .iter()
                    .zip(expected)
                    .all(|(a, b)| (a - b).abs() < 1e-14)
            );
        }
        let [a, b, c, _] = corners;
        assert_eq!(triangles([a, b, c, c]).len(), 1);
    }
}
