//! How far the phase speeds of a lattice's waves are from a reference.

use std::f64::consts::PI;

use super::bisection::last_before;
use super::continuum::KernelWaves;
use super::lattice::BondLattice;
use super::modes::modes_of;
use super::vector::{Vector, unit};

/// Phase speeds of the plane waves of a lattice, of all branches and over directions of the whole octant, against a reference: the speed of long waves along the same direction, or
/// the nonlocal continuum that the lattice stands for.
///
/// With the first as reference, errors are all the dispersion there is; with the second they are what the grid adds to the dispersion of the kernel. Both are measured relative to the
/// speed of long waves, so that an error of the modulus does not count.
pub struct PhaseErrors<'a> {
    lattice: &'a BondLattice,
    /// Directions with the speeds of long waves along them, slowest first, m/s.
    directions: Vec<(Vector, Vec<f64>)>,
    continuum: Option<&'a KernelWaves>,
}

/// The shortest waves whose speed is within a tolerance of the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolved {
    /// Largest deviation of the phase speed, relative.
    pub tolerance: f64,
    /// Largest wavenumber, rad/m; the end of the zone along an axis if the tolerance is not exceeded before.
    pub wavenumber: f64,
    /// The lowest angular frequency of these waves, 1/s.
    pub frequency: f64,
}

/// Steps from long waves to the end of the zone.
const STEPS: usize = 200;

impl<'a> PhaseErrors<'a> {
    /// Against the speed of long waves.
    pub fn new(lattice: &'a BondLattice) -> Self {
        let speeds = |n: Vector| {
            let limit = modes_of(&lattice.long_wave_matrix(n), lattice.dimension());
            limit.iter().map(|mode| mode.omega()).collect()
        };
        let directions = directions(lattice);
        Self {
            lattice,
            directions: directions.into_iter().map(|n| (n, speeds(n))).collect(),
            continuum: None,
        }
    }

    /// Against the nonlocal continuum.
    pub fn of_grid(lattice: &'a BondLattice, continuum: &'a KernelWaves) -> Self {
        Self {
            continuum: Some(continuum),
            ..Self::new(lattice)
        }
    }

    /// The end of the zone along the axis with the largest spacing, rad/m.
    pub fn end(&self) -> f64 {
        let spacing = self.lattice.spacing();
        PI / spacing.into_iter().fold(0.0, f64::max)
    }

    /// The largest relative error of the phase speed at a wavenumber (rad/m), 1 where waves grow.
    pub fn error(&self, wavenumber: f64) -> f64 {
        // Slowest first, as modes are; shear waves in space are two.
        let reference = self.continuum.map(|continuum| {
            let mut speeds = continuum.relative_speeds(wavenumber);
            speeds.reverse();
            while speeds.len() < self.lattice.dimension() {
                speeds.insert(0, speeds[0]);
            }
            speeds
        });
        let mut worst = 0.0f64;
        for (n, long) in &self.directions {
            let modes = self.lattice.modes(n.map(|c| c * wavenumber));
            let fastest = long.last().copied().unwrap_or(0.0);
            for (branch, mode) in modes.iter().enumerate() {
                // A lattice of nearest neighbours carries no shear along its axes.
                if long[branch] <= 1e-6 * fastest {
                    continue;
                }
                let speed = mode.omega_squared.max(0.0).sqrt() / wavenumber;
                let expected = reference.as_ref().map_or(1.0, |speeds| speeds[branch]);
                let error = (speed / long[branch] / expected - 1.0).abs();
                worst = worst.max(if error.is_finite() { error } else { 1.0 });
            }
        }
        worst
    }

    /// The largest error of all waves up to a wavenumber (rad/m).
    pub fn largest(&self, wavenumber: f64) -> f64 {
        let steps = (1..=STEPS).map(|k| wavenumber * k as f64 / STEPS as f64);
        steps.map(|k| self.error(k)).fold(0.0, f64::max)
    }

