//! What the guard finds in runs that go wrong, with its place, and that it lets others go on.

mod common;

use pericles::boundary::{MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::VolumeCorrection;
use pericles::material::{BondStretch, Fracture, GreenBond, LinearBond, StressState};
use pericles::operator::FastLaw;
use pericles::space::{Face, Region};
use pericles::time::{State, VelocityVerlet, highest_frequency};
use pericles::{Cause, Control, Simulation, SimulationError, System};

const SPACING: f64 = 0.05;

/// A free bar of unit length, density and modulus.
fn bar<L: FastLaw>() -> System {
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

/// Runs at a part of the stable step, from velocities by place.
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
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), start, dt, steps);
    run.run(|_| Control::Continue).map(|_| ())
}

/// The cause, the step and the place of a run that must fail.
fn failure(outcome: Result<(), SimulationError>) -> (Cause, u64, f64) {
    match outcome {
        Err(SimulationError::Unstable {
            cause, step, place, ..
        }) => (cause, step, place[0]),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_velocity_that_is_no_number_is_found_where_it_is() {
    let outcome = run(bar::<LinearBond>(), 0.9, 100, |x| {
        if (x - 0.525).abs() < 1e-9 {
            f64::NAN
        } else {
            0.0
        }
    });
    let (cause, step, _) = failure(outcome);
    assert_eq!((cause, step), (Cause::NotANumber, 20));
}

#[test]
fn a_step_that_is_too_long_makes_energy() {
    let (cause, step, _) = failure(run(bar::<LinearBond>(), 1.05, 4000, |x| x.sin()));
    assert!(
        matches!(cause, Cause::Growth { ratio } if ratio > 2.0),
        "{cause}"
    );
    assert!(step < 400, "{step}");
}

#[test]
fn points_of_a_bar_that_pass_each_other_are_found() {
    // Two halves run into each other, faster than waves could tell; small steps, so that the guard looks in time.
    let clash = |x: f64| if x < 0.5 { 2.0 } else { -2.0 };
    let (cause, _, place) = failure(run(bar::<BondStretch>(), 0.02, 400, clash));
    assert!(matches!(cause, Cause::Passed { .. }), "{cause}");
    assert!((place - 0.5).abs() < 2.0 * SPACING, "{place}");
    // A linear law does not know where points are, and its waves pass through each other.
    assert!(run(bar::<LinearBond>(), 0.02, 400, clash).is_ok());
}

#[test]
fn a_body_that_becomes_stiffer_than_its_step_allows_is_told_so() {
    // Bonds with the strain of Green stiffen as they are pulled: threefold at a stretch of a half.
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
    };
    system.add_motion(end("-x", -0.05)).unwrap();
    system.add_motion(end("+x", 0.05)).unwrap();
    let even = |x: f64| 0.1 * (x - 0.5);
    let (cause, step, _) = failure(run(system, 0.95, 4000, even));
    match cause {
        Cause::Stiffened { dt, limit } => assert!(dt > limit, "{dt} {limit}"),
        other => panic!("{other} at step {step}"),
    }
}

#[test]
fn waves_that_leave_no_energy_behind_are_no_alarm() {
    assert!(run(bar::<BondStretch>(), 0.95, 2000, |x| 1e-3 * (9.0 * x).sin()).is_ok());
}
