//! What of a disturbance a lattice carries without distorting it.
//!
//! Waves of a lattice travel at the speed of long waves only if they are long. [`Carried`] is where the phase velocity first leaves a band around that speed; [`time_content`] and [`space_content`] tell which
//! share of the energy that a load or an initial field sends out lies beyond it.

use realfft::RealFftPlanner;

use super::{BondLattice, Contour, ContourPoint, trace};
use crate::space::PointCloud;

/// The shortest waves that a lattice carries within a tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Carried {
    /// Largest deviation of the phase velocity from that of long waves, relative.
    pub tolerance: f64,
    /// Largest wavenumber, rad/m.
    pub wavenumber: f64,
    /// Highest angular frequency, 1/s.
    pub frequency: f64,
}

/// Steps along a ray to the border of the zone.
const STEPS: usize = 400;

impl Carried {
    /// The waves along the x axis, of the branch that leaves the band first.
    pub fn of(lattice: &BondLattice, tolerance: f64) -> Self {
        let ray = trace(lattice, &Contour::ray(lattice, [1.0, 0.0, 0.0]), STEPS);
        let deviates = |point: &ContourPoint| {
            let branches = point.branches.iter().zip(&ray[0].branches);
            branches
                .map(|(branch, long)| branch.phase_velocity / long.phase_velocity - 1.0)
                .any(|deviation| deviation.abs() > tolerance)
        };
        // Without any deviation the border of the zone.
        let last = ray.iter().position(deviates).unwrap_or(ray.len() - 1);
        let omegas = ray[last].branches.iter().map(|branch| branch.omega());
        Self {
            tolerance,
            wavenumber: ray[last].k[0],
            frequency: omegas.fold(f64::INFINITY, f64::min),
        }
    }
}

/// The share of the energy of a signal g(t), 0 ≤ t ≤ `end`, zero before, that lies above an angular frequency: Σ|ĝ|² above it over Σ|ĝ|² of all but the mean.
///
/// A load that sets in suddenly has a spectrum ~ 1/ω, so that a small share is always beyond any frequency. Of signals longer than 2048 periods of that frequency the first so many are judged.
pub fn time_content(g: impl Fn(f64) -> f64, end: f64, frequency: f64) -> f64 {
    const MOST: f64 = 16384.0;
    // Eight samples for the shortest period that counts.
    let rate = 4.0 * frequency / std::f64::consts::PI;
    let samples = (rate * end).ceil().clamp(64.0, MOST);
    let dt = (end / samples).min(if rate > 0.0 {
        1.0 / rate
    } else {
        f64::INFINITY
    });
    let samples = samples as usize;
    // Rest before the start; then there and back again, so that the end is no jump.
    let mut signal = vec![0.0; samples];
    signal.extend((0..samples).map(|k| g((k as f64 + 0.5) * dt)));
    let mut planner = RealFftPlanner::new();
    let [beyond, all] = energies_of(&mut planner, &mirrored(&signal), frequency * dt, false);
    if all > 0.0 { beyond / all } else { 0.0 }
}

/// The share of the energy of a field on a body's lattice that lies beyond a wavenumber (rad/m), along the worst of the axes: of the strain Σ k²|û|² if
/// `strain`, else of Σ|v̂|²; none for a body without a lattice or a field that is the same everywhere.
///
/// `field` is component-major. Lines of points along an axis are continued as if mirrored at their ends.
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
    let mut worst: Option<f64> = None;
    // Lines of one length share a plan.
    let mut planner = RealFftPlanner::new();
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
            let component = &field[c * n..(c + 1) * n];
            for run in order
                .chunk_by(|&i, &j| line(i)[..2] == line(j)[..2] && line(j)[2] == line(i)[2] + 1)
            {
                let values: Vec<f64> = run.iter().map(|&i| component[i]).collect();
                let [beyond, all] = energies_of(
                    &mut planner,
                    &mirrored(&values),
                    wavenumber * cloud.spacing(),
                    strain,
                );
                energies[0] += beyond;
                energies[1] += all;
            }
        }
        if energies[1] > 0.0 {
            let share = energies[0] / energies[1];
            worst = Some(worst.map_or(share, |worst| worst.max(share)));
        }
    }
    worst
}

fn mirrored(values: &[f64]) -> Vec<f64> {
    values.iter().chain(values.iter().rev()).copied().collect()
}

/// Energy beyond `limit` (rad per sample) and of all but the mean.
fn energies_of(
    planner: &mut RealFftPlanner<f64>,
    signal: &[f64],
    limit: f64,
    strain: bool,
) -> [f64; 2] {
    let n = signal.len();
    let transform = planner.plan_fft_forward(n);
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
    use crate::space::{Grid, Shape};

    #[test]
    fn a_chain_carries_what_its_dispersion_says() {
        // ω/k = sin(k/2)/(k/2) falls by 1 % at k = 0.4906
        let chain = BondLattice::new(&[1.0], 1.0, |_, _, _| 1.0).unwrap();
        let carried = Carried::of(&chain, 0.01);
        assert!((carried.wavenumber - 0.4906).abs() < 0.01, "{carried:?}");
        assert!((carried.frequency - 2.0 * (0.5 * carried.wavenumber).sin()).abs() < 1e-12);
        // with no limit the whole zone
        let all = Carried::of(&chain, 1.0);
        assert!((all.wavenumber - std::f64::consts::PI).abs() < 1e-9);
    }

    #[test]
    fn a_sine_is_on_one_side_and_a_jump_on_both() {
        let share = |omega: f64| {
            time_content(
                |t| (20.0 * t).sin(),
                10.0 * std::f64::consts::TAU / 20.0,
                omega,
            )
        };
        assert!(share(40.0) < 1e-2, "{}", share(40.0));
        assert!(share(10.0) > 0.95, "{}", share(10.0));
        // |ĝ|² ~ 1/ω² of a jump: ten times the frequency, a tenth of the share
        let jump = |omega: f64| time_content(|_| 1.0, 1.0, omega);
        let ratio = jump(100.0) / jump(1000.0);
        assert!((8.0..12.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn fields_are_judged_along_every_axis() {
        let plate = Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: vec![64.0, 32.0],
            },
            spacing: 1.0,
            section: 1.0,
            holes: vec![],
        };
        let cloud = plate.points().unwrap();
        let n = cloud.len();
        let wave = |k: f64, axis: usize| -> Vec<f64> {
            let mut field: Vec<f64> = (0..n).map(|i| (k * cloud.point(i)[axis]).cos()).collect();
            field.resize(2 * n, 0.0);
            field
        };
        // cosines of half waves fit the mirrored lines exactly
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
}
