//! A truncated body with absorbing boundaries moves as the infinite one.

use std::sync::Arc;

use pericles::boundary::{Load, TimeFunction};
use pericles::family::{BondList, VolumeCorrection};
use pericles::material::LinearBond;
use pericles::operator::{BondForce, Breaking, DamageMeasure};
use pericles::round_trip::check_resume;
use pericles::space::{Grid, Shape};
use pericles::time::{State, VelocityVerlet};
use pericles::{
    Archive, Checkpointed, Control, PericlesError, PointScalar, Simulation, SimulationError,
    System, Values,
};
use pericles_waves::absorbing::history::{DirectHistory, ExponentialHistory, History};
use pericles_waves::absorbing::{
    AbsorbingError, ExponentialKernels, GhostKernels, LatticeStencil, LatticeStep, OuterLayer, Side,
};

use crate::absorbing::bar::{
    BOTH, DX, add_ends, bar, blocked, difference, gaussian, pulse, run, weights,
};

#[test]
fn truncated_bar_equals_the_large_bar() {
    for (dt, steps, beta) in [
        (0.01, 4000, 1.0),
        (0.1, 700, 0.5),
        (0.2, 400, 0.1),
        (0.249, 300, 1.0),
    ] {
        let half = 100;
        // The largest wave speed is ten nodes per unit of time; beyond the front, fields decay within some tens of
        // nodes.
        let margin = (5.0 * dt * steps as f64) as usize + 120;
        let large = bar(half + margin, beta);
        let state = pulse(&large, 2.0);
        let large = run(large, state, dt, steps);
        let mut small = bar(half, beta);
        // The pulse at x = 2 is 1e-28 at the ends.
        let state = pulse(&small, 2.0);
        add_ends(&mut small, &state, &BOTH, dt, steps, blocked);
        let small = run(small, state, dt, steps);
        let error = difference(large.state(), small.state());
        assert!(error < 1e-12, "dt = {dt}, beta = {beta}: {error:e}");
        // The energy balance closes: the energy that left is the work of the boundaries.
        let energies = small.snapshot().energies();
        let balance = energies.balance().abs() / energies.initial;
        assert!(balance < 1e-12, "{balance:e}");
        assert!(energies.work < 0.0);
    }
}

/// Takes some minutes: `cargo test -p pericles-waves --release -- --ignored`.
#[test]
#[ignore = "long"]
fn truncated_bar_equals_the_large_bar_in_a_long_run() {
    let steps = 10_000;
    for (dt, beta) in [
        (0.01, 1.0),
        (0.05, 0.5),
        (0.1, 0.1),
        (0.249, 1.0),
        (0.249, 0.5),
    ] {
        let margin = (5.0 * dt * steps as f64) as usize + 120;
        let large = bar(100 + margin, beta);
        let state = pulse(&large, 2.0);
        let large = run(large, state, dt, steps);
        let mut small = bar(100, beta);
        let state = pulse(&small, 2.0);
        add_ends(&mut small, &state, &BOTH, dt, steps, blocked);
        let small = run(small, state, dt, steps);
        let error = difference(large.state(), small.state());
        eprintln!("dt = {dt}, beta = {beta}: {error:e}");
        assert!(error < 1e-12, "dt = {dt}, beta = {beta}: {error:e}");
    }
}

#[test]
fn absorbing_boundary_opposite_a_free_end_equals_a_large_bar() {
    let (dt, steps, half) = (0.1, 300, 100);
    let right = |margin: usize| {
        // The right end is free in both; the left one is absorbing, or far away.
        let nodes = 2 * half + 1 + margin;
        let cloud = Grid {
            shape: Shape::Box {
                origin: [-((half + margin) as f64 + 0.5) * DX, 0.0, 0.0],
                size: vec![nodes as f64 * DX],
            },
            spacing: DX,
            section: 1.0,
            holes: vec![],
        };
        let cloud = Arc::new(cloud.points().unwrap());
        let bonds = BondList::new(&cloud, 0.75, VolumeCorrection::None).unwrap();
        let breaking = Breaking {
            critical_stretch: f64::INFINITY,
            no_fail: &[],
        };
        let force = BondForce::<LinearBond, 1>::with_stiffness(
            cloud.clone(),
            bonds,
            &|xi| gaussian(xi[0].abs()) * xi[0].abs(),
            breaking,
            DamageMeasure::default(),
        )
        .unwrap();
        let mut system = System::new(cloud, Box::new(force), PointScalar::Uniform(1.0)).unwrap();
        // A force in the middle instead of an initial field.
        system
            .add_load(Load::new(
                vec![(half + margin) as u32],
                [3.0, 0.0, 0.0],
                TimeFunction::Pulse {
                    start: 0.0,
                    duration: 5.0,
                },
            ))
            .unwrap();
        system
    };
    let large = right(1700);
    let state = State::at_rest(large.points());
    let large = run(large, state, dt, steps);
    let mut small = right(0);
    let state = State::at_rest(small.points());
    add_ends(&mut small, &state, &[Side::Left], dt, steps, blocked);
    let small = run(small, state, dt, steps);
    let error = large.state().u[1700..]
        .iter()
        .zip(&small.state().u)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(error < 1e-12, "{error:e}");
    let energies = small.snapshot().energies();
    assert!(energies.balance().abs() < 1e-12 * small.system().ledger().exchanged);
}

