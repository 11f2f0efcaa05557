//! Impact of free rigid bodies, and cracks that close.

use std::sync::Arc;

use pericles::Simulation;
use pericles::prelude::*;
use pericles::round_trip::check_resume;
use pericles::time::{Relaxation, RelaxationOptions, RungeKutta, Tableau};
use pericles_contact::{
    ContactBodies, ContactLaw, Impactor, ImpactorMotion, Inertia, PointContact, Pose, Shape,
};

use crate::setup::{ELASTIC, bars, steady};

/// A ball of radius 3 and mass 40 that falls on a free block of 8 × 8 × 5 cells. The expected values belong to a horizon
/// of 3 (1 + 1e-6) with the micromodulus of a horizon of 3: a second independent program gives all their digits so, and
/// ours for a horizon of exactly 3, which differ by up to 4e-6.
fn ball_on_block(steps: u64) -> Simulation {
    let grid = Grid {
        shape: Shape3::Box {
            origin: [-4.0, -4.0, -5.0],
            size: vec![8.0, 8.0, 5.0],
        },
        spacing: 1.0,
        section: 1.0,
        holes: Vec::new(),
    };
    let cloud = Arc::new(grid.points().unwrap());
    let horizon = 3.0 * (1.0 + 1e-6);
    let young = ElasticModulus::Young((horizon / 3.0f64).powi(4));
    let mut material = BondMaterial::new(young, 1.0, horizon);
    material.volume_correction = VolumeCorrection::Linear;
    let mut system = Body::new(cloud.clone(), material).build().unwrap();
    let n = cloud.len();
    let free = ImpactorMotion::Free {
        inertia: Inertia::Mass {
            mass: 40.0,
            inertia: None,
        },
        velocity: [0.0, 0.0, -0.08],
        spin: [0.0; 3],
    };
    let ball = Impactor::new(
        "ball",
        Shape::Ball { radius: 3.0 },
        Pose::at([0.3, -0.2, 3.02]),
        free,
        cloud,
        ELASTIC,
        ContactBodies::uniform(n, 1.0, 3.0, 1.0),
    );
    system.add_interaction(Box::new(ball.unwrap())).unwrap();
    let state = State::of(&system);
    Simulation::new(system, Box::new(VelocityVerlet), state, 0.6, steps).unwrap()
}

use pericles::space::Shape as Shape3;

fn impactor(run: &Simulation) -> &Impactor {
    let mut interactions = run.system().interactions();
    interactions.find_map(|one| one.downcast_ref()).unwrap()
}

#[test]
fn a_ball_on_a_block_repeats_an_independent_program() {
    let mut run = ball_on_block(40);
    let mut forces = Vec::new();
    run.run(|now| {
        if now.state().step.is_multiple_of(10) {
            forces.push(impactor(now).reading().force[2]);
        }
        Control::Continue
    })
    .unwrap();
    /// Half a unit of the last printed digit.
    const DIGITS: f64 = 1e-9;
    let expected = [0.3067709549, 0.4150922463, 0.1165318046];
    for (found, expected) in forces.iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < DIGITS, "{forces:?}");
    }
    let velocity = impactor(&run).reading().velocity;
    let expected = [-8.10069782e-4, 9.85012969e-4, 0.0506405014];
    for c in 0..3 {
        assert!(
            (velocity[c] / expected[c] - 1.0).abs() < DIGITS,
            "{velocity:?}"
        );
    }
    // Body and ball together.
    let points = run.system().momentum(&run.state().v);
    for c in 0..3 {
        let first = if c == 2 { -3.2 } else { 0.0 };
        let sum = points[c] + 40.0 * velocity[c];
        assert!((sum - first).abs() < 1e-13 * 3.2, "{c}: {sum}");
    }
    let energies = run.snapshot().energies();
    assert!(
        energies.balance().abs() < 5e-3 * energies.initial,
        "{energies:?}"
    );
    assert!(energies.bodies > 0.0 && energies.work == 0.0);
}

#[test]
fn a_run_resumes_in_the_middle_of_an_impact() {
    check_resume(|| ball_on_block(30), [7, 15]).unwrap();
}

