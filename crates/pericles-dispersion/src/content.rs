//! Fraction of the energy of a load or an initial field in short waves.
//!
//! [`PhaseErrors`](super::PhaseErrors) gives the shortest waves that a lattice represents within a tolerance;
//! [`time_content`] and [`space_content`] give the fraction of the energy of a load or an initial field in waves
//! shorter than these.

use nalgebra::DMatrix;
use pericles::space::PointCloud;
use pericles_waves::fourier::RealPlanner;

/// Returns the fraction of the energy of a signal g(t), 0 ≤ t ≤ `end`, zero before, above an angular frequency:
/// Σ|ĝ|² above it divided by Σ|ĝ|² without the mean.
///
/// A suddenly applied load has a spectrum ~ 1/ω, so a small fraction lies beyond any frequency. Signals longer than
/// 2048 periods of that frequency are truncated to 2048 periods.
pub fn time_content(g: impl Fn(f64) -> f64, end: f64, frequency: f64) -> f64 {
    const MOST: f64 = 16384.0;
    // Eight samples per shortest period of interest.
    let rate = 4.0 * frequency / std::f64::consts::PI;
    let samples = (rate * end).ceil().clamp(64.0, MOST);
    let dt = (end / samples).min(if rate > 0.0 {
        1.0 / rate
    } else {
        f64::INFINITY
    });
    let samples = samples as usize;
    // Rest before the start; then the signal forwards and backwards, so that its end does not introduce a jump.
    let mut signal = vec![0.0; samples];
    signal.extend((0..samples).map(|k| g((k as f64 + 0.5) * dt)));
    let mut planner = RealPlanner::default();
    let [beyond, all] = energies_of(&mut planner, &mirrored(&signal), frequency * dt, false);
    if all > 0.0 { beyond / all } else { 0.0 }
}

/// Returns the fraction of the energy of a lattice field beyond a wavenumber (rad/m), along the worst of the axes:
/// of the strain Σ k²|û|² if `strain`, else of Σ|v̂|². `None` for a body without a lattice or a field without
/// energy, such as a rigid motion.
///
/// `field` is component-major. The affine part of a displacement is a uniform strain and a rotation: the strain
/// counts as a long wave, the rotation has no energy. Lines of points along an axis are extended by reflection at
/// their ends, or periodically if the body is periodic.
pub fn space_content(
    cloud: &PointCloud,
    field: &[f64],
    wavenumber: f64,
    strain: bool,
) -> Option<f64> {
    let lattice = cloud.lattice()?;
    let (n, dimension) = (cloud.len(), cloud.dimension());
    if (0..dimension).all(|c| field[c * n..(c + 1) * n].iter().all(|x| *x == field[c * n])) {
        return None;
    }
    let coordinates: Vec<[i32; 3]> = lattice
        .node
        .iter()
        .map(|&node| lattice.coordinates(node))
        .collect();
    // A periodic field has no affine part; removing its mean slope would introduce a jump at the faces.
    let affine = (!cloud.is_periodic()).then(|| Affine::of(cloud, field));
    let rest = affine
        .as_ref()
        .map_or_else(|| field.to_vec(), |affine| affine.without(cloud, field));
    let dx = cloud.spacing();
    let noise = ROUND_OFF * field.iter().map(|x| x * x).sum::<f64>();
    let mut worst: Option<f64> = None;
    // Lines of equal length share an FFT plan.
    let mut planner = RealPlanner::default();
    for axis in 0..dimension {
        let mut order: Vec<usize> = (0..n).collect();
        let line = |i: usize| {
            let mut key = coordinates[i];
            key.swap(0, axis);
            [key[1], key[2], key[0]]
        };
        order.sort_unstable_by_key(|&i| line(i));
        let mut energies = [0.0; 2];
        for c in 0..dimension {
            let component = &rest[c * n..(c + 1) * n];
            for run in order
                .chunk_by(|&i, &j| line(i)[..2] == line(j)[..2] && line(j)[2] == line(i)[2] + 1)
            {
                let values: Vec<f64> = run.iter().map(|&i| component[i]).collect();
                let (signal, copies) = if cloud.is_periodic() {
                    (values, 1.0)
                } else {
                    (mirrored(&values), 2.0)
                };
                let found = energies_of(&mut planner, &signal, wavenumber * dx, strain);
                // By Parseval's theorem equal to the sum over the points of the line.
                let share = 2.0 / (signal.len() as f64 * copies);
                energies[0] += share * found[0];
                energies[1] += share * found[1];
            }
        }
        if let Some(affine) = &affine {
            energies[1] += if strain {
                dx * dx * n as f64 * affine.strain_energy(axis)
            } else {
                affine.kinetic
            };
        }
        if energies[1] > noise {
            let share = energies[0] / energies[1];
            worst = Some(worst.map_or(share, |worst| worst.max(share)));
        }
    }
    worst
}