fn direct(kernels: GhostKernels) -> Box<dyn History> {
    Box::new(DirectHistory::new(kernels))
}

/// Exponential history in place of the kernels.
fn exponentials(_: GhostKernels) -> Box<dyn History> {
    let stencil = LatticeStencil::new(&weights()).unwrap();
    Box::new(ExponentialHistory::new(
        ExponentialKernels::fit(&stencil, LatticeStep::verlet(0.1), 333, 1e-8).unwrap(),
    ))
}

#[test]
fn resumed_run_is_bit_for_bit_equal() {
    for history in [blocked, direct, exponentials] {
        stopped_and_resumed(history);
    }
}

fn stopped_and_resumed(history: fn(GhostKernels) -> Box<dyn History>) {
    let (dt, steps) = (0.1, 333);
    let make = || {
        let mut system = bar(60, 0.5);
        let state = pulse(&system, 0.0);
        add_ends(&mut system, &state, &BOTH, dt, steps, history);
        Simulation::new(system, Box::new(VelocityVerlet), state, dt, steps).unwrap()
    };
    check_resume(make, [150]).unwrap();
}

#[test]
fn history_of_another_step_is_an_error() {
    let (dt, steps) = (0.1, 333);
    let make = || {
        let mut system = bar(60, 0.5);
        let state = pulse(&system, 0.0);
        add_ends(&mut system, &state, &BOTH, dt, steps, blocked);
        Simulation::new(system, Box::new(VelocityVerlet), state, dt, steps).unwrap()
    };
    let mut first = make();
    first
        .run(|s| match s.state().step {
            150 => Control::Stop,
            _ => Control::Continue,
        })
        .unwrap();
    let mut archive = Archive::default();
    first.save(&mut archive);
    let histories: Vec<(String, Vec<f64>)> = archive
        .arrays()
        .iter()
        .filter(|(name, _)| name.ends_with("/past"))
        .map(|(name, _)| (name.clone(), archive.f64s(name).unwrap().to_vec()))
        .collect();
    assert_eq!(histories.len(), 2);
    // As many steps as fit the run, but not this state: continuing would exceed their arrays.
    for (name, past) in histories {
        let sites = past.len() / 151;
        for known in [0, 149, 152, 334] {
            let mut spoilt = archive.clone();
            spoilt.put(name.clone(), Values::F64(vec![0.0; sites * known]));
            let told = make().restore(&spoilt).unwrap_err().to_string();
            assert!(told.contains("after step 150"), "{told}");
        }
    }
}

#[test]
fn bodies_that_the_exterior_cannot_continue_are_errors() {
    use AbsorbingError as E;
    assert_eq!(LatticeStencil::new(&[]), Err(E::EmptyStencil));
    assert_eq!(
        LatticeStencil::new(&[1.0, 0.0]),
        Err(E::OutermostWeightZero { reach: 2 })
    );
    assert!(matches!(
        LatticeStencil::new(&[1.0, -2.0]),
        Err(E::UnstableStencil { .. })
    ));
    let stencil = LatticeStencil::new(&weights()).unwrap();
    assert!(stencil.check_step(0.2499).is_ok());
    assert!(
        matches!(stencil.check_step(0.251), Err(E::UnstableStep { limit, .. }) if (limit - 0.25).abs() < 1e-5)
    );

    let layer = |system: &System, state: &State| OuterLayer::of(system, Side::Right, state, &[]);
    // The soft part extends into the layer: the error names the first deviating bond.
    let soft = bar(43, 0.5);
    let rest = State::at_rest(soft.points());
    let error = layer(&soft, &rest).unwrap_err();
    assert!(
        matches!(error, E::LayerBond { side: "+x", found, expected, needed: 7, .. } if (found / expected - 0.5).abs() < 1e-9),
        "{error}"
    );
    let plain = bar(60, 1.0);
    let near = pulse(&plain, 2.0);
    assert!(matches!(
        layer(&plain, &near),
        Err(E::NotAtRest { point: 114, .. })
    ));
    let mut loaded = bar(60, 1.0);
    loaded
        .add_load(Load::new(
            vec![3, 118],
            [1.0, 0.0, 0.0],
            TimeFunction::Constant,
        ))
        .unwrap();
    let rest = State::at_rest(loaded.points());
    assert!(matches!(
        layer(&loaded, &rest),
        Err(E::LayerActedOn { point: 118, .. })
    ));
    // More steps than the kernels have.
    let mut short = bar(60, 1.0);
    add_ends(&mut short, &rest, &BOTH, 0.1, 50, blocked);
    let mut run = Simulation::new(short, Box::new(VelocityVerlet), rest, 0.1, 51).unwrap();
    assert!(matches!(
        run.run(|_| Control::Continue),
        Err(SimulationError::Misfit(PericlesError::BoundarySteps {
            steps: 51,
            made_for: 50
        }))
    ));
}
