//! Static states: reference values, energy balance, errors, resumed runs.

use std::sync::Arc;

use pericles::boundary::{MotionKind, PrescribedMotion};
use pericles::material::{Strains, StressState};
use pericles::prelude::*;
use pericles::round_trip;
use pericles_statics::{StaticOptions, StaticScheme, StaticsError};

use crate::bodies::{Solid, plate_with_hole, points, pulled_plate};

/// A run of load steps to t = 1.
fn run(system: System, options: StaticOptions, steps: u64) -> Simulation {
    let scheme = StaticScheme::new(options, &system).unwrap();
    let state = State::of(&system);
    let dt = 1.0 / steps as f64;
    let mut run = Simulation::new(system, Box::new(scheme), state, dt, steps).unwrap();
    run.run_to_end().unwrap();
    run
}

/// The plate with a hole, stretched by 5 %: rows within 3.01 spacings of both ends have the prescribed
/// displacement u = (0, 0.05 y).
pub fn stretched_plate(cells: usize) -> System {
    let solid = Solid {
        cloud: plate_with_hole(cells),
        poisson_ratio: 1.0 / 3.0,
        state: StressState::PlaneStress,
        strains: Strains::Finite,
        cracks: vec![],
    };
    let mut system = solid.system();
    let cloud = system.cloud().clone();
    let dx = cloud.spacing();
    for upper in [false, true] {
        let grip = points(&cloud, |x| {
            let y = if upper { x[1] } else { -x[1] };
            y > 0.5 - 3.01 * dx
        });
        let places = grip.iter().map(|&i| 0.05 * cloud.point(i as usize)[1]);
        let along = [
            Some(pericles::boundary::AxisMotion::Uniform(0.0)),
            Some(pericles::boundary::AxisMotion::PerPoint(places.collect())),
            None,
        ];
        let motion = PrescribedMotion::along(
            "grip".into(),
            grip,
            MotionKind::Displacement,
            along,
            TimeFunction::Constant,
            &vec![0.0; 2 * cloud.len()],
            cloud.len(),
        );
        system.add_motion(motion.unwrap()).unwrap();
    }
    system
}

#[test]
fn reaction_and_energy_at_five_percent_stretch_match_the_reference() {
    // Computed independently (dense Newton, NumPy): E = 1, ν = 1/3, a = 0.1, N = 3.
    for (cells, reaction, energy) in [
        (40, 0.04878958291, 0.001208053384102),
        (80, 0.04808603341, 0.001192023273853),
    ] {
        let options = StaticOptions {
            tolerance: 1e-8,
            ..StaticOptions::default()
        };
        let run = run(stretched_plate(cells), options, 1);
        let (system, state) = (run.system(), run.state());
        let found = system.motions()[1].reaction(system.cloud())[1];
        let stored = system.operator().energy(1.0, &state.u);
        let inner = run.integrator().inner_iterations().unwrap();
        println!("{cells}: {found} {stored} {inner:?}");
        assert!((found / reaction - 1.0).abs() < 1e-6, "{found}");
        assert!((stored / energy - 1.0).abs() < 1e-6, "{stored}");
        // The work of the constraints is integrated over intermediate static states.
        let balance = run.snapshot().energies().balance();
        assert!(balance.abs() < 1e-6 * stored, "{}", balance / stored);
    }
}

#[test]
fn energy_balance_of_a_linear_body_closes_to_the_tolerance_in_one_step() {
    let run = run(pulled_plate(40, 0.25, vec![]), StaticOptions::default(), 1);
    let energies = run.snapshot().energies();
    assert!(energies.elastic > 0.0);
    assert!(energies.balance().abs() < 1e-6 * energies.work);
}

/// A bond-based bar with a force at the right end, fixed at the left end if `fixed`.
fn bar(fixed: bool) -> System {
    let dx = 0.01;
    let bar = Arc::new(Grid::bar(1.0, dx, 1.0).points().unwrap());
    let material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0 * dx);
    let end = points(&bar, |x| x[0] > 1.0 - 3.0 * dx);
    let start = points(&bar, |x| x[0] < 3.0 * dx);
    let pull = |set: PointSet, force: f64| {
        let density = force / (set.len() as f64 * dx);
        Load::new(set, [density, 0.0, 0.0], TimeFunction::Constant)
    };
    let body = Body::new(bar, material).load(pull(end, 0.01));
    let body = if fixed {
        body.motion(PrescribedMotion::fixed(start, 1))
    } else {
        body.load(pull(start, -0.01))
    };
    body.build().unwrap()
}

#[test]
fn energy_balance_of_a_bar_under_constant_load_closes_in_one_step() {
    let run = run(bar(true), StaticOptions::default(), 1);
    let energies = run.snapshot().energies();
    assert!(energies.elastic > 0.0);
    let part = energies.balance() / energies.work;
    assert!(part.abs() < 1e-6, "{part}");
    // Uniform strain F/EA in the middle.
    let u = &run.state().u;
    let strain = (u[60] - u[40]) / 0.2;
    assert!((strain / 0.01 - 1.0).abs() < 1e-2, "{strain}");
}

