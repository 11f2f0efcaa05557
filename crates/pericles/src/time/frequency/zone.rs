//! The highest frequency of an infinite lattice: an upper bound for every body that is part of it.
//!
//! **Bound.** Let K be the stiffness of a body whose bonds are springs (stiffness ≥ 0) between nodes of a lattice,
//! none stiffer than the lattice spring of the same offset, and let all densities be at least ρ. Extend a field u
//! of the body by zero to all nodes. The extended field ũ strains every bond of the body as u does, and the bonds
//! that the body lacks only add energy, so that u·Ku ≤ ũ·K_lattice ũ; its mass is at most the mass of u. Hence max
//! u·Ku/u·Mu ≤ max over k of the largest eigenvalue of M(k)/ρ, M(k) = Σ (c α κ V/|ξ|)(1 − cos k·ξ) n⊗n with n =
//! ξ/|ξ|, because the energy of the lattice is a mean over its plane waves. Bodies with holes, cracks, broken
//! bonds, constraints and denser parts are parts of the lattice in this sense. Waves of a periodic body are plane
//! waves of the lattice.
//!
//! **Maximum over k.** Branch and bound over boxes of phases θ = k·Δx. In a box of half widths h around θ₀, 1 −
//! cos(φ₀ + d) ≤ 1 − cos φ₀ + d sin φ₀ + d²/2 with φ = θ·o for each offset o and |d| ≤ Σ h|o|. The linear part is
//! largest in a corner of the box, because the largest eigenvalue is convex. The maximum of 1 − cos over the
//! interval is the better estimate for large boxes. Both sums bound all eigenvalues in the box.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

use crate::operator::LatticeSprings;
use crate::sum::max_norm;

type Matrix = [[f64; 3]; 3];

/// A plane wave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PlaneWave {
    /// Phase per spacing along each axis.
    pub phase: [f64; 3],
    /// Polarisation, a unit vector.
    pub polarisation: [f64; 3],
}

/// The maximum over all wave vectors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ZoneMaximum {
    /// An upper bound of ρω², N/m⁴.
    pub bound: f64,
    /// A wave that comes closest to the bound.
    pub wave: PlaneWave,
}

/// Relative difference (in ω²) of the bound and a value attained by a wave, at which the search ends.
const TOLERANCE: f64 = 1e-3;
/// Largest number of springs evaluated over all boxes, which takes less than a second. If it is reached, the result
/// is still a bound, but wider.
const MOST_SPRINGS: usize = 20_000_000;
/// Relative margin for the rounding of sums and of the closed form of the eigenvalues.
const ROUNDING: f64 = 1e-8;

/// Computes the largest ρω² of all plane waves of a lattice.
pub(super) fn zone_maximum(springs: &LatticeSprings) -> ZoneMaximum {
    let dimension = springs.dimension();
    let mut search = Search {
        springs,
        boxes: BinaryHeap::new(),
        attained: 0.0,
        best: [0.0; 3],
        looked_at: 0,
    };
    // Opposite wave vectors have equal frequencies: half of the zone is enough.
    search.offer(Region {
        centre: [0.5 * PI, 0.0, 0.0],
        half: std::array::from_fn(|c| match c {
            0 => 0.5 * PI,
            _ if c < dimension => PI,
            _ => 0.0,
        }),
    });
    let mut upper = f64::INFINITY;
    while let Some(top) = search.boxes.pop() {
        upper = top.upper;
        if upper <= search.attained * (1.0 + TOLERANCE) || search.looked_at > MOST_SPRINGS {
            break;
        }
        for part in top.region.halves() {
            search.offer(part);
        }
    }
    let matrix = matrix_at(springs, search.best);
    ZoneMaximum {
        bound: upper.max(search.attained) * (1.0 + ROUNDING),
        wave: PlaneWave {
            phase: search.best,
            polarisation: dominant_vector(&matrix, dimension),
        },
    }
}

/// State of the branch and bound search.
struct Search<'a> {
    springs: &'a LatticeSprings,
    boxes: BinaryHeap<Bounded>,
    /// Largest value found, and its phases.
    attained: f64,
    best: [f64; 3],
    /// Number of springs evaluated so far.
    looked_at: usize,
}

impl Search<'_> {
    fn offer(&mut self, region: Region) {
        let (value, upper) = bounds_of(self.springs, &region);
        if value > self.attained {
            self.attained = value;
            self.best = region.centre;
        }
        self.boxes.push(Bounded { upper, region });
        self.looked_at += self.springs.half().len();
    }
}

/// A box of phases.
#[derive(Debug, Clone, Copy)]
struct Region {
    centre: [f64; 3],
    half: [f64; 3],
}

