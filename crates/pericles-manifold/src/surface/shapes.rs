//! Surfaces defined by formulas.

use pericles::vector::{cross, dot, minus, norm};
use std::collections::HashMap;
use std::f64::consts::PI;

use super::{Surface, SurfaceError};
use pericles::space::Point;

/// Finest icosphere: 10 · 4^10 + 2 ≈ ten million vertices.
const FINEST: u32 = 10;

impl Surface {
    /// Creates a sphere about the origin: an icosahedron subdivided `level` times, with new vertices projected
    /// onto the sphere.
    ///
    /// The twelve corners lie at (0, ±1, ±φ) and cyclic permutations, with φ the golden ratio, so the poles are
    /// vertices from level 1 on. V = 10 · 4^level + 2, T = 20 · 4^level.
    pub fn icosphere(level: u32, radius: f64) -> Result<Self, SurfaceError> {
        positive("the radius of the icosphere, m", radius)?;
        if level > FINEST {
            return Err(SurfaceError::Parameter {
                quantity: "the level of the icosphere",
                value: f64::from(level),
                allowed: "0 to 10",
            });
        }
        let (mut positions, mut triangles) = icosahedron();
        for _ in 0..level {
            triangles = halve(&mut positions, &triangles);
        }
        scale(&mut positions, [radius; 3]);
        Self::new(positions, triangles)
    }

    /// Creates a sphere about the origin with `rings` circles of latitude of `segments` vertices each, and two
    /// poles on the z axis.
    pub fn uv_sphere(segments: u32, rings: u32, radius: f64) -> Result<Self, SurfaceError> {
        positive("the radius of the sphere, m", radius)?;
        at_least("the number of segments around the sphere", segments, 3)?;
        at_least("the number of rings of the sphere", rings, 1)?;
        let profile = (1..=rings)
            .map(|k| PI * f64::from(k) / f64::from(rings + 1))
            .map(|angle| [radius * angle.sin(), radius * angle.cos()]);
        spun(segments, profile.collect(), [radius, -radius])
    }

    /// Creates an ellipsoid about the origin with the given half axes: a stretched icosphere.
    pub fn ellipsoid(level: u32, half_axes: [f64; 3]) -> Result<Self, SurfaceError> {
        for half_axis in half_axes {
            positive("a half axis of the ellipsoid, m", half_axis)?;
        }
        let mut surface = Self::icosphere(level, 1.0)?;
        scale(&mut surface.positions, half_axes);
        Ok(surface)
    }

    /// Creates a torus about the z axis with `around` vertices along the major circle (radius `major`) and
    /// `across` along the minor circle (radius `minor`).
    ///
    /// Vertex (i, j), number i · across + j, lies at ((R + r cos b) cos a, (R + r cos b) sin a, r sin b) with
    /// a = 2πi/around, b = 2πj/across; quadrilaterals are divided along (i, j)–(i+1, j+1).
    pub fn torus(major: f64, minor: f64, around: u32, across: u32) -> Result<Self, SurfaceError> {
        positive("the minor radius of the torus, m", minor)?;
        if !(major.is_finite() && major > minor) {
            return Err(SurfaceError::Parameter {
                quantity: "the major radius of the torus, m",
                value: major,
                allowed: "more than the minor radius",
            });
        }
        at_least("the number of major segments of the torus", around, 3)?;
        at_least("the number of minor segments of the torus", across, 3)?;
        few(around, across)?;
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for i in 0..around {
            for j in 0..across {
                let a = 2.0 * PI * f64::from(i) / f64::from(around);
                let b = 2.0 * PI * f64::from(j) / f64::from(across);
                let out = major + minor * b.cos();
                positions.push([out * a.cos(), out * a.sin(), minor * b.sin()]);
                let at = |i: u32, j: u32| (i % around) * across + j % across;
                let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                triangles.push([corners[0], corners[1], corners[2]]);
                triangles.push([corners[0], corners[2], corners[3]]);
            }
        }
        Self::new(positions, triangles)
    }

    /// Creates a capsule about the z axis: a tube of the given length between two half spheres. It has
    /// `segments` vertices around it; the distance between rings is about the distance of vertices within a ring.
    pub fn capsule(radius: f64, length: f64, segments: u32) -> Result<Self, SurfaceError> {
        positive("the radius of the capsule, m", radius)?;
        positive("the length of the capsule's tube, m", length)?;
        at_least("the number of segments around the capsule", segments, 4)?;
        let side = 2.0 * PI * radius / f64::from(segments);
        let cap = (0.5 * PI * radius / side).round().max(1.0);
        let tube = (length / side).round().max(1.0);
        few(segments, (2.0 * cap + tube).min(f64::from(u32::MAX)) as u32)?;
        let half = 0.5 * length;
        let mut profile = Vec::new();
        for k in 1..=cap as u32 {
            let angle = 0.5 * PI * f64::from(k) / cap;
            profile.push([radius * angle.sin(), half + radius * angle.cos()]);
        }
        for k in 1..tube as u32 {
            profile.push([radius, half - length * f64::from(k) / tube]);
        }
        let lower: Vec<[f64; 2]> = profile[..cap as usize]
            .iter()
            .rev()
            .map(|&[out, z]| [out, -z])
            .collect();
        profile.extend(lower);
        spun(segments, profile, [half + radius, -half - radius])
    }
}