#[test]
fn a_free_box_hit_off_its_centre_turns_and_conserves_both_momenta() {
    // A point flies against the end of a box.
    let cloud = Arc::new(PointCloud::new(3, vec![1.0, 0.3, -2.0], vec![1.0], 1.0).unwrap());
    let bonds = crate::bonded::Bonded::new(&cloud, |_, _| false);
    let density = pericles::PointScalar::Uniform(1.0);
    let mut system = System::new(cloud.clone(), Box::new(bonds), density).unwrap();
    let free = ImpactorMotion::Free {
        inertia: Inertia::Density(0.5),
        velocity: [0.0; 3],
        spin: [0.1, -0.2, 0.3],
    };
    let half = [1.5, 1.0, 0.5];
    let body = Impactor::new(
        "box",
        Shape::Box { half },
        Pose::at([0.0; 3]).turned(0, 0.2),
        free,
        cloud,
        ELASTIC,
        ContactBodies::uniform(1, 10.0, 3.0, 1.0),
    );
    system.add_interaction(Box::new(body.unwrap())).unwrap();
    let mut state = State::of(&system);
    state.v = vec![0.02, 0.0, 0.5];
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), state, 0.02, 300).unwrap();
    let moments = |run: &Simulation| {
        let (body, s) = (impactor(run), run.state());
        let (mass, reading) = (body.mass().unwrap().mass, body.reading());
        let y: [f64; 3] = std::array::from_fn(|c| run.system().cloud().point(0)[c] + s.u[c]);
        let v = &s.v;
        let own = [
            y[1] * v[2] - y[2] * v[1],
            y[2] * v[0] - y[0] * v[2],
            y[0] * v[1] - y[1] * v[0],
        ];
        let turning = body.angular_momentum();
        std::array::from_fn::<f64, 6, _>(|k| match k {
            0..3 => v[k] + mass * reading.velocity[k],
            _ => own[k - 3] + turning[k - 3],
        })
    };
    let first = moments(&run);
    run.run_to_end().unwrap();
    let last = moments(&run);
    assert!(run.state().v[2] < 0.4, "{:?}", run.state().v);
    for k in 0..6 {
        assert!(
            (last[k] - first[k]).abs() < 1e-13,
            "{k}: {first:?} {last:?}"
        );
    }
    let energies = run.snapshot().energies();
    assert!(
        energies.balance().abs() < 1e-3 * energies.initial,
        "{energies:?}"
    );
}

/// Reaction of a strip pressed by 1 %, whole or cut across.
fn pressed(cut: bool) -> f64 {
    let (long, wide) = (40usize, 8usize);
    let grid = Grid::plate([long as f64, wide as f64], 1.0, 1.0);
    let cloud = Arc::new(grid.points().unwrap());
    let n = cloud.len();
    let material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0);
    let mut body = Body::new(cloud.clone(), material).stress_state(StressState::PlaneStress);
    if cut {
        let x = 0.5 * long as f64;
        body = body.crack(Crack::Segment {
            from: [x, -1.0],
            to: [x, wide as f64 + 1.0],
        });
    }
    let mut system = body.build().unwrap();
    if cut {
        let bodies = ContactBodies::uniform(n, 1.0, 3.0, 1.0);
        let contact = PointContact::new(cloud.clone(), ELASTIC, bodies).unwrap();
        system.add_interaction(Box::new(contact)).unwrap();
    }
    let ends = |right: bool| -> PointSet {
        let x = cloud.axis(0);
        let chosen = |i: &u32| {
            let x = x[*i as usize];
            if right {
                x > long as f64 - 3.0
            } else {
                x < 3.0
            }
        };
        (0..n as u32).filter(chosen).collect()
    };
    let shift = -0.01 * long as f64;
    let one = TimeFunction::Constant;
    for (right, by) in [(false, 0.0), (true, shift)] {
        let motion =
            PrescribedMotion::displacement(ends(right), [Some(by), None, None], one.clone());
        system.add_motion(motion).unwrap();
    }
    // The lower corners of both halves at the cut: lattice faces that may slide take the position in which rows fit
    // between rows, with the planes closer by 0.14 spacings.
    let middle = 0.5 * long as f64;
    let corners = (0..n as u32).filter(|&i| {
        let [x, y, _] = cloud.point(i as usize);
        (x - middle).abs() < 1.0 && y < 1.0
    });
    let along = [None, Some(0.0), None];
    let motion = PrescribedMotion::displacement(corners.collect(), along, one);
    system.add_motion(motion).unwrap();
    let options = RelaxationOptions {
        tolerance: 1e-6,
        ..RelaxationOptions::default()
    };
    let scheme = Relaxation::new(options, &system).unwrap();
    let state = State::of(&system);
    let mut run = Simulation::new(system, Box::new(scheme), state, 1.0, 1).unwrap();
    run.run_to_end().unwrap();
    let reaction = run.snapshot().field(Field::Reaction).to_vec();
    ends(true).iter().map(|&i| reaction[i as usize]).sum()
}

