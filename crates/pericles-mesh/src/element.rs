//! Volume and centroid of an element.
//!
//! Every solid is a hexahedron whose corners may coincide. With two Gauss points per axis, r_c = ±1/√3, x(r)
//! = Σ N_a x_a, N_a = ⅛ Π_c (1 + s_ac r_c) and J = det ∂x/∂r,
//!
//! V = Σ J, C = Σ J x / V,
//!
//! which is exact, because J and x J are polynomials of degree 3 at most in each r_c; non-planar faces are
//! bilinear. Plane elements are quadrilaterals, treated in the same way with ¼ Π (1 + s_ac r_c).

use crate::cell::CellKind;

/// Volume (or area of plane elements, length of lines) and centroid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// Volume of solids, area of plane elements; negative if the corners are ordered in the opposite direction.
    pub volume: f64,
    /// Centroid.
    pub centroid: [f64; 3],
}

/// Returns the corners of the hexahedron that represents an element.
fn brick(kind: CellKind) -> Option<[usize; 8]> {
    match kind {
        CellKind::Tetrahedron => Some([0, 1, 2, 2, 3, 3, 3, 3]),
        CellKind::Pyramid => Some([0, 1, 2, 3, 4, 4, 4, 4]),
        CellKind::Wedge => Some([0, 1, 2, 2, 3, 4, 5, 5]),
        CellKind::Hexahedron => Some([0, 1, 2, 3, 4, 5, 6, 7]),
        _ => None,
    }
}

/// Signs of the corners of a hexahedron along the axes.
const SIGNS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// 1/√3.
const NODE: f64 = 0.577_350_269_189_625_8;

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| a[c] - b[c])
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn triple(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    dot(a, cross(b, c))
}

/// Returns the measure of an element; `None` for types without volume or area, or with too few corners.
pub fn measure(kind: CellKind, corners: &[[f64; 3]]) -> Option<Measure> {
    if corners.len() < kind.corners() {
        return None;
    }
    let first = corners[0];
    // Coordinates relative to a corner avoid a loss of digits far from the origin.
    let local = |corner: usize| minus(corners[corner], first);
    let (volume, moment) = match kind {
        CellKind::Triangle => quadrilateral([0, 1, 2, 2].map(local)),
        CellKind::Quadrilateral => quadrilateral([0, 1, 2, 3].map(local)),
        _ => solid(brick(kind)?.map(local)),
    };
    let offset = moment.map(|m| if volume == 0.0 { 0.0 } else { m / volume });
    Some(Measure {
        volume,
        centroid: std::array::from_fn(|c| first[c] + offset[c]),
    })
}

/// Returns volume and ∫ x dV of a hexahedron.
fn solid(x: [[f64; 3]; 8]) -> (f64, [f64; 3]) {
    let (mut volume, mut moment) = (0.0, [0.0; 3]);
    for node in SIGNS {
        let r = node.map(|sign| sign * NODE);
        let (mut at, mut slope) = ([0.0; 3], [[0.0; 3]; 3]);
        for (x, signs) in x.iter().zip(SIGNS) {
            let factor: [f64; 3] = std::array::from_fn(|c| 1.0 + signs[c] * r[c]);
            let shape = 0.125 * factor[0] * factor[1] * factor[2];
            let derivative = [
                0.125 * signs[0] * factor[1] * factor[2],
                0.125 * factor[0] * signs[1] * factor[2],
                0.125 * factor[0] * factor[1] * signs[2],
            ];
            for c in 0..3 {
                at[c] += shape * x[c];
                for (row, d) in slope.iter_mut().zip(derivative) {
                    row[c] += d * x[c];
                }
            }
        }
        let jacobian = triple(slope[0], slope[1], slope[2]);
        volume += jacobian;
        for c in 0..3 {
            moment[c] += jacobian * at[c];
        }
    }
    (volume, moment)
}

/// Returns the shape functions of a quadrilateral and their derivatives at a Gauss point.
fn plane_shapes(node: usize) -> [(f64, f64, f64); 4] {
    let [r, s, _] = SIGNS[node].map(|sign| sign * NODE);
    std::array::from_fn(|corner| {
        let [a, b, _] = SIGNS[corner];
        let (f, g) = (1.0 + a * r, 1.0 + b * s);
        (0.25 * f * g, 0.25 * a * g, 0.25 * f * b)
    })
}