/// Creates a surface of revolution about the z axis from rings (distance from the axis, height), from top to
/// bottom, between two poles.
fn spun(segments: u32, profile: Vec<[f64; 2]>, poles: [f64; 2]) -> Result<Surface, SurfaceError> {
    let rings = u32::try_from(profile.len()).unwrap_or(u32::MAX);
    few(segments, rings)?;
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for [out, z] in profile {
        for k in 0..segments {
            let angle = 2.0 * PI * f64::from(k) / f64::from(segments);
            positions.push([out * angle.cos(), out * angle.sin(), z]);
        }
    }
    let top = positions.len() as u32;
    positions.extend(poles.map(|z| [0.0, 0.0, z]));
    let at = |ring: u32, k: u32| ring * segments + k % segments;
    for k in 0..segments {
        triangles.push([top, at(0, k), at(0, k + 1)]);
        for ring in 1..rings {
            let above = [at(ring - 1, k), at(ring - 1, k + 1)];
            let below = [at(ring, k), at(ring, k + 1)];
            triangles.push([above[0], below[0], below[1]]);
            triangles.push([above[0], below[1], above[1]]);
        }
        triangles.push([at(rings - 1, k), top + 1, at(rings - 1, k + 1)]);
    }
    Surface::new(positions, triangles)
}

fn icosahedron() -> (Vec<Point>, Vec<[u32; 3]>) {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut corners: Vec<Point> = Vec::new();
    for axis in 0..3 {
        for [one, phi] in [
            [1.0, golden],
            [1.0, -golden],
            [-1.0, golden],
            [-1.0, -golden],
        ] {
            let mut corner = [0.0; 3];
            corner[(axis + 1) % 3] = one;
            corner[(axis + 2) % 3] = phi;
            corners.push(corner);
        }
    }
    // Neighbouring corners are 2 apart, the next nearest more than 3.
    let joined = |a: usize, b: usize| norm(minus(corners[a], corners[b])) < 2.5;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if joined(a, b) && joined(b, c) && joined(c, a) {
                    let side = |k: usize| minus(corners[k], corners[a]);
                    let outward = dot(cross(side(b), side(c)), corners[a]) > 0.0;
                    let [b, c] = if outward { [b, c] } else { [c, b] };
                    triangles.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    (corners.into_iter().map(unit).collect(), triangles)
}

/// Divides every triangle into four and projects the new vertices onto the unit sphere.
fn halve(positions: &mut Vec<Point>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles: HashMap<[u32; 2], u32> = HashMap::with_capacity(triangles.len() * 3 / 2);
    let mut finer = Vec::with_capacity(4 * triangles.len());
    for &[a, b, c] in triangles {
        let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[from, to]| {
            *middles
                .entry([from.min(to), from.max(to)])
                .or_insert_with(|| {
                    let (p, q) = (positions[from as usize], positions[to as usize]);
                    positions.push(unit(std::array::from_fn(|k| 0.5 * (p[k] + q[k]))));
                    positions.len() as u32 - 1
                })
        });
        finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    finer
}

fn unit(x: Point) -> Point {
    let length = norm(x);
    x.map(|c| c / length)
}

fn scale(positions: &mut [Point], factors: [f64; 3]) {
    for position in positions {
        for (x, factor) in position.iter_mut().zip(factors) {
            *x *= factor;
        }
    }
}

fn positive(quantity: &'static str, value: f64) -> Result<(), SurfaceError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(SurfaceError::Parameter {
        quantity,
        value,
        allowed: "positive and finite",
    })
}

fn at_least(quantity: &'static str, value: u32, least: u32) -> Result<(), SurfaceError> {
    if value >= least {
        return Ok(());
    }
    Err(SurfaceError::Parameter {
        quantity,
        value: f64::from(value),
        allowed: match least {
            1 => "at least 1",
            3 => "at least 3",
            _ => "at least 4",
        },
    })
}

/// Returns an error for a grid of vertices too large for memory, before it is created.
fn few(a: u32, b: u32) -> Result<(), SurfaceError> {
    let count = u64::from(a) * u64::from(b);
    // The size of the finest icosphere.
    let limit = 10 * 4u64.pow(FINEST) + 2;
    if count <= limit {
        return Ok(());
    }
    Err(SurfaceError::TooLarge {
        what: "vertices",
        count: usize::try_from(count).unwrap_or(usize::MAX),
        limit: limit as usize,
    })
}
