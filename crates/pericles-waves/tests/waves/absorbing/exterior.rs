//! Initial fields that extend beyond the absorbing boundary.

use pericles::round_trip::check_resume;
use pericles::time::{State, VelocityVerlet};
use pericles::{Control, Simulation, System};
use pericles_waves::absorbing::history::{BlockedHistory, History};
use pericles_waves::absorbing::{
    AbsorbingEnd, AbsorbingError, FreeWave, GhostKernels, OuterLayer, Side, factor_kernels,
};

use crate::absorbing::bar::{DX, bar, difference, run};

const DT: f64 = 0.2;
const STEPS: u64 = 300;

/// Bell around the right end of a bar with 201 nodes, with initial velocity.
fn bell(x: f64) -> [f64; 2] {
    let bell = (-(x - 9.0).powi(2)).exp();
    [bell, 0.5 * (x - 9.0) * bell]
}

fn start(system: &System) -> State {
    let mut state = State::at_rest(system.points());
    for (i, x) in system.cloud().axis(0).iter().enumerate() {
        [state.u[i], state.v[i]] = bell(*x);
    }
    state
}

fn with_ends() -> Simulation {
    let mut small = bar(100, 0.5);
    let state = start(&small);
    for side in [Side::Left, Side::Right] {
        let layer = OuterLayer::with_motion_beyond(&small, side, &[]).unwrap();
        let stencil = layer.stencil.clone();
        let kernels = GhostKernels::shift(factor_kernels(&stencil, DT, STEPS as usize));
        let history = || -> Box<dyn History> { Box::new(BlockedHistory::new(kernels.clone())) };
        let mut end = AbsorbingEnd::new(layer, history(), DT).unwrap();
        if side == Side::Right {
            let sites = (1..=100).map(|n| bell(10.0 + n as f64 * DX));
            let (u, v): (Vec<f64>, Vec<f64>) = sites.map(|[u, v]| (u, v)).unzip();
            let wave = FreeWave::new(&stencil, DT, [&u, &v], [1.0; 2], [history(), history()]);
            end = end.with_free_wave(wave.unwrap());
        }
        small.add_boundary(Box::new(end));
    }
    Simulation::new(small, Box::new(VelocityVerlet), state, DT, STEPS).unwrap()
}

#[test]
fn initial_field_beyond_the_boundary_enters_and_leaves() {
    let large = bar(100 + 500, 0.5);
    let state = start(&large);
    let large = run(large, state, DT, STEPS);
    let mut small = with_ends();
    small.run(|_| Control::Continue).unwrap();
    let error = difference(large.state(), small.state());
    assert!(error < 1e-12, "{error:e}");
}

#[test]
fn exterior_field_resumes_bit_for_bit() {
    check_resume(with_ends, [120]).unwrap();
}

#[test]
fn exterior_field_that_does_not_decay_is_an_error() {
    let layer = OuterLayer::with_motion_beyond(&bar(60, 1.0), Side::Left, &[]).unwrap();
    let kernels = GhostKernels::shift(factor_kernels(&layer.stencil, DT, 10));
    let history = || -> Box<dyn History> { Box::new(BlockedHistory::new(kernels.clone())) };
    let (u, v) = (vec![1.0; 30], vec![0.0; 30]);
    let wave =
        |u: &[f64], body| FreeWave::new(&layer.stencil, DT, [u, &v], body, [history(), history()]);
    // A field that is negligible compared with that of the body is accepted, even if it does not decay.
    assert!(wave(&[8e-21; 30], [1.0, 0.0]).is_ok());
    assert!(matches!(
        wave(&u, [1.0, 0.0]).err(),
        Some(AbsorbingError::ExteriorData {
            sites: 30,
            found: 1.0,
            ..
        })
    ));
}