/// Returns area and ∫ x dA of a quadrilateral in a plane of constant z.
fn quadrilateral(x: [[f64; 3]; 4]) -> (f64, [f64; 3]) {
    let (mut area, mut moment) = (0.0, [0.0; 3]);
    for node in 0..4 {
        let (mut at, mut along_r, mut along_s) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for (x, (shape, dr, ds)) in x.iter().zip(plane_shapes(node)) {
            for c in 0..3 {
                at[c] += shape * x[c];
                along_r[c] += dr * x[c];
                along_s[c] += ds * x[c];
            }
        }
        let jacobian = along_r[0] * along_s[1] - along_r[1] * along_s[0];
        area += jacobian;
        for c in 0..3 {
            moment[c] += jacobian * at[c];
        }
    }
    (area, moment)
}

/// Returns the length of a line or the area of a triangle or quadrilateral in space, never negative; 1 for a
/// point and 0 for solids.
///
/// The area of a non-planar quadrilateral is the area of the bilinear surface, integrated with two Gauss points
/// per axis.
pub fn facet_measure(kind: CellKind, corners: &[[f64; 3]]) -> f64 {
    let norm = |a: [f64; 3]| dot(a, a).sqrt();
    match (kind, corners) {
        (CellKind::Point, _) => 1.0,
        (CellKind::Line, &[a, b, ..]) => norm(minus(b, a)),
        (CellKind::Triangle, &[a, b, c, ..]) => 0.5 * norm(cross(minus(b, a), minus(c, a))),
        (CellKind::Quadrilateral, &[a, b, c, d, ..]) => {
            let x = [[0.0; 3], minus(b, a), minus(c, a), minus(d, a)];
            let area = |node| {
                let (mut along_r, mut along_s) = ([0.0; 3], [0.0; 3]);
                for (x, (_, dr, ds)) in x.iter().zip(plane_shapes(node)) {
                    for c in 0..3 {
                        along_r[c] += dr * x[c];
                        along_s[c] += ds * x[c];
                    }
                }
                norm(cross(along_r, along_s))
            };
            (0..4).map(area).sum()
        }
        _ => 0.0,
    }
}

/// Returns the corners connected to each corner by edges, ordered so that their triple product is positive in
/// a valid element.
fn neighbours(kind: CellKind) -> &'static [[usize; 3]] {
    match kind {
        CellKind::Tetrahedron => &[[1, 2, 3]],
        CellKind::Pyramid => &[[1, 3, 4], [2, 0, 4], [3, 1, 4], [0, 2, 4]],
        CellKind::Wedge => &[
            [1, 2, 3],
            [2, 0, 4],
            [0, 1, 5],
            [5, 4, 0],
            [3, 5, 1],
            [4, 3, 2],
        ],
        CellKind::Hexahedron => &[
            [1, 3, 4],
            [2, 0, 5],
            [3, 1, 6],
            [0, 2, 7],
            [7, 5, 0],
            [4, 6, 1],
            [5, 7, 2],
            [6, 4, 3],
        ],
        _ => &[],
    }
}

/// Triple products below this fraction of the largest one count as zero: round-off of a corner with coplanar
/// edges.
const FLAT: f64 = 1e-12;

/// Returns whether an element is folded: the triple product (or area) of the edges is positive at one corner
/// and negative at another. The Gauss points of a hexahedron with coinciding corners do not detect this.
pub fn is_folded(kind: CellKind, corners: &[[f64; 3]]) -> bool {
    if corners.len() < kind.corners() {
        return false;
    }
    let edge = |from: usize, to: usize| minus(corners[to], corners[from]);
    let products: Vec<f64> = match kind {
        CellKind::Quadrilateral => (0..4)
            .map(|k| cross(edge(k, (k + 1) % 4), edge(k, (k + 3) % 4))[2])
            .collect(),
        _ => neighbours(kind)
            .iter()
            .enumerate()
            .map(|(k, &[a, b, c])| triple(edge(k, a), edge(k, b), edge(k, c)))
            .collect(),
    };
    let largest = products.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
    let beyond = |sign: f64| products.iter().any(|p| sign * p > FLAT * largest);
    beyond(1.0) && beyond(-1.0)
}