#[test]
fn errors_of_unconstrained_bodies_contain_the_free_motions() {
    let rejected = |system: &System| match StaticScheme::new(StaticOptions::default(), system) {
        Err(PericlesError::Extension(error)) => match *error.downcast::<StaticsError>().unwrap() {
            StaticsError::Unconstrained { motions, .. } => motions,
            other => panic!("{other}"),
        },
        other => panic!("{other:?}"),
    };
    assert_eq!(rejected(&bar(false)), ["translation along x"]);
    let solid = Solid {
        cloud: plate_with_hole(20),
        poisson_ratio: 0.25,
        state: StressState::PlaneStress,
        strains: Strains::Small,
        cracks: vec![],
    };
    let free = solid.system();
    let all = [
        "translation along x",
        "translation along y",
        "rotation about z",
    ];
    assert_eq!(rejected(&free), all);
    let mut pinned = solid.system();
    pinned
        .add_motion(PrescribedMotion::fixed(vec![7], 2))
        .unwrap();
    assert_eq!(rejected(&pinned), ["rotation about z"]);
}

#[test]
fn free_body_under_balanced_loads_deforms_like_a_constrained_body() {
    let options = StaticOptions {
        fix_rigid_modes: true,
        tolerance: 1e-9,
        ..StaticOptions::default()
    };
    let free = run(bar(false), options, 1);
    let u = &free.state().u;
    let strain = (u[60] - u[40]) / 0.2;
    assert!((strain / 0.01 - 1.0).abs() < 1e-2, "{strain}");
    let mean = u.iter().sum::<f64>() / u.len() as f64;
    assert!(mean.abs() < 1e-9 * u[99], "{mean}");
}

#[test]
fn unbalanced_loads_on_a_free_body_are_errors() {
    let mut system = bar(false);
    let all = (0..system.points() as u32).collect();
    let load = Load::new(all, [1e-3, 0.0, 0.0], TimeFunction::Constant);
    system.add_load(load).unwrap();
    let options = StaticOptions {
        fix_rigid_modes: true,
        ..StaticOptions::default()
    };
    let scheme = StaticScheme::new(options, &system).unwrap();
    let state = State::of(&system);
    let mut run = Simulation::new(system, Box::new(scheme), state, 1.0, 1).unwrap();
    let error = run.run_to_end().unwrap_err().to_string();
    assert!(error.contains("not in balance"), "{error}");
}

/// Loads that are in balance except for a small resultant, as from the pressure on the faces of a mesh, stretch a free body as
/// balanced ones do; the resultant is reported.
#[test]
fn a_small_resultant_of_the_loads_on_a_free_body_is_left_out() {
    let run_of = |excess: f64| {
        let mut system = bar(false);
        let all = (0..system.points() as u32).collect();
        let load = Load::new(all, [excess, 0.0, 0.0], TimeFunction::Constant);
        system.add_load(load).unwrap();
        let options = StaticOptions {
            fix_rigid_modes: true,
            ..StaticOptions::default()
        };
        let scheme = StaticScheme::new(options, &system).unwrap();
        let state = State::of(&system);
        let mut run = Simulation::new(system, Box::new(scheme), state, 1.0, 1).unwrap();
        run.run_to_end().map(|_| run)
    };
    let stretch = |run: &Simulation| run.state().u.last().unwrap() - run.state().u[0];
    let balanced = run_of(0.0).unwrap();
    assert_eq!(balanced.integrator().remark(), None);
    let nearly = run_of(1e-4).unwrap();
    let remark = nearly.integrator().remark().unwrap();
    assert!(remark.contains("not exactly in balance"), "{remark}");
    let ratio = stretch(&nearly) / stretch(&balanced);
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
    assert!(run_of(1e-3).is_err());
}

/// A bond-based bar that breaks, in tension in four load steps.
pub fn torn_bar() -> Simulation {
    let dx = 0.02;
    let bar = Arc::new(Grid::bar(1.0, dx, 1.0).points().unwrap());
    let fracture = 2e-6;
    let material =
        BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0 * dx).with_fracture_energy(fracture);
    let ramp = TimeFunction::Ramp {
        start: 0.0,
        duration: 1.0,
    };
    let start = points(&bar, |x| x[0] < 3.0 * dx);
    let end = points(&bar, |x| x[0] > 1.0 - 3.0 * dx);
    let system = Body::new(bar, material)
        .motion(PrescribedMotion::fixed(start, 1))
        .motion(PrescribedMotion::displacement(
            end,
            [Some(0.02), None, None],
            ramp,
        ))
        .build()
        .unwrap();
    let scheme = StaticScheme::new(StaticOptions::default(), &system).unwrap();
    let state = State::of(&system);
    Simulation::new(system, Box::new(scheme), state, 0.25, 4).unwrap()
}

#[test]
fn run_resumed_between_load_steps_is_bitwise_identical() {
    round_trip::check_resume(torn_bar, [1, 2]).unwrap();
}

#[test]
fn energy_balance_of_a_breaking_bar_closes() {
    let mut run = torn_bar();
    run.run_to_end().unwrap();
    let energies = run.snapshot().energies();
    assert!(run.system().operator().broken_bonds() > 0);
    let part = energies.balance() / energies.work;
    assert!(part.abs() < 1e-5, "{part}");
}