    /// The waves that are within a tolerance, with all longer ones.
    pub fn resolved(&self, tolerance: f64) -> Resolved {
        let wavenumber = last_before(self.end(), STEPS, |k| self.error(k) > tolerance);
        let slowest = |(n, _): &(Vector, Vec<f64>)| {
            let modes = self.lattice.modes(n.map(|c| c * wavenumber));
            let moving = modes.iter().map(|mode| mode.omega_squared);
            moving
                .filter(|square| *square > 0.0)
                .fold(f64::INFINITY, f64::min)
        };
        let squares = self.directions.iter().map(slowest);
        Resolved {
            tolerance,
            wavenumber,
            frequency: squares.fold(f64::INFINITY, f64::min).sqrt(),
        }
    }
}

/// Unit vectors over the octant; of square and cubic lattices those between an axis and a diagonal.
fn directions(lattice: &BondLattice) -> Vec<Vector> {
    let cubic = lattice.is_cubic();
    let all: Vec<Vector> = match lattice.dimension() {
        1 => vec![[1.0, 0.0, 0.0]],
        2 => (0..=if cubic { 4 } else { 8 })
            .map(|k| {
                let (s, c) = (f64::from(k) * PI / 16.0).sin_cos();
                [c, s, 0.0]
            })
            .collect(),
        _ => {
            let steps = [0.0, 1.0, 2.0];
            let mut all = Vec::new();
            for x in steps {
                for y in steps {
                    for z in steps {
                        let ordered = x >= y && y >= z;
                        // (2, 0, 0) and (2, 2, 0) are (1, 0, 0) and (1, 1, 0).
                        let twice = [x, y, z].iter().all(|c| *c != 1.0);
                        if x + y + z > 0.0 && !twice && (ordered || !cubic) {
                            all.push([x, y, z]);
                        }
                    }
                }
            }
            all
        }
    };
    all.into_iter().map(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::kernel::Influence;

    #[test]
    fn a_chain_of_nearest_neighbours() {
        // ω/k = sin(k/2)/(k/2) falls by 1 % at k = 0.4906.
        let chain = BondLattice::new(&[1.0], 1.0, |_, _, _| 1.0).unwrap();
        let errors = PhaseErrors::new(&chain);
        let found = errors.resolved(0.01);
        assert!((found.wavenumber - 0.4906).abs() < 1e-4, "{found:?}");
        assert!((found.frequency - 2.0 * (0.5 * found.wavenumber).sin()).abs() < 1e-12);
        assert!((errors.largest(PI) - (1.0 - 2.0 / PI)).abs() < 1e-12);
        // With no limit the whole zone.
        assert_eq!(errors.resolved(1.0).wavenumber, PI);
    }

    #[test]
    fn a_finer_grid_adds_less_to_the_kernel_s_dispersion() {
        let influence = Influence::default();
        let horizon = 1.0;
        let continuum = KernelWaves::new(2, &influence, horizon, 40.0).unwrap();
        let lattice = |m: f64| {
            let dx = horizon / m;
            BondLattice::new(&[dx, dx], horizon + 0.5 * dx, |_, _, r| {
                pericles::family::VolumeCorrection::Extended.factor(r, horizon, dx)
            })
            .unwrap()
        };
        let (coarse, fine) = (lattice(3.0), lattice(9.0));
        let grid = [&coarse, &fine].map(|l| PhaseErrors::of_grid(l, &continuum).resolved(0.05));
        let whole = [&coarse, &fine].map(|l| PhaseErrors::new(l).resolved(0.05));
        // What the grid adds goes away, what the kernel does stays.
        assert!(grid[1].wavenumber > 2.0 * grid[0].wavenumber, "{grid:?}");
        let ratio = whole[1].wavenumber / whole[0].wavenumber;
        assert!((0.8..1.25).contains(&ratio), "{whole:?}");
        assert!(
            grid[0].wavenumber > whole[0].wavenumber,
            "{grid:?} {whole:?}"
        );
    }

    #[test]
    fn octants_of_cubic_lattices_are_cut_down() {
        let count = |spacing: &[f64]| {
            let lattice = BondLattice::new(spacing, 2.0, |_, _, _| 1.0).unwrap();
            directions(&lattice).len()
        };
        assert_eq!([count(&[1.0; 2]), count(&[1.0, 0.9])], [5, 9]);
        assert_eq!([count(&[1.0; 3]), count(&[1.0, 1.0, 0.9])], [6, 19]);
    }
}
