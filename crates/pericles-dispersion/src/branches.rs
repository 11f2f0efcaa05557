//! Dispersion branches along a contour: frequencies, phase and group velocities.

use super::contour::{Contour, Segment};
use super::lattice::BondLattice;
use super::vector::{Vector, dot, unit};

/// One branch at one wave vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BranchPoint {
    /// ω², 1/s²; negative if unstable.
    pub omega_squared: f64,
    /// Unit vector.
    pub polarisation: Vector,
    /// Group velocity ∂ω/∂k, m/s; at k = 0 along the contour.
    pub group_velocity: Vector,
    /// Phase velocity ω/|k|, m/s; the limit at k = 0.
    pub phase_velocity: f64,
}

impl BranchPoint {
    /// Returns ω, 1/s; NaN if unstable.
    pub fn omega(&self) -> f64 {
        self.omega_squared.sqrt()
    }
}

/// All branches at one wave vector.
#[derive(Debug, Clone, PartialEq)]
pub struct ContourPoint {
    /// Arc length along the contour, rad/m.
    pub abscissa: f64,
    /// The wave vector, rad/m.
    pub k: Vector,
    /// Index of the segment.
    pub segment: usize,
    /// Branches, in the order of the contour's branches.
    pub branches: Vec<BranchPoint>,
}

/// Computes the branches at `steps + 1` equally spaced points of every segment. Corners appear twice, once for each
/// segment, because the group velocity along the contour differs.
///
/// Where symmetry does not determine the polarisation, a branch follows the eigenvector closest to that of the
/// previous point; at the start the most longitudinal one is the pressure branch.
pub fn trace(lattice: &BondLattice, contour: &Contour, steps: usize) -> Vec<ContourPoint> {
    let mut points = Vec::new();
    let mut start = 0.0;
    for (number, segment) in contour.segments.iter().enumerate() {
        let mut before: Option<Vec<Vector>> = None;
        let steps = steps.max(1);
        for step in 0..=steps {
            let distance = segment.length() * step as f64 / steps as f64;
            let k = segment.at(distance);
            let polarisations = match &segment.polarisation {
                Some(fixed) => fixed.clone(),
                None => tracked(lattice, segment, k, before.as_deref()),
            };
            let branch = |e: &Vector| branch_point(lattice, segment, k, *e);
            points.push(ContourPoint {
                abscissa: start + distance,
                k,
                segment: number,
                branches: polarisations.iter().map(branch).collect(),
            });
            before = Some(polarisations);
        }
        start += segment.length();
    }
    points
}

fn branch_point(lattice: &BondLattice, segment: &Segment, k: Vector, e: Vector) -> BranchPoint {
    let omega_squared = lattice.omega_squared(k, e);
    let square = dot(k, k);
    if is_origin(lattice, k) {
        let n = segment.direction();
        let matrix = lattice.long_wave_matrix(n);
        let speed = dot(e, matrix.map(|row| dot(row, e))).sqrt();
        return BranchPoint {
            omega_squared: 0.0,
            polarisation: e,
            group_velocity: n.map(|x| x * speed),
            phase_velocity: speed,
        };
    }
    let omega = omega_squared.sqrt();
    let gradient = lattice.omega_squared_gradient(k, e);
    BranchPoint {
        omega_squared,
        polarisation: e,
        group_velocity: gradient.map(|x| x / (2.0 * omega)),
        phase_velocity: omega / square.sqrt(),
    }
}

fn is_origin(lattice: &BondLattice, k: Vector) -> bool {
    dot(k, k).sqrt() * lattice.spacing()[0] < 1e-9
}

/// Returns the eigenvectors at k in the order of the previous ones.
fn tracked(
    lattice: &BondLattice,
    segment: &Segment,
    k: Vector,
    before: Option<&[Vector]>,
) -> Vec<Vector> {
    let n = segment.direction();
    let modes = if is_origin(lattice, k) {
        super::modes::modes_of(&lattice.long_wave_matrix(n), lattice.dimension())
    } else {
        lattice.modes(k)
    };
    let mut left: Vec<Vector> = modes.iter().map(|mode| mode.polarisation).collect();
    let Some(before) = before else {
        left.sort_by(|a, b| dot(*b, n).abs().total_cmp(&dot(*a, n).abs()));
        return left.iter().map(|e| oriented(*e, n)).collect();
    };
    let pick = |wanted: &Vector| {
        let likeness = |e: &Vector| dot(*e, *wanted).abs();
        let best =
            (0..left.len()).max_by(|a, b| likeness(&left[*a]).total_cmp(&likeness(&left[*b])));
        best.map_or(*wanted, |found| oriented(left.swap_remove(found), *wanted))
    };
    before.iter().map(pick).collect()
}

