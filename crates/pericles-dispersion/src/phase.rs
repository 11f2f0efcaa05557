//! Phase-speed errors of lattice waves relative to a reference.

use std::f64::consts::PI;

use super::bisection::last_before;
use super::continuum::KernelWaves;
use super::lattice::BondLattice;
use super::modes::modes_of;
use super::vector::{Vector, unit};

/// Phase-speed errors of the plane waves of a lattice over all branches and directions of the octant. The reference
/// is the speed of long waves along the same direction, or the nonlocal continuum that the lattice discretises.
///
/// With the first reference the errors are the total dispersion, with the second the dispersion added by the grid.
/// Both are relative to the speed of long waves, so an error of the modulus does not count.
pub struct PhaseErrors<'a> {
    lattice: &'a BondLattice,
    /// Directions with their long-wave speeds in ascending order, m/s.
    directions: Vec<(Vector, Vec<f64>)>,
    continuum: Option<&'a KernelWaves>,
}

/// The shortest waves whose speed is within a tolerance of the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolved {
    /// Largest relative deviation of the phase speed.
    pub tolerance: f64,
    /// Largest wavenumber, rad/m; the zone border along an axis if the tolerance is not exceeded before.
    pub wavenumber: f64,
    /// Lowest angular frequency of these waves, 1/s.
    pub frequency: f64,
}

/// Number of steps from zero to the zone border.
const STEPS: usize = 200;

impl<'a> PhaseErrors<'a> {
    /// Creates the errors relative to the speed of long waves.
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

    /// Creates the errors relative to the nonlocal continuum.
    pub fn of_grid(lattice: &'a BondLattice, continuum: &'a KernelWaves) -> Self {
        Self {
            continuum: Some(continuum),
            ..Self::new(lattice)
        }
    }

    /// Zone border along the axis with the largest spacing, rad/m.
    pub fn end(&self) -> f64 {
        let spacing = self.lattice.spacing();
        PI / spacing.into_iter().fold(0.0, f64::max)
    }

    /// Returns the largest relative error of the phase speed at a wavenumber (rad/m); 1 where waves are unstable.
    pub fn error(&self, wavenumber: f64) -> f64 {
        // Ascending, like the modes; in 3D there are two shear waves.
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
                // A nearest-neighbour lattice has no shear stiffness along its axes.
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

    /// Returns the largest error of all waves up to a wavenumber (rad/m).
    pub fn largest(&self, wavenumber: f64) -> f64 {
        let steps = (1..=STEPS).map(|k| wavenumber * k as f64 / STEPS as f64);
        steps.map(|k| self.error(k)).fold(0.0, f64::max)
    }

    /// Returns the shortest waves that are within a tolerance together with all longer ones.
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

/// Unit vectors over the octant; for square and cubic lattices those between an axis and a diagonal.
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
                        // Skips multiples: (2, 0, 0) and (2, 2, 0) equal (1, 0, 0) and (1, 1, 0).
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
    fn nearest_neighbour_chain_has_the_closed_form_of_resolution() {
        // ω/k = sin(k/2)/(k/2) falls by 1 % at k = 0.4906.
        let chain = BondLattice::new(&[1.0], 1.0, |_, _, _| 1.0).unwrap();
        let errors = PhaseErrors::new(&chain);
        let found = errors.resolved(0.01);
        assert!((found.wavenumber - 0.4906).abs() < 1e-4, "{found:?}");
        assert!((found.frequency - 2.0 * (0.5 * found.wavenumber).sin()).abs() < 1e-12);
        assert!((errors.largest(PI) - (1.0 - 2.0 / PI)).abs() < 1e-12);
        // With tolerance 1 the whole zone.
        assert_eq!(errors.resolved(1.0).wavenumber, PI);
    }

    #[test]
    fn grid_dispersion_decreases_with_refinement_and_kernel_dispersion_does_not() {
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
        // The dispersion of the grid decreases, the dispersion of the kernel stays.
        assert!(grid[1].wavenumber > 2.0 * grid[0].wavenumber, "{grid:?}");
        let ratio = whole[1].wavenumber / whole[0].wavenumber;
        assert!((0.8..1.25).contains(&ratio), "{whole:?}");
        assert!(
            grid[0].wavenumber > whole[0].wavenumber,
            "{grid:?} {whole:?}"
        );
    }

    #[test]
    fn cubic_lattices_need_only_directions_between_axis_and_diagonal() {
        let count = |spacing: &[f64]| {
            let lattice = BondLattice::new(spacing, 2.0, |_, _, _| 1.0).unwrap();
            directions(&lattice).len()
        };
        assert_eq!([count(&[1.0; 2]), count(&[1.0, 0.9])], [5, 9]);
        assert_eq!([count(&[1.0; 3]), count(&[1.0, 1.0, 0.9])], [6, 19]);
    }
}
