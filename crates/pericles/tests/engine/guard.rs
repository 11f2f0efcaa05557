//! The guard detects instabilities and their location, without false alarms.

use crate::common;
use pericles::boundary::{MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::VolumeCorrection;
use pericles::material::{BondStretch, Fracture, GreenBond, LinearBond, StressState};
use pericles::operator::{BondBody, VectorLaw};
use pericles::space::{Face, Region};
use pericles::time::{State, VelocityVerlet, highest_frequency};
use pericles::{Control, InstabilityCause, Simulation, SimulationError, System};

const SPACING: f64 = 0.05;

/// A free bar of unit length, density and modulus.
fn bar<L: VectorLaw>() -> System {
    let cloud = common::boxed([0.0; 3], &[1.0], SPACING, 1.0);
    let material = common::material(
        1.0,
        1.0,
        3.0 * SPACING,
        VolumeCorrection::Extended,
        Fracture::Unbreakable,
    );
    let force = common::listed::<L, 1>(&cloud, &material, StressState::Uniaxial, None, &[]);
    common::system(&cloud, force, 1.0)
}

/// Runs at a fraction of the stable step, with initial velocities by position.
fn run(
    system: System,
    part: f64,
    steps: u64,
    v: impl Fn(f64) -> f64,
) -> Result<(), SimulationError> {
    let mut start = State::at_rest(system.points());
    for (v_i, x) in start.v.iter_mut().zip(system.cloud().axis(0)) {
        *v_i = v(*x);
    }
    let dt = highest_frequency(&system, &start.u)
        .unwrap()
        .stable_step(2.0, part);
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), start, dt, steps).unwrap();
    run.run(|_| Control::Continue).map(|_| ())
}

/// The same bar on a stencil in single precision.
fn float_bar() -> System {
    let cloud = common::boxed([0.0; 3], &[1.0], SPACING, 1.0);
    let correction = VolumeCorrection::Extended;
    let material = common::material(1.0, 1.0, 3.0 * SPACING, correction, Fracture::Unbreakable);
    let constants = material.constants(&cloud, StressState::Uniaxial).unwrap();
    let body = BondBody::new(&cloud, &material, &constants);
    let force = body.grid::<LinearBond, 1>().unwrap().in_floats();
    common::system(&cloud, force, 1.0)
}