fn oriented(e: Vector, like: Vector) -> Vector {
    if dot(e, like) < 0.0 { e.map(|x| -x) } else { e }
}

/// Long-wave speeds along a direction: pressure first, then shear.
pub fn long_wave_speeds(lattice: &BondLattice, direction: Vector) -> Vec<f64> {
    let n = lattice.unit_direction(direction);
    let mut modes = super::modes::modes_of(&lattice.long_wave_matrix(n), lattice.dimension());
    modes.sort_by(|a, b| b.longitudinal(n).total_cmp(&a.longitudinal(n)));
    modes.iter().map(super::Mode::omega).collect()
}

/// Long-wave speeds in one direction of the plane of two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct PolarSpeeds {
    /// Angle from the first axis, rad.
    pub angle: f64,
    /// Pressure, then shear speeds, m/s.
    pub speeds: Vec<f64>,
}

/// Computes the long-wave speeds in `count` directions of the plane spanned by two orthogonal vectors.
pub fn polar_speeds(lattice: &BondLattice, plane: [Vector; 2], count: usize) -> Vec<PolarSpeeds> {
    let [a, b] = plane.map(unit);
    let at = |step: usize| {
        let angle = std::f64::consts::TAU * step as f64 / count as f64;
        let (s, c) = angle.sin_cos();
        let n = std::array::from_fn(|axis| c * a[axis] + s * b[axis]);
        PolarSpeeds {
            angle,
            speeds: long_wave_speeds(lattice, n),
        }
    };
    (0..count).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> BondLattice {
        // Plane strain model with a constant influence function, N = 3, D = V = 1.
        let c = 48.0 / (5.0 * std::f64::consts::PI * 27.0);
        BondLattice::new(&[1.0, 1.0], 3.0 + 1e-9, |_, _, _| c).unwrap()
    }

    #[test]
    fn group_velocity_is_the_derivative_of_frequency() {
        let lattice = square();
        for contour in [
            Contour::irreducible(&lattice),
            Contour::ray(&lattice, [2.0, 1.0, 0.0]),
        ] {
            let points = trace(&lattice, &contour, 400);
            for triple in points.windows(3) {
                if triple[0].segment != triple[2].segment {
                    continue;
                }
                for b in 0..2 {
                    let [before, here, after] =
                        [0, 1, 2].map(|p: usize| triple[p].branches[b].omega());
                    if here < 0.05 {
                        continue;
                    }
                    let slope = (after - before) / (triple[2].abscissa - triple[0].abscissa);
                    let n = contour.segments[triple[1].segment].direction();
                    let group = dot(triple[1].branches[b].group_velocity, n);
                    assert!((slope - group).abs() < 2e-4, "{slope} {group}");
                }
            }
        }
    }

    #[test]
    fn tracked_branches_agree_with_symmetry_along_the_diagonal() {
        let lattice = square();
        let ray = trace(&lattice, &Contour::ray(&lattice, [1.0, 1.0, 0.0]), 50);
        let e = 0.5f64.sqrt();
        for point in &ray {
            let [p, s] = [[e, e, 0.0], [e, -e, 0.0]].map(|e| lattice.omega_squared(point.k, e));
            assert!((point.branches[0].omega_squared - p).abs() < 1e-12);
            assert!((point.branches[1].omega_squared - s).abs() < 1e-12);
        }
        let start = &ray[0].branches;
        assert!((start[0].phase_velocity / 1.2f64.sqrt() - 1.0144).abs() < 5e-5);
        assert!((start[1].phase_velocity / 0.4f64.sqrt() - 1.0376).abs() < 5e-5);
    }

    #[test]
    fn polar_speeds_have_the_symmetry_of_the_square() {
        let polar = polar_speeds(&square(), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], 16);
        for step in 0..16 {
            for b in 0..2 {
                let quarter = polar[(step + 4) % 16].speeds[b];
                assert!((polar[step].speeds[b] - quarter).abs() < 1e-12);
            }
        }
    }
}
