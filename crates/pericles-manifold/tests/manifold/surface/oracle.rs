//! Reference implementation of shortest paths on a polyhedron by exhaustive search: straight rays from a vertex
//! are followed through all triangles they can meet, without pruning, and the straight lines found between
//! vertices are joined by the Floyd–Warshall algorithm.
//!
//! It shares only the surface type with the library. It is correct because a shortest path is straight except
//! for bends at vertices.

use std::collections::HashMap;

use pericles_manifold::surface::Surface;

type Plane = [f64; 2];

struct Rays<'a> {
    surface: &'a Surface,
    reach: f64,
    /// Triangle on the left of a directed edge.
    left: HashMap<[u32; 2], [u32; 3]>,
    found: Vec<f64>,
}

/// Distances of all pairs closer than `reach`; infinite beyond.
pub fn distances(surface: &Surface, reach: f64) -> Vec<Vec<f64>> {
    let mut left = HashMap::new();
    for &[a, b, c] in surface.triangles() {
        left.extend([
            ([a, b], [a, b, c]),
            ([b, c], [b, c, a]),
            ([c, a], [c, a, b]),
        ]);
    }
    let n = surface.len();
    let mut all: Vec<Vec<f64>> = (0..n as u32)
        .map(|source| {
            let mut rays = Rays {
                surface,
                reach,
                left: left.clone(),
                found: vec![f64::INFINITY; n],
            };
            rays.from(source);
            rays.found
        })
        .collect();
    for k in 0..n {
        for i in 0..n {
            for j in 0..n {
                all[i][j] = all[i][j].min(all[i][k] + all[k][j]);
            }
        }
    }
    for row in &mut all {
        for d in row {
            if *d >= reach {
                *d = f64::INFINITY;
            }
        }
    }
    all
}

impl Rays<'_> {
    fn from(&mut self, source: u32) {
        self.found[source as usize] = 0.0;
        for &[a, b, c] in self.surface.triangles() {
            for [a, b, c] in [[a, b, c], [b, c, a], [c, a, b]] {
                if a == source {
                    // The source at the origin, the next corner along x.
                    let to_b = [self.length(a, b), 0.0];
                    let to_c = self.apex([0.0; 2], to_b, self.length(a, c), self.length(b, c));
                    self.meet(b, to_b);
                    self.meet(c, to_c);
                    self.through(c, b, to_c, to_b, [to_b, to_c]);
                }
            }
        }
    }

    /// Follows the rays between two directions (the first clockwise of the second) through the directed edge p
    /// → q into the triangle on its left.
    fn through(&mut self, p: u32, q: u32, at_p: Plane, at_q: Plane, cone: [Plane; 2]) {
        if nearest_on(at_p, at_q, cone) >= self.reach {
            return;
        }
        let Some(&[_, _, r]) = self.left.get(&[p, q]) else {
            return;
        };
        let at_r = self.apex(at_p, at_q, self.length(p, r), self.length(q, r));
        let [low, high] = cone;
        let tolerance = 1e-12 * at_r[0].hypot(at_r[1]);
        if cross(low, at_r) >= -tolerance * low[0].hypot(low[1])
            && cross(at_r, high) >= -tolerance * high[0].hypot(high[1])
        {
            self.meet(r, at_r);
        }
        // Seen from the origin, q is on the right and p on the left.
        if cross(low, at_r) > 0.0 {
            let high = if cross(at_r, high) > 0.0 { at_r } else { high };
            self.through(r, q, at_r, at_q, [low, high]);
        }
        if cross(at_r, high) > 0.0 {
            let low = if cross(low, at_r) > 0.0 { at_r } else { low };
            self.through(p, r, at_p, at_r, [low, high]);
        }
    }

    fn meet(&mut self, vertex: u32, at: Plane) {
        let found = &mut self.found[vertex as usize];
        *found = found.min(at[0].hypot(at[1]));
    }

    fn length(&self, a: u32, b: u32) -> f64 {
        self.surface.chord(a as usize, b as usize)
    }

    /// Third corner of a triangle on the left of p → q.
    fn apex(&self, p: Plane, q: Plane, to_p: f64, to_q: f64) -> Plane {
        let [x, y] = [q[0] - p[0], q[1] - p[1]];
        let base = x.hypot(y);
        let along = (to_p * to_p - to_q * to_q + base * base) / (2.0 * base);
        let up = (to_p * to_p - along * along).max(0.0).sqrt();
        [
            p[0] + (along * x - up * y) / base,
            p[1] + (along * y + up * x) / base,
        ]
    }
}

fn cross(a: Plane, b: Plane) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Distance of the origin from the part of a segment within a cone.
fn nearest_on(p: Plane, q: Plane, [low, high]: [Plane; 2]) -> f64 {
    let along = [q[0] - p[0], q[1] - p[1]];
    let hit = |direction: Plane| {
        let part = cross(p, direction) / cross(direction, along);
        if part.is_finite() {
            part.clamp(0.0, 1.0)
        } else {
            0.5
        }
    };
    let (a, b) = (hit(high), hit(low));
    let foot = -(p[0] * along[0] + p[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
    let part = foot.clamp(a.min(b), a.max(b));
    (p[0] + part * along[0]).hypot(p[1] + part * along[1])
}
