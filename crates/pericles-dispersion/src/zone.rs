//! Stability and highest frequency over the whole Brillouin zone.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::lattice::BondLattice;
use super::modes::modes_of;
use super::vector::{Vector, dot};

/// Result of a scan of the zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stability {
    /// Smallest ω²/|k|² of any wave, m²/s²; the lattice is stable if it is positive.
    pub smallest: f64,
    /// Wave vector of the smallest value, rad/m; for the long-wave limit a unit vector (1/m).
    pub smallest_at: Vector,
    /// Highest frequency, 1/s.
    pub omega_max: f64,
    /// Wave vector of the highest frequency, rad/m.
    pub omega_max_at: Vector,
}

impl Stability {
    /// Returns true if all waves are stable.
    pub fn is_stable(&self) -> bool {
        self.smallest > 0.0
    }

    /// Largest stable time step of velocity Verlet, 2/ω_max, s.
    pub fn dt_max(&self) -> f64 {
        2.0 / self.omega_max
    }
}

/// Samples along an axis, by dimension.
const SAMPLES: [usize; 3] = [2001, 181, 61];

/// Scans the zone: by symmetry one octant on a regular grid of 2001, 181² or 61³ wave vectors, then a local search
/// from the best of them; long waves by their limit. Cubic lattices need only k_x ≥ k_y ≥ k_z.
pub fn stability(lattice: &BondLattice) -> Stability {
    let dimension = lattice.dimension();
    let samples = SAMPLES[dimension - 1];
    let cubic = lattice.is_cubic();
    let step: Vector = std::array::from_fn(|c| {
        if c < dimension {
            PI / lattice.spacing()[c] / (samples - 1) as f64
        } else {
            0.0
        }
    });
    let rows: Vec<(Extreme, Extreme)> = (0..samples)
        .into_par_iter()
        .map(|x| {
            let last = |c: usize, before: usize| match (c < dimension, cubic) {
                (false, _) => 0,
                (true, true) => before,
                (true, false) => samples - 1,
            };
            let mut best = (Extreme::NONE, Extreme::NONE);
            for y in 0..=last(1, x) {
                for z in 0..=last(2, y) {
                    if x + y + z > 0 {
                        let k = std::array::from_fn(|c| [x, y, z][c] as f64 * step[c]);
                        let modes = lattice.modes(k);
                        best.0.offer(-modes[0].omega_squared / dot(k, k), k);
                        best.1.offer(modes[dimension - 1].omega_squared, k);
                    }
                }
            }
            best
        })
        .collect();
    let mut low = Extreme::NONE;
    let mut high = Extreme::NONE;
    for (a, b) in rows {
        low.offer(a.value, a.at);
        high.offer(b.value, b.at);
    }
    let edge = step.map(|s| s * (samples - 1) as f64);
    low.refine(step, edge, |k| -slowest(lattice, k));
    high.refine(step, edge, |k| highest(lattice, k));
    for n in directions(dimension) {
        let limit = modes_of(&lattice.long_wave_matrix(n), dimension)[0].omega_squared;
        low.offer(-limit, n);
    }
    Stability {
        smallest: -low.value,
        smallest_at: low.at,
        omega_max: high.value.max(0.0).sqrt(),
        omega_max_at: high.at,
    }
}

fn slowest(lattice: &BondLattice, k: Vector) -> f64 {
    lattice.modes(k)[0].omega_squared / dot(k, k)
}

fn highest(lattice: &BondLattice, k: Vector) -> f64 {
    lattice.modes(k)[lattice.dimension() - 1].omega_squared
}

/// Directions over an octant, one degree apart in 2D and three in 3D.
fn directions(dimension: usize) -> Vec<Vector> {
    match dimension {
        1 => vec![[1.0, 0.0, 0.0]],
        2 => (0..=90)
            .map(|degree| {
                let (s, c) = f64::from(degree).to_radians().sin_cos();
                [c, s, 0.0]
            })
            .collect(),
        _ => (0..=30)
            .flat_map(|theta| {
                (0..=30).map(move |phi| (3.0 * f64::from(theta), 3.0 * f64::from(phi)))
            })
            .map(|(theta, phi)| {
                let (s, c) = theta.to_radians().sin_cos();
                let (sp, cp) = phi.to_radians().sin_cos();
                [s * cp, s * sp, c]
            })
            .collect(),
    }
}

/// Largest value found.
#[derive(Clone, Copy)]
struct Extreme {
    value: f64,
    at: Vector,
}

impl Extreme {
    const NONE: Self = Self {
        value: f64::NEG_INFINITY,
        at: [0.0; 3],
    };

    fn offer(&mut self, value: f64, at: Vector) {
        if value > self.value {
            *self = Self { value, at };
        }
    }

    /// Compass search within the octant from the best grid point, to a step of 1e-7 of the grid spacing. The
    /// origin, where ω²/|k|² is undefined, is excluded.
    fn refine(&mut self, step: Vector, edge: Vector, function: impl Fn(Vector) -> f64) {
        let mut size = 0.5;
        while size > 1e-7 {
            let centre = *self;
            for c in 0..3 {
                for sign in [-1.0, 1.0] {
                    let mut at = centre.at;
                    at[c] = (at[c] + sign * size * step[c]).clamp(0.0, edge[c]);
                    if step[c] > 0.0 && dot(at, at) > 0.25 * dot(step, step) {
                        self.offer(function(at), at);
                    }
                }
            }
            if self.value == centre.value {
                size *= 0.5;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_neighbour_chain_has_the_closed_form_extremes() {
        let chain = BondLattice::new(&[0.5], 0.5, |_, _, _| 3.0).unwrap();
        // ω² = 2 · 3 (1 − cos k/2) / 0.5, highest at k = 2π; ω²/k² falls from 3·0.5 to ω²/(2π)².
        let found = stability(&chain);
        assert!((found.omega_max - 24f64.sqrt()).abs() < 1e-12);
        assert!((found.smallest - 24.0 / (2.0 * PI).powi(2)).abs() < 1e-9);
        assert!(found.is_stable() && (found.dt_max() - 2.0 / 24f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn negative_second_neighbours_make_long_waves_unstable() {
        // ω²/k² → ½·2(1·1 − 0.6·2) < 0.
        let chain = BondLattice::new(
            &[1.0],
            2.0,
            |offset, _, _| {
                if offset[0] == 1 { 1.0 } else { -0.6 }
            },
        )
        .unwrap();
        let found = stability(&chain);
        assert!(!found.is_stable());
        assert!((found.smallest + 0.2).abs() < 1e-5, "{}", found.smallest);
    }

    #[test]
    fn rectangular_lattices_are_scanned_over_the_whole_octant() {
        // Bonds along the axes only: ω_x² = 4a/dx sin², largest for the smaller spacing.
        let lattice = BondLattice::new(&[1.0, 0.5], 1.0, |offset, _, _| {
            // The bonds (±1, 0) and (0, ±1).
            f64::from(u8::from(offset[0].abs() + offset[1].abs() == 1))
        })
        .unwrap();
        let found = stability(&lattice);
        assert!((found.omega_max - (4.0f64 / 0.5).sqrt()).abs() < 1e-9);
    }
}