impl Region {
    /// Splits the box along its longest edge.
    fn halves(&self) -> [Self; 2] {
        let longest = (1..3).fold(0, |longest, c| {
            if self.half[c] > self.half[longest] {
                c
            } else {
                longest
            }
        });
        [-0.5, 0.5].map(|side| {
            let mut part = *self;
            part.centre[longest] += side * self.half[longest];
            part.half[longest] *= 0.5;
            part
        })
    }
}

/// A box with a bound of its eigenvalues, ordered by the bound.
struct Bounded {
    upper: f64,
    region: Region,
}

impl Ord for Bounded {
    fn cmp(&self, other: &Self) -> Ordering {
        self.upper.total_cmp(&other.upper)
    }
}

impl PartialOrd for Bounded {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Bounded {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Bounded {}

fn dot(theta: [f64; 3], offset: [f64; 3]) -> f64 {
    theta[0] * offset[0] + theta[1] * offset[1] + theta[2] * offset[2]
}

fn add(matrix: &mut Matrix, factor: f64, o: [f64; 3]) {
    for a in 0..3 {
        for b in 0..3 {
            matrix[a][b] += factor * o[a] * o[b];
        }
    }
}

/// Returns M(θ) = Σ 2w(1 − cos θ·o) n⊗n over one spring of each pair.
fn matrix_at(springs: &LatticeSprings, theta: [f64; 3]) -> Matrix {
    let mut matrix = [[0.0; 3]; 3];
    for spring in springs.half() {
        let o = spring.offset.map(f64::from);
        let half = (0.5 * dot(theta, o)).sin();
        add(
            &mut matrix,
            4.0 * spring.stiffness * half * half / dot(o, o),
            o,
        );
    }
    matrix
}

/// Returns the largest eigenvalue at the centre of a box and an upper bound of all eigenvalues in it.
fn bounds_of(springs: &LatticeSprings, region: &Region) -> (f64, f64) {
    let dimension = springs.dimension();
    let zero = [[0.0; 3]; 3];
    let (mut centre, mut rest, mut interval) = (zero, zero, zero);
    let mut slopes = [zero; 3];
    for spring in springs.half() {
        let o = spring.offset.map(f64::from);
        let width = dot(region.half, o.map(f64::abs));
        let (sine, cosine) = dot(region.centre, o).sin_cos();
        let weight = 2.0 * spring.stiffness / dot(o, o);
        add(&mut centre, weight * (1.0 - cosine), o);
        add(&mut rest, weight * 0.5 * width * width, o);
        add(
            &mut interval,
            weight * largest_in_interval(sine, cosine, width),
            o,
        );
        for c in 0..dimension {
            add(&mut slopes[c], weight * sine * o[c] * region.half[c], o);
        }
    }
    let value = largest_eigenvalue(&centre, dimension);
    // Opposite corners differ by the sign of all slopes.
    let corner = |signs: usize| {
        let mut matrix = centre;
        for (c, slope) in slopes.iter().enumerate().take(dimension) {
            let sign = if signs >> c & 1 == 1 { -1.0 } else { 1.0 };
            for a in 0..3 {
                for b in 0..3 {
                    matrix[a][b] += sign * slope[a][b];
                }
            }
        }
        largest_eigenvalue(&matrix, dimension)
    };
    let linear = (0..1 << dimension).map(corner).fold(0.0, f64::max);
    let curved = linear + largest_eigenvalue(&rest, dimension);
    (value, curved.min(largest_eigenvalue(&interval, dimension)))
}

/// Returns the maximum of 1 − cos within `width` of an angle.
fn largest_in_interval(sine: f64, cosine: f64, width: f64) -> f64 {
    // Distance of the angle from the nearest odd multiple of π, where 1 − cos = 2.
    let distance = sine.abs().atan2(-cosine);
    if distance <= width {
        2.0
    } else {
        1.0 + (distance - width).cos()
    }
}

/// Returns the largest eigenvalue of the leading part of a symmetric matrix, in closed form (Smith 1961 in three
/// dimensions).
fn largest_eigenvalue(m: &Matrix, dimension: usize) -> f64 {
    match dimension {
        1 => m[0][0],
        2 => {
            let (mean, half) = (0.5 * (m[0][0] + m[1][1]), 0.5 * (m[0][0] - m[1][1]));
            mean + half.hypot(m[0][1])
        }
        _ => {
            let mean = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
            let d = [m[0][0] - mean, m[1][1] - mean, m[2][2] - mean];
            let off = m[0][1].powi(2) + m[0][2].powi(2) + m[1][2].powi(2);
            let p = ((d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + 2.0 * off) / 6.0).sqrt();
            if p == 0.0 {
                return mean;
            }
            let determinant = d[0] * (d[1] * d[2] - m[1][2].powi(2))
                - m[0][1] * (m[0][1] * d[2] - m[1][2] * m[0][2])
                + m[0][2] * (m[0][1] * m[1][2] - d[1] * m[0][2]);
            let angle = (0.5 * determinant / p.powi(3)).clamp(-1.0, 1.0).acos() / 3.0;
            mean + 2.0 * p * angle.cos()
        }
    }
}

/// Returns the eigenvector of the largest eigenvalue, by repeated squaring of the matrix; for a double eigenvalue
/// any vector of its plane.
fn dominant_vector(matrix: &Matrix, dimension: usize) -> [f64; 3] {
    let mut power = *matrix;
    for _ in 0..30 {
        let scale = max_norm(power.iter().flatten());
        if scale == 0.0 {
            break;
        }
        let before = power.map(|row| row.map(|x| x / scale));
        for a in 0..3 {
            for b in 0..3 {
                power[a][b] = (0..3).map(|c| before[a][c] * before[c][b]).sum();
            }
        }
    }
    let norm = |row: &[f64; 3]| dot(*row, *row).sqrt();
    let largest = power.iter().max_by(|a, b| norm(a).total_cmp(&norm(b)));
    match largest {
        Some(row) if norm(row) > 0.0 => row.map(|x| x / norm(row)),
        _ => std::array::from_fn(|c| f64::from(u8::from(c + 1 == dimension))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operator::LatticeSpring;

    /// A lattice with springs whose stiffness depends on their length.
    fn springs(dimension: usize, reach: f64, stiffness: fn(f64) -> f64) -> LatticeSprings {
        let most = reach.floor() as i32;
        let range = |c: usize| if c < dimension { -most..=most } else { 0..=0 };
        let mut all = Vec::new();
        for x in range(0) {
            for y in range(1) {
                for z in range(2) {
                    let length = f64::from(x * x + y * y + z * z).sqrt();
                    if length > 0.0 && length <= reach {
                        all.push(LatticeSpring {
                            offset: [x, y, z],
                            stiffness: stiffness(length) / length,
                        });
                    }
                }
            }
        }
        LatticeSprings::new(dimension, all).unwrap()
    }

    #[test]
    fn the_bound_is_above_every_plane_wave_and_close_to_the_highest() {
        type Case = (usize, f64, fn(f64) -> f64, i32);
        let cases: [Case; 8] = [
            (1, 1.0, |_| 1.0, 2000),
            (1, 3.0, |_| 1.0, 2000),
            (1, 40.0, |r| (-0.01 * r * r).exp(), 20_000),
            (2, 1.0, |_| 1.0, 100),
            (2, 3.0, |_| 1.0, 200),
            (2, 6.0, |r| 1.0 / r, 200),
            (3, 2.0, |_| 1.0, 40),
            (3, 3.0, |r| 1.0 - r / 3.1, 40),
        ];
        for (dimension, reach, stiffness, samples) in cases {
            let springs = springs(dimension, reach, stiffness);
            // Cubic lattices need only phases in one octant.
            let last = |c: usize| if c < dimension { samples } else { 0 };
            let mut scanned: f64 = 0.0;
            for x in 0..=last(0) {
                for y in 0..=last(1) {
                    for z in 0..=last(2) {
                        let phase = [x, y, z].map(|k| PI * f64::from(k) / f64::from(samples));
                        let matrix = matrix_at(&springs, phase);
                        scanned = scanned.max(largest_eigenvalue(&matrix, dimension));
                    }
                }
            }
            let found = zone_maximum(&springs);
            let ratio = found.bound / scanned;
            assert!(
                (1.0..1.0 + 2.0 * TOLERANCE).contains(&ratio),
                "{dimension}D, reach {reach}: {ratio}"
            );
            let matrix = matrix_at(&springs, found.wave.phase);
            let e = found.wave.polarisation;
            let product = matrix.map(|row| dot(row, e));
            assert!(dot(product, e) >= scanned * (1.0 - 2.0 * TOLERANCE));
        }
    }

    #[test]
    fn the_bound_of_a_nearest_neighbour_chain_is_exact() {
        // ρω² = 2w(1 − cos θ), at most 4w.
        let found = zone_maximum(&springs(1, 1.0, |_| 3.0));
        assert!((12.0..12.0 * (1.0 + TOLERANCE)).contains(&found.bound));
    }

    #[test]
    fn negative_springs_have_no_such_bound() {
        let springs = |stiffness| {
            [1, 2].map(|x| LatticeSpring {
                offset: [x, 0, 0],
                stiffness: if x == 1 { 1.0 } else { stiffness },
            })
        };
        assert!(LatticeSprings::new(1, springs(0.5)).is_some());
        assert!(LatticeSprings::new(1, springs(-0.1)).is_none());
        assert!(LatticeSprings::new(1, springs(f64::NAN)).is_none());
    }
}
