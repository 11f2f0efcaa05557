//! Closed triangle meshes with signed distances.

use std::collections::HashMap;

use pericles::Result;

use super::tree::Tree;
use crate::error::ContactError;
use crate::vector::{V3, cross, dot, minus, norm, plus, scaled};

/// A body bounded by triangles whose normals point outwards.
///
/// The distance is measured to the nearest triangle, and its sign follows from the angle-weighted normal of the nearest
/// feature: the normal of a face, the sum of both at an edge, the sum weighted by angles at a vertex (Bærentzen & Aanæs
/// 2005). Along concave edges the gradient of the distance jumps.
#[derive(Debug, Clone)]
pub struct ClosedMesh {
    vertices: Vec<V3>,
    triangles: Vec<[u32; 3]>,
    /// Normals of each triangle: face, edges opposite to each corner, corners.
    faces: Vec<V3>,
    edges: Vec<[V3; 3]>,
    corners: Vec<V3>,
    tree: Tree,
    reach: f64,
}

/// Volume, centre and second moments of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Solid {
    /// Volume, m³.
    pub(crate) volume: f64,
    /// Centre, m.
    pub(crate) centre: V3,
    /// ∫ x_a x_b dV about the centre, m⁵.
    pub(crate) second: [[f64; 3]; 3],
}

