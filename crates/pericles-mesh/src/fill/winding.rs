//! Winding number of a surface that need not be closed.
//!
//! w(q) = Σ Ω / 4π over the triangles, where Ω is the solid angle of a triangle seen from q (van Oosterom and
//! Strackee 1983). Distant triangles are grouped and approximated by the dipole Σ a n and the first moment Σ
//! a n (x − c)ᵀ about their centre c (Barill et al. 2018).

use rayon::prelude::*;

use super::FillError;
use super::lattice::{Filled, Lattice};
use super::surface::TriangleSurface;
use crate::element::{cross, dot};

/// Number of triangles in a leaf.
const LEAF: usize = 8;

/// Triangles farther than this many radii of their box are approximated together.
const FAR: f64 = 2.0;

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| a[c] - b[c])
}

fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// A group of triangles.
struct Node {
    centre: [f64; 3],
    radius: f64,
    /// Σ a n.
    dipole: [f64; 3],
    /// Σ a n_i (x − c)_j.
    moment: [[f64; 3]; 3],
    /// Range of triangles in the order of the tree.
    begin: usize,
    end: usize,
    /// The second child; the first one follows its parent. `None` for leaves.
    second: Option<usize>,
}

/// Tree of triangles for the winding number.
pub struct WindingTree {
    corners: Vec<[[f64; 3]; 3]>,
    nodes: Vec<Node>,
}

impl WindingTree {
    /// Builds the tree of a surface.
    pub fn new(surface: &TriangleSurface) -> Self {
        let corners = (0..surface.len()).map(|triangle| surface.corners(triangle));
        let mut tree = Self {
            corners: corners.collect(),
            nodes: Vec::new(),
        };
        tree.divide(0, tree.corners.len());
        tree
    }

    /// Creates the node of a range of triangles, and its children.
    fn divide(&mut self, begin: usize, end: usize) {
        let number = self.nodes.len();
        let node = self.node(begin, end);
        self.nodes.push(node);
        if end - begin <= LEAF {
            return;
        }
        let middle_of =
            |corners: &[[f64; 3]; 3], c: usize| corners[0][c] + corners[1][c] + corners[2][c];
        let part = &mut self.corners[begin..end];
        let extent = |c: usize| {
            let x = part.iter().map(|corners| middle_of(corners, c));
            x.clone().fold(f64::MIN, f64::max) - x.fold(f64::MAX, f64::min)
        };
        let extents = [extent(0), extent(1), extent(2)];
        let axis = (1..3).fold(
            0,
            |best, c| if extents[c] > extents[best] { c } else { best },
        );
        // A stable sort: equal centres keep the order of the file.
        part.sort_by(|a, b| middle_of(a, axis).total_cmp(&middle_of(b, axis)));
        let middle = begin + (end - begin) / 2;
        self.divide(begin, middle);
        self.nodes[number].second = Some(self.nodes.len());
        self.divide(middle, end);
    }

    fn node(&self, begin: usize, end: usize) -> Node {
        let part = &self.corners[begin..end];
        let normal =
            |[a, b, c]: &[[f64; 3]; 3]| cross(minus(*b, *a), minus(*c, *a)).map(|x| 0.5 * x);
        let middle = |corners: &[[f64; 3]; 3]| -> [f64; 3] {
            std::array::from_fn(|k| (corners[0][k] + corners[1][k] + corners[2][k]) / 3.0)
        };
        let (mut area, mut sum) = (0.0, [0.0; 3]);
        for corners in part {
            let own = norm(normal(corners));
            area += own;
            for (sum, x) in sum.iter_mut().zip(middle(corners)) {
                *sum += own * x;
            }
        }
        let centre = match area > 0.0 {
            true => sum.map(|x| x / area),
            false => part[0][0],
        };
        let mut node = Node {
            centre,
            radius: 0.0,
            dipole: [0.0; 3],
            moment: [[0.0; 3]; 3],
            begin,
            end,
            second: None,
        };
        for corners in part {
            let n = normal(corners);
            let offset = minus(middle(corners), centre);
            for i in 0..3 {
                node.dipole[i] += n[i];
                for j in 0..3 {
                    node.moment[i][j] += n[i] * offset[j];
                }
                node.radius = node.radius.max(norm(minus(corners[i], centre)));
            }
        }
        node
    }

    /// Returns the winding number at a point.
    pub fn winding_number(&self, point: [f64; 3]) -> f64 {
        self.solid_angle(0, point) / (4.0 * std::f64::consts::PI)
    }

    fn solid_angle(&self, number: usize, point: [f64; 3]) -> f64 {
        let node = &self.nodes[number];
        let r = minus(node.centre, point);
        let distance = norm(r);
        if distance > FAR * node.radius {
            return node.far(r, distance);
        }
        match node.second {
            Some(second) => self.solid_angle(number + 1, point) + self.solid_angle(second, point),
            None => {
                let triangles = self.corners[node.begin..node.end].iter();
                triangles.map(|corners| solid_angle(corners, point)).sum()
            }
        }
    }
}

impl Node {
    /// Returns the solid angle from the dipole and the first moment: the gradient of r / |r|³ is δ_ij / |r|³
    /// − 3 r_i r_j / |r|⁵.
    fn far(&self, r: [f64; 3], distance: f64) -> f64 {
        let cube = distance.powi(3);
        let trace = self.moment[0][0] + self.moment[1][1] + self.moment[2][2];
        let along: f64 = (0..3).map(|i| r[i] * dot(self.moment[i], r)).sum();
        dot(self.dipole, r) / cube + trace / cube - 3.0 * along / (cube * distance * distance)
    }
}

/// Returns the solid angle of a triangle, positive if seen from inside.
fn solid_angle(corners: &[[f64; 3]; 3], point: [f64; 3]) -> f64 {
    let [a, b, c] = corners.map(|corner| minus(corner, point));
    let (la, lb, lc) = (norm(a), norm(b), norm(c));
    let volume = dot(a, cross(b, c));
    let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    2.0 * volume.atan2(below)
}

/// Finds the nodes of a lattice where the winding number of a surface exceeds ½; the surface may have holes.
/// Nodes within about one spacing of a hole are decided by the smooth closure of the hole that the winding
/// number implies.
///
/// # Errors
/// Returns an error for a lattice with too many nodes.
pub fn fill_open(surface: &TriangleSurface, spacing: [f64; 3]) -> Result<Filled, FillError> {
    let lattice = Lattice::around(surface.bounds(), spacing)?;
    let tree = WindingTree::new(surface);
    Ok(fill_open_nodes(surface, &tree, lattice))
}

/// Like [`fill_open`] with a tree of the surface and a given lattice, which need not cover the surface.
pub fn fill_open_nodes(surface: &TriangleSurface, tree: &WindingTree, lattice: Lattice) -> Filled {
    let enclosed = surface.signed_volume();
    let outward = if enclosed < 0.0 { -1.0 } else { 1.0 };
    let [nx, _, nz] = lattice.counts;
    let mut inside = vec![false; lattice.len()];
    inside
        .par_chunks_mut(nz)
        .enumerate()
        .for_each(|(column, inside)| {
            for (k, inside) in inside.iter_mut().enumerate() {
                let node = lattice.position([column % nx, column / nx, k]);
                *inside = outward * tree.winding_number(node) > 0.5;
            }
        });
    Filled {
        lattice,
        inside,
        enclosed: enclosed.abs(),
        was_turned: enclosed < 0.0,
    }
}