#[test]
fn a_closed_crack_carries_pressure() {
    // 0.899 of the whole strip in an independent program.
    let ratio = pressed(true) / pressed(false);
    assert!((0.85..0.95).contains(&ratio), "{ratio}");
}

#[test]
fn runge_kutta_keeps_the_energy_of_elastic_contact() {
    let cells = 10;
    let body = bars(cells, &[cells, cells], 1e-6).touching(ELASTIC);
    let mut state = State::of(&body.system);
    state.v[..cells].fill(1e-3);
    let scheme = RungeKutta::new(&Tableau::rk4(), &body.system);
    let mut run = Simulation::new(body.system, Box::new(scheme), state, 0.01, 300).unwrap();
    run.run_to_end().unwrap();
    let energies = run.snapshot().energies();
    assert!(
        energies.balance().abs() < 1e-3 * energies.initial,
        "{energies:?}"
    );
    let (a, b) = run.state().v.split_at(cells);
    let difference = crate::setup::mean(b) - crate::setup::mean(a);
    assert!(difference > 0.9e-3, "{difference}");
}

#[test]
fn schemes_reject_what_they_cannot_integrate() {
    let damped = ContactLaw {
        damping: 0.3,
        ..ELASTIC
    };
    let rejected = |body: crate::setup::Bars, what: &str| {
        let scheme = RungeKutta::new(&Tableau::rk4(), &body.system);
        let found = pericles::check_compatibility(&body.system, &scheme, 10);
        let text = found.unwrap_err().to_string();
        assert!(text.contains(what), "{text}");
        let fine = pericles::check_compatibility(&body.system, &VelocityVerlet, 10);
        assert!(fine.is_ok());
    };
    rejected(bars(4, &[4, 4], 0.1).touching(damped), "damp");
    let free = ImpactorMotion::Free {
        inertia: Inertia::Mass {
            mass: 1.0,
            inertia: None,
        },
        velocity: [0.0; 3],
        spin: [0.0; 3],
    };
    let mut body = bars(4, &[4], 0.1);
    let ball = Impactor::new(
        "ball",
        Shape::Ball { radius: 1.0 },
        Pose::at([3.0, 0.0, 0.0]),
        free,
        body.cloud.clone(),
        ELASTIC,
        body.bodies.clone(),
    );
    body.system
        .add_interaction(Box::new(ball.unwrap()))
        .unwrap();
    rejected(body, "freely");
}

#[test]
fn invalid_bodies_and_laws_are_rejected() {
    let body = bars(4, &[4], 0.1);
    let law = |closing: f64| ContactLaw { closing, ..ELASTIC };
    let contact = PointContact::new(body.cloud.clone(), law(1.2), body.bodies.clone());
    assert!(contact.err().unwrap().to_string().contains("at most 1"));
    let make = |shape: Shape, x: f64, motion: ImpactorMotion| {
        let (cloud, bodies) = (body.cloud.clone(), body.bodies.clone());
        let made = Impactor::new(
            "tup",
            shape,
            Pose::at([x, 0.0, 0.0]),
            motion,
            cloud,
            ELASTIC,
            bodies,
        );
        made.err()
            .map(|error| error.to_string())
            .unwrap_or_default()
    };
    let at_rest = || steady([0.0; 3]);
    let ball = |radius: f64| Shape::Ball { radius };
    assert_eq!(make(ball(0.5), 1.7, at_rest()), "");
    assert!(make(ball(-0.5), 1.7, at_rest()).contains("the radius is"));
    assert!(make(ball(0.5), 0.9, at_rest()).contains("contains point"));
    assert!(make(ball(0.5), 1.7, steady([0.0, 1.0, 0.0])).contains("axis"));
    let free = |inertia: Inertia| ImpactorMotion::Free {
        inertia,
        velocity: [0.0; 3],
        spin: [0.0; 3],
    };
    let heavy = Inertia::Density(-1.0);
    assert!(make(ball(0.5), 1.7, free(heavy)).contains("mass"));
    assert!(make(Shape::HalfSpace, 1.7, free(Inertia::Density(1.0))).contains("mass"));
}