/// Energy along an axis, as a fraction of Σ|u|², below which it is round-off: for a rotation, or along an axis on
/// which the field does not depend.
const ROUND_OFF: f64 = 1e-24;

/// Affine field closest to a field in the least-squares sense.
struct Affine {
    /// Centroid of the points, m, and the mean of the field.
    middle: Vec<f64>,
    mean: Vec<f64>,
    /// Matrix A of the affine field A (x − centroid) + mean, row by component.
    gradient: DMatrix<f64>,
    /// Σ|A (x − centroid)|² over all points.
    kinetic: f64,
}

impl Affine {
    fn of(cloud: &PointCloud, field: &[f64]) -> Self {
        let (n, dimension) = (cloud.len(), cloud.dimension());
        let mean_of = |values: &[f64]| values.iter().sum::<f64>() / n as f64;
        let middle: Vec<f64> = (0..dimension).map(|c| mean_of(cloud.axis(c))).collect();
        let mean: Vec<f64> = field.chunks(n).map(mean_of).collect();
        let product = |a: &[f64], a0: f64, b: usize| -> f64 {
            let pairs = a.iter().zip(cloud.axis(b));
            pairs.map(|(a, x)| (a - a0) * (x - middle[b])).sum()
        };
        let spread = DMatrix::from_fn(dimension, dimension, |a, b| {
            product(cloud.axis(a), middle[a], b)
        });
        let moved = DMatrix::from_fn(dimension, dimension, |c, b| {
            product(&field[c * n..(c + 1) * n], mean[c], b)
        });
        let largest = spread.amax();
        // A body one point thick does not determine the slope across it.
        let inverse = spread.clone().pseudo_inverse(1e-12 * largest);
        let gradient = inverse.map_or_else(
            |_| DMatrix::zeros(dimension, dimension),
            |inverse| moved * inverse,
        );
        let kinetic = (&gradient * spread * gradient.transpose()).trace();
        Self {
            middle,
            mean,
            gradient,
            kinetic,
        }
    }

    /// Returns the field without its affine part.
    fn without(&self, cloud: &PointCloud, field: &[f64]) -> Vec<f64> {
        let (n, dimension) = (cloud.len(), cloud.dimension());
        let value = |c: usize, i: usize| -> f64 {
            let slopes =
                (0..dimension).map(|b| self.gradient[(c, b)] * (cloud.axis(b)[i] - self.middle[b]));
            self.mean[c] + slopes.sum::<f64>()
        };
        (0..dimension)
            .flat_map(|c| (0..n).map(move |i| (c, i)))
            .map(|(c, i)| field[c * n + i] - value(c, i))
            .collect()
    }

    /// Returns Σ_c E_ca² of the Green–Lagrange strain E = ½ (A + Aᵀ + AᵀA), which vanishes for a rotation.
    fn strain_energy(&self, axis: usize) -> f64 {
        let a = &self.gradient;
        let strain = 0.5 * (a + a.transpose() + a.transpose() * a);
        strain.column(axis).norm_squared()
    }
}

fn mirrored(values: &[f64]) -> Vec<f64> {
    values.iter().chain(values.iter().rev()).copied().collect()
}