/// Returns cause, step and location of a run that must fail.
fn failure(outcome: Result<(), SimulationError>) -> (InstabilityCause, u64, f64) {
    match outcome {
        Err(SimulationError::Unstable {
            cause, step, place, ..
        }) => (cause, step, place[0]),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_nan_velocity_is_located() {
    let outcome = run(bar::<LinearBond>(), 0.9, 100, |x| {
        if (x - 0.525).abs() < 1e-9 {
            f64::NAN
        } else {
            0.0
        }
    });
    let (cause, step, _) = failure(outcome);
    assert_eq!((cause, step), (InstabilityCause::NotANumber, 20));
}

#[test]
fn a_step_above_the_limit_creates_energy() {
    let (cause, step, _) = failure(run(bar::<LinearBond>(), 1.05, 4000, |x| x.sin()));
    assert!(
        matches!(cause, InstabilityCause::Growth { ratio } if ratio > 2.0),
        "{cause}"
    );
    assert!(step < 400, "{step}");
}

/// A run slightly above the stability limit: the energy that the scheme conserves is constant, and at full steps
/// nearly all energy is elastic.
fn slightly_unstable() -> Simulation {
    let system = bar::<LinearBond>();
    let mut start = State::at_rest(system.points());
    for (k, v) in start.v.iter_mut().enumerate() {
        *v = 1e-3 * ((k * k) as f64).sin();
    }
    let frequency = highest_frequency(&system, &start.u).unwrap();
    let dt = 1.0001 * frequency.unstable_step(2.0);
    Simulation::new(system, Box::new(VelocityVerlet), start, dt, 4000).unwrap()
}

#[test]
fn growth_not_visible_in_the_conserved_energy_stops_below_ten_times_the_energy() {
    let mut simulation = slightly_unstable();
    let (cause, step, _) = failure(simulation.run(|_| Control::Continue).map(|_| ()));
    assert!(
        matches!(cause, InstabilityCause::Growth { ratio } if ratio > 1.7 && ratio <= 10.0),
        "{cause} at step {step}"
    );
    let energies = simulation.snapshot().energies();
    assert!(energies.kinetic + energies.elastic <= 10.0 * energies.initial);
    assert!(energies.balance().abs() < 1e-9 * energies.initial);
}

#[test]
fn a_run_with_allowed_instability_continues_and_reports_it() {
    let mut simulation = slightly_unstable().allowing_instability();
    simulation.run(|_| Control::Continue).unwrap();
    let energies = simulation.snapshot().energies();
    assert!(energies.kinetic + energies.elastic > 1e3 * energies.initial);
    let found = simulation.instability().unwrap().to_string();
    assert!(found.contains("times the supplied energy"), "{found}");
}

#[test]
fn round_off_energy_causes_no_false_alarm() {
    // A rigidly rotated plate, without stress and at rest.
    let cloud = common::boxed([0.0; 3], &[0.5, 0.3], SPACING, 1.0);
    let correction = VolumeCorrection::Extended;
    let material = common::material(1.0, 1.0, 3.0 * SPACING, correction, Fracture::Unbreakable);
    let state = StressState::PlaneStress;
    let force = common::listed::<BondStretch, 2>(&cloud, &material, state, None, &[]);
    let system = common::system(&cloud, force, 1.0);
    let mut start = State::at_rest(2 * cloud.len());
    let (sine, cosine) = 0.7_f64.sin_cos();
    for i in 0..cloud.len() {
        let [x, y, _] = cloud.point(i);
        start.u[i] = cosine * x - sine * y - x;
        start.u[cloud.len() + i] = sine * x + cosine * y - y;
    }
    let dt = highest_frequency(&system, &start.u)
        .unwrap()
        .stable_step(2.0, 0.95);
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), start, dt, 4000).unwrap();
    run.run(|_| Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    assert!(energies.kinetic < 1e-24, "{energies:?}");
}

#[test]
fn points_of_a_linear_bar_in_single_precision_may_pass_each_other() {
    let clash = |x: f64| if x < 0.5 { 2.0 } else { -2.0 };
    assert!(run(float_bar(), 0.02, 400, clash).is_ok());
}

#[test]
fn points_of_a_nonlinear_bar_that_pass_each_other_are_detected() {
    // Two halves collide faster than the wave speed; small steps, so that a check is due in time.
    let clash = |x: f64| if x < 0.5 { 2.0 } else { -2.0 };
    let (cause, _, place) = failure(run(bar::<BondStretch>(), 0.02, 400, clash));
    assert!(matches!(cause, InstabilityCause::Passed { .. }), "{cause}");
    assert!((place - 0.5).abs() < 2.0 * SPACING, "{place}");
    // A linear law does not depend on the order of points, and its waves pass through each other.
    assert!(run(bar::<LinearBond>(), 0.02, 400, clash).is_ok());
}

#[test]
fn body_that_stiffens_beyond_its_stable_step_is_reported() {
    // Bonds with the Green strain stiffen in tension: threefold at a stretch of one half.
    let mut system = bar::<GreenBond>();
    let cloud = system.cloud().clone();
    let end = |face, velocity| {
        let layer = Region::Layer {
            face: Face::named(face).unwrap(),
            depth: SPACING,
        };
        PrescribedMotion::new(
            face.into(),
            cloud.select(&layer),
            MotionKind::Velocity,
            [Some(velocity), None, None],
            TimeFunction::Constant,
            &vec![0.0; cloud.len()],
            cloud.len(),
        )
        .unwrap()
    };
    system.add_motion(end("-x", -0.05)).unwrap();
    system.add_motion(end("+x", 0.05)).unwrap();
    let even = |x: f64| 0.1 * (x - 0.5);
    let (cause, step, _) = failure(run(system, 0.95, 4000, even));
    match cause {
        InstabilityCause::Stiffened { dt, limit } => assert!(dt > limit, "{dt} {limit}"),
        other => panic!("{other} at step {step}"),
    }
}

#[test]
fn waves_that_propagate_away_from_a_point_cause_no_false_alarm() {
    assert!(run(bar::<BondStretch>(), 0.95, 2000, |x| 1e-3 * (9.0 * x).sin()).is_ok());
}