impl ClosedMesh {
    /// Makes a mesh from the positions of its vertices (m) and the vertices of its triangles. The triangles of a mesh
    /// whose normals point inwards are turned over.
    ///
    /// # Errors
    /// [`ContactError::Mesh`]: vertices that do not exist, triangles without area, edges without exactly one triangle on
    /// each side in consistent orientation, no volume.
    pub fn new(vertices: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self> {
        let wrong = |reason: String| ContactError::Mesh { reason };
        if triangles.is_empty() {
            return Err(wrong("has no triangles; allowed: a closed surface".into()).into());
        }
        let mut directed: HashMap<[u32; 2], usize> = HashMap::new();
        for (k, triangle) in triangles.iter().enumerate() {
            if triangle.iter().any(|&v| v as usize >= vertices.len()) {
                return Err(wrong(format!(
                    "has {} vertices, but triangle {k} names another one",
                    vertices.len()
                ))
                .into());
            }
            if norm(area_normal(&vertices, *triangle)) == 0.0 {
                return Err(wrong(format!("has no area in triangle {k}")).into());
            }
            for e in 0..3 {
                let edge = [triangle[e], triangle[(e + 1) % 3]];
                if directed.insert(edge, k).is_some() {
                    return Err(wrong(format!(
                        "is not a closed surface with one orientation: two triangles run along the edge {edge:?} in the \
                         same direction"
                    ))
                    .into());
                }
            }
        }
        let open = directed
            .keys()
            .filter(|[a, b]| !directed.contains_key(&[*b, *a]));
        let open = open.count();
        if open > 0 {
            return Err(wrong(format!(
                "is open: {open} edges belong to one triangle only; allowed: a closed surface"
            ))
            .into());
        }
        let mut mesh = Self {
            reach: vertices.iter().map(|v| norm(*v)).fold(0.0, f64::max),
            vertices,
            triangles,
            faces: Vec::new(),
            edges: Vec::new(),
            corners: Vec::new(),
            tree: Tree::default(),
        };
        let volume = mesh.solid().volume;
        if volume == 0.0 {
            return Err(wrong("encloses no volume".into()).into());
        }
        if volume < 0.0 {
            mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        mesh.find_normals();
        mesh.tree = Tree::new(&mesh.vertices, &mesh.triangles);
        Ok(mesh)
    }

    /// Positions of the vertices in the frame of the mesh, m.
    pub fn vertices(&self) -> &[[f64; 3]] {
        &self.vertices
    }

    /// Vertices of the triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Returns the mesh with all vertices moved.
    pub(crate) fn moved(self, by: V3) -> Self {
        let vertices: Vec<V3> = self.vertices.iter().map(|v| plus(*v, 1.0, by)).collect();
        Self {
            reach: vertices.iter().map(|v| norm(*v)).fold(0.0, f64::max),
            tree: Tree::new(&vertices, &self.triangles),
            vertices,
            ..self
        }
    }

    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// Returns volume, centre and second moments by signed tetrahedra with the origin.
    pub(crate) fn solid(&self) -> Solid {
        let (mut volume, mut first, mut second) = (0.0, [0.0; 3], [[0.0; 3]; 3]);
        for triangle in &self.triangles {
            let p = triangle.map(|v| self.vertices[v as usize]);
            let part = dot(p[0], cross(p[1], p[2])) / 6.0;
            let sum = plus(plus(p[0], 1.0, p[1]), 1.0, p[2]);
            volume += part;
            first = plus(first, 0.25 * part, sum);
            for a in 0..3 {
                for b in 0..3 {
                    let own: f64 = p.iter().map(|p| p[a] * p[b]).sum();
                    second[a][b] += part / 20.0 * (own + sum[a] * sum[b]);
                }
            }
        }
        let centre = scaled(1.0 / volume, first);
        for a in 0..3 {
            for b in 0..3 {
                second[a][b] -= volume * centre[a] * centre[b];
            }
        }
        Solid {
            volume,
            centre,
            second,
        }
    }

    fn find_normals(&mut self) {
        let unit = |v: V3| scaled(1.0 / norm(v), v);
        let faces = self.triangles.iter();
        self.faces = faces
            .map(|t| unit(area_normal(&self.vertices, *t)))
            .collect();
        let mut of_edge: HashMap<[u32; 2], usize> = HashMap::new();
        self.corners = vec![[0.0; 3]; self.vertices.len()];
        for (k, t) in self.triangles.iter().enumerate() {
            for e in 0..3 {
                of_edge.insert([t[e], t[(e + 1) % 3]], k);
                let [a, b, c] = [0, 1, 2].map(|m| self.vertices[t[(e + m) % 3] as usize]);
                let (ab, ac) = (minus(b, a), minus(c, a));
                let angle = norm(cross(ab, ac)).atan2(dot(ab, ac));
                let corner = &mut self.corners[t[e] as usize];
                *corner = plus(*corner, angle, self.faces[k]);
            }
        }
        self.edges = (0..self.triangles.len())
            .map(|k| {
                let t = self.triangles[k];
                std::array::from_fn(|corner| {
                    // The edge opposite to a corner, as the other triangle runs along it.
                    let edge = [t[(corner + 2) % 3], t[(corner + 1) % 3]];
                    plus(self.faces[k], 1.0, self.faces[of_edge[&edge]])
                })
            })
            .collect();
    }

    /// Returns the signed distance of a point, m, and its gradient.
    pub(crate) fn distance(&self, q: V3) -> (f64, V3) {
        let of = |k: usize| {
            let t = self.triangles[k].map(|v| self.vertices[v as usize]);
            let (foot, feature) = nearest(t, q);
            let away = minus(q, foot);
            (dot(away, away), away, feature)
        };
        let k = self.tree.nearest(q, &|k| of(k).0);
        let (square, away, feature) = of(k);
        let normal = match feature {
            Feature::Face => self.faces[k],
            Feature::Edge(corner) => self.edges[k][corner],
            Feature::Corner(corner) => self.corners[self.triangles[k][corner] as usize],
        };
        let sign = match dot(away, normal) < 0.0 {
            true => -1.0,
            false => 1.0,
        };
        let r = square.sqrt();
        // The direction to a foot that is a rounding error away is meaningless.
        let gradient = match r > 1e-12 * self.reach {
            true => scaled(sign / r, away),
            false => scaled(1.0 / norm(normal), normal),
        };
        (sign * r, gradient)
    }
}

/// The feature of a triangle on which a point lies.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Feature {
    Face,
    /// The edge opposite to a corner.
    Edge(usize),
    Corner(usize),
}

fn area_normal(vertices: &[V3], t: [u32; 3]) -> V3 {
    let [a, b, c] = t.map(|v| vertices[v as usize]);
    cross(minus(b, a), minus(c, a))
}

/// Returns the point of a triangle nearest to q, and its feature (Ericson 2005, section 5.1.5).
fn nearest([a, b, c]: [V3; 3], q: V3) -> (V3, Feature) {
    let (ab, ac) = (minus(b, a), minus(c, a));
    let ap = minus(q, a);
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, Feature::Corner(0));
    }
    let bp = minus(q, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, Feature::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (plus(a, d1 / (d1 - d3), ab), Feature::Edge(2));
    }
    let cp = minus(q, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, Feature::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (plus(a, d2 / (d2 - d6), ac), Feature::Edge(1));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let part = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (plus(b, part, minus(c, b)), Feature::Edge(0));
    }
    let sum = va + vb + vc;
    (plus(plus(a, vb / sum, ab), vc / sum, ac), Feature::Face)
}
