//! Strips that are periodic across and semi-infinite along their length.

use std::collections::HashMap;
use std::sync::Arc;

use pericles::family::VolumeCorrection;
use pericles::round_trip::check_resume;
use pericles::space::{Grid, Shape};
use pericles::time::{State, VelocityVerlet};
use pericles::{Control, PointScalar, Simulation, System};
use pericles_waves::absorbing::factor_kernels;
use pericles_waves::absorbing::strip::{StripEnd, StripLattice};
use pericles_waves::absorbing::{AbsorbingError, GhostKernels, LatticeStencil, Side};
use pericles_waves::linear::ConvolutionForce;

use crate::absorbing::bar::{BOTH, bar};

const ROWS: usize = 10;
const REACH: usize = 3;
const DT: f64 = 0.35;

/// Columns −half … half with ten rows, periodic across: ρ = 1, horizon three cells of size 1.
fn strip(half: usize) -> System {
    let columns = 2 * half + 1;
    let grid = Grid {
        shape: Shape::Box {
            origin: [-(half as f64) - 0.5, 0.0, 0.0],
            size: vec![columns as f64, ROWS as f64],
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    let cloud = Arc::new(grid.points().unwrap());
    let stiffness = |xi: [f64; 3]| 0.15 * (-(xi[0] * xi[0] + xi[1] * xi[1]) / 6.0).exp();
    let force = ConvolutionForce::<2>::with_stiffness(
        cloud.clone(),
        REACH as f64 + 0.01,
        VolumeCorrection::None,
        stiffness,
        [false, true],
    );
    System::new(cloud, Box::new(force.unwrap()), PointScalar::Uniform(1.0)).unwrap()
}

/// Asymmetric, off-centre bell with an oblique displacement.
fn start(system: &System) -> State {
    let mut state = State::at_rest(2 * system.points());
    let n = system.points();
    for i in 0..n {
        let [x, y] = [0, 1].map(|axis| system.cloud().axis(axis)[i]);
        let bell = (-(x * x + (y - 4.2).powi(2)) / 5.0).exp();
        state.u[i] = bell;
        state.u[n + i] = 0.4 * bell;
        state.v[n + i] = 0.3 * bell;
    }
    state
}

fn with_ends(half: usize, steps: usize) -> Simulation {
    let mut system = strip(half);
    let state = start(&system);
    for side in BOTH {
        let lattice = StripLattice::of(&system, side).unwrap();
        assert_eq!((lattice.reach(), lattice.rows()), (REACH, ROWS));
        let kernels = lattice.kernels(DT, steps);
        let end = StripEnd::new(lattice, side, state.u.len(), &kernels);
        system.add_boundary(Box::new(end));
    }
    Simulation::new(system, Box::new(VelocityVerlet), state, DT, steps as u64).unwrap()
}

#[test]
fn truncated_strip_equals_a_large_strip() {
    let (half, steps) = (20, 160);
    let mut small = with_ends(half, steps);
    small.run(|_| Control::Continue).unwrap();
    let energies = small.snapshot().energies();
    assert!(energies.work < -0.5 * energies.initial, "{energies:?}");
    assert!(energies.balance().abs() < 1e-11 * energies.initial);

    // The largest wave speed is two columns per unit of time.
    let large = strip(half + steps * 2 * 35 / 200 + 60);
    let state = start(&large);
    let mut large =
        Simulation::new(large, Box::new(VelocityVerlet), state, DT, steps as u64).unwrap();
    large.run(|_| Control::Continue).unwrap();
    let place = |run: &Simulation, i: usize| {
        let at = run.system().cloud().point(i);
        [at[0], at[1]].map(|x| (2.0 * x).round() as i64)
    };
    let count = |run: &Simulation| run.system().points();
    let numbers: HashMap<_, _> = (0..count(&large)).map(|i| (place(&large, i), i)).collect();
    let mut worst = 0.0_f64;
    for i in 0..count(&small) {
        let j = numbers[&place(&small, i)];
        for c in 0..2 {
            let (i, j) = (c * count(&small) + i, c * count(&large) + j);
            for (a, b) in [
                (small.state().u[i], large.state().u[j]),
                (small.state().v[i], large.state().v[j]),
            ] {
                worst = worst.max((a - b).abs());
            }
        }
    }
    assert!(worst < 1e-12, "{worst:e}");
}

#[test]
fn zeroth_mode_of_a_strip_decouples_into_bars() {
    let lattice = StripLattice::of(&strip(10), Side::Right).unwrap();
    let steps = 120;
    let kernels = &lattice.kernels(DT, steps)[0];
    // The components decouple; the weights of each are sums of the bonds to whole columns.
    let system = strip(10);
    let n = system.points();
    for (c, size) in [(0, 0.15), (1, 0.15)] {
        let mut unit = vec![0.0; 2 * n];
        for i in 0..n {
            if system.cloud().axis(0)[i].abs() < 0.1 {
                unit[c * n + i] = size;
            }
        }
        let mut force = vec![0.0; 2 * n];
        system
            .operator()
            .add_force(0.0, &unit, pericles::operator::PointSubset::All, &mut force);
        let weight = |d: usize| {
            let at = |i: &usize| (system.cloud().axis(0)[*i] - d as f64).abs() < 0.1;
            force[c * n + (0..n).find(at).unwrap()] / size
        };
        // For transverse motion the bonds along three columns have no stiffness.
        let reach = REACH - c;
        let weights: Vec<f64> = (1..=reach).map(weight).collect();
        let stencil = LatticeStencil::new(&weights).unwrap();
        let bar = GhostKernels::shift(factor_kernels(&stencil, DT, steps)).expanded();
        for ghost in 0..reach {
            for m in 0..reach {
                let series = |a: usize| &kernels.series()[(2 * ghost + c) * 2 * REACH + 2 * m + a];
                for j in 0..=steps {
                    let apart = series(c)[j] - bar.series()[ghost * reach + m][j];
                    assert!(apart.abs() < 1e-13, "{apart:e}");
                    assert!(series(1 - c)[j].abs() < 1e-14);
                }
            }
        }
    }
}

#[test]
fn resumed_run_is_bit_for_bit_equal() {
    let steps = 100;
    check_resume(|| with_ends(14, steps), [70]).unwrap();
}

#[test]
fn bodies_that_are_not_strips_are_errors() {
    let error = StripLattice::of(&bar(20, 1.0), Side::Left).unwrap_err();
    assert!(matches!(error, AbsorbingError::NotAStrip { .. }));
    let error = StripLattice::of(&strip(2), Side::Left).unwrap_err();
    assert!(error.to_string().contains("two horizons"), "{error}");
}