/// Returns the energy beyond `limit` (rad per sample), and the total without the mean.
fn energies_of(planner: &mut RealPlanner, signal: &[f64], limit: f64, strain: bool) -> [f64; 2] {
    let n = signal.len();
    let transform = planner.forward(n);
    let mut input = signal.to_vec();
    let mut output = transform.make_output_vec();
    if transform.process(&mut input, &mut output).is_err() {
        return [0.0; 2];
    }
    let mut energies = [0.0; 2];
    for (k, amplitude) in output.iter().enumerate().skip(1) {
        let theta = std::f64::consts::TAU * k as f64 / n as f64;
        let weight = if strain { theta * theta } else { 1.0 };
        let energy = weight * amplitude.norm_sqr();
        energies[1] += energy;
        if theta > limit {
            energies[0] += energy;
        }
    }
    energies
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::space::{Grid, Shape};

    #[test]
    fn time_content_of_a_sine_and_of_a_jump() {
        let share = |omega: f64| {
            time_content(
                |t| (20.0 * t).sin(),
                10.0 * std::f64::consts::TAU / 20.0,
                omega,
            )
        };
        assert!(share(40.0) < 1e-2, "{}", share(40.0));
        assert!(share(10.0) > 0.95, "{}", share(10.0));
        // A jump has |ĝ|² ~ 1/ω²: at ten times the frequency a tenth of the fraction.
        let jump = |omega: f64| time_content(|_| 1.0, 1.0, omega);
        let ratio = jump(100.0) / jump(1000.0);
        assert!((8.0..12.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn space_content_uses_the_worst_axis() {
        let cloud = grid([64.0, 32.0]);
        let n = cloud.len();
        let wave = |k: f64, axis: usize| -> Vec<f64> {
            let mut field: Vec<f64> = (0..n).map(|i| (k * cloud.point(i)[axis]).cos()).collect();
            field.resize(2 * n, 0.0);
            field
        };
        // Half-wave cosines fit the reflected lines exactly.
        let k = std::f64::consts::PI / 64.0;
        for (times, beyond) in [(8.0, 0.0), (24.0, 1.0)] {
            for axis in [0, 1] {
                let field = wave(times * k, axis);
                for strain in [false, true] {
                    let share = space_content(&cloud, &field, 16.0 * k, strain).unwrap();
                    assert!((share - beyond).abs() < 1e-9, "{times} {axis} {share}");
                }
            }
        }
        assert_eq!(space_content(&cloud, &vec![2.0; 2 * n], k, false), None);
    }

    fn grid(size: [f64; 2]) -> PointCloud {
        let grid = Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: size.to_vec(),
            },
            spacing: 1.0,
            section: 1.0,
            holes: vec![],
        };
        grid.points().unwrap()
    }

    #[test]
    fn rigid_motions_have_no_short_waves() {
        // Few cells across, so that every line along y is shorter than the waves in question.
        let cloud = grid([40.0, 6.0]);
        let n = cloud.len();
        let field = |u: &dyn Fn(f64, f64) -> [f64; 2]| -> Vec<f64> {
            let at = |i: usize| u(cloud.axis(0)[i], cloud.axis(1)[i]);
            (0..2).flat_map(|c| (0..n).map(move |i| at(i)[c])).collect()
        };
        let (s, c) = 0.3f64.sin_cos();
        let rotated = field(&|x, y| [c * x - s * y - x + 2.0, s * x + c * y - y]);
        assert_eq!(space_content(&cloud, &rotated, 0.1, true), None);
        let strained = field(&|x, y| [1e-3 * x, 2e-4 * y]);
        assert!(space_content(&cloud, &strained, 0.1, true).unwrap() < 1e-20);
        let spinning = field(&|x, y| [-30.0 * y, 30.0 * x]);
        assert!(space_content(&cloud, &spinning, 0.1, false).unwrap() < 1e-20);
    }

    #[test]
    fn space_content_of_a_periodic_wave_is_independent_of_the_transverse_size() {
        for across in [4.0, 5.0, 24.0] {
            let cloud = grid([48.0, across]).with_periodic_faces().unwrap();
            let n = cloud.len();
            let k = std::f64::consts::TAU / 24.0;
            let mut wave: Vec<f64> = cloud.axis(0).iter().map(|x| (k * x).sin()).collect();
            wave.resize(2 * n, 0.0);
            for strain in [false, true] {
                let share = |limit: f64| space_content(&cloud, &wave, limit, strain).unwrap();
                assert!(share(1.1 * k) < 1e-20, "{across}");
                assert!((share(0.9 * k) - 1.0).abs() < 1e-12, "{across}");
            }
        }
    }
}
