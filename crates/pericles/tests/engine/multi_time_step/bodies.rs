//! Bodies of the multirate tests.

use std::f64::consts::PI;

use pericles::System;
use pericles::boundary::{Load, MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::{BondList, Crack, VolumeCorrection};
use pericles::material::{BondStretch, Fracture, LinearBond, StressState};
use pericles::operator::{BondForce, Breaking, DamageMeasure, VectorLaw};
use pericles::space::PointSet;
use pericles::time::{State, highest_frequency};

use crate::common::{boxed, listed, material, points, system};

/// A problem: system, initial state, fine points, end time.
pub type Problem = (System, State, PointSet, f64);

/// A linear plate in plane stress, pulled along x from rest, with a box of fine points.
pub fn plate() -> Problem {
    plate_with::<LinearBond>(1.0)
}

pub fn plate_with<L: VectorLaw>(load: f64) -> Problem {
    let spacing = 0.02;
    let cloud = boxed([0.0; 3], &[1.0, 0.5], spacing, spacing);
    let material = material(
        7850.0,
        200e9,
        3.015 * spacing,
        VolumeCorrection::None,
        Fracture::Unbreakable,
    );
    let stress = StressState::PlaneStress;
    let mut system = system(
        &cloud,
        listed::<L, 2>(&cloud, &material, stress, None, &[]),
        7850.0,
    );
    for (points, sign) in [
        (points(&cloud, |x, _, _| x < spacing), -1.0),
        (points(&cloud, |x, _, _| x > 1.0 - spacing), 1.0),
    ] {
        let density = [sign * load * 200e6 / spacing, 0.0, 0.0];
        system
            .add_load(Load::new(points, density, TimeFunction::Constant))
            .unwrap();
    }
    let fine = points(&cloud, |x, y, _| {
        (x - 0.5).abs() < 0.15 && (y - 0.25).abs() < 0.1
    });
    let state = State::at_rest(2 * cloud.len());
    (system, state, fine, 1.2e-4)
}

/// The nonlinear plate with twenty times the load, a moving pulse, and a ragged set of fine points.
pub fn nonlinear_plate() -> Problem {
    let (system, mut state, _, end) = plate_with::<BondStretch>(20.0);
    let cloud = system.cloud().clone();
    let n = cloud.len();
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        let bump = (-((x - 0.37).powi(2) + (y - 0.21).powi(2)) / 0.12f64.powi(2)).exp();
        state.u[i] = 2e-3 * bump;
        state.u[n + i] = -1e-3 * bump;
        state.v[n + i] = 5.0 * bump;
    }
    let fine = points(&cloud, |x, y, _| {
        let (dx, dy) = (x - 0.42, y - 0.23);
        let angle = dy.atan2(dx);
        dx.hypot(dy) < 0.13 + 0.04 * (5.0 * angle).sin() || x > 0.85
    });
    (system, state, fine, end)
}

/// A pre-cracked plate in tension. Its steps are binary fractions of a second, so that times add up without
/// rounding. The fine points are a strip around the crack.
pub fn cracking_plate() -> Problem {
    crack::<BondStretch>(40, 20.0, 0.006, 2f64.powi(-17))
}

/// A plate 0.05 m wide with a central crack; three rows at the top and bottom move apart with ± speed.
pub fn crack<L: VectorLaw>(cells: usize, speed: f64, critical_stretch: f64, end: f64) -> Problem {
    let spacing = 0.05 / cells as f64;
    let height = 0.05 + 6.0 * spacing;
    let cloud = boxed(
        [-0.025, -0.5 * height, 0.0],
        &[0.05, height],
        spacing,
        spacing,
    );
    let material = material(
        8000.0,
        192e9,
        3.015 * spacing,
        VolumeCorrection::None,
        Fracture::CriticalStretch(critical_stretch),
    );
    let stress = StressState::PlaneStress;
    let notch = Crack::Segment {
        from: [-0.005, 0.0],
        to: [0.005, 0.0],
    };
    let rows = [
        points(&cloud, |_, y, _| y < -0.025),
        points(&cloud, |_, y, _| y > 0.025),
    ];
    let operator = listed::<L, 2>(&cloud, &material, stress, Some(notch), &rows.concat());
    let mut system = system(&cloud, operator, 8000.0);
    let state = State::at_rest(2 * cloud.len());
    for (points, sign) in rows.into_iter().zip([-1.0, 1.0]) {
        let motion = PrescribedMotion::new(
            format!("{sign}"),
            points,
            MotionKind::Velocity,
            [None, Some(sign * speed), None],
            TimeFunction::Constant,
            &state.u,
            cloud.len(),
        )
        .unwrap();
        system.add_motion(motion).unwrap();
    }
    let fine = points(&cloud, |_, y, _| y.abs() < 0.005);
    (system, state, fine, end)
}

/// A plate of 15 × 6 points with fixed ends and fine points in the middle; points within `core` of the middle
/// are stiffer by the factor `stiffness`.
pub fn small_plate(stiffness: f64, core: f64) -> Problem {
    let spacing = 0.01;
    let cloud = boxed([0.0; 3], &[0.15, 0.06], spacing, 1.0);
    let horizon = 2.015 * spacing;
    let bonds = BondList::new(&cloud, horizon, VolumeCorrection::None).unwrap();
    let stiff: Vec<bool> = (0..cloud.len())
        .map(|i| (cloud.point(i)[0] - 0.075).abs() < core)
        .collect();
    let breaking = Breaking {
        critical_stretch: f64::INFINITY,
        no_fail: &[],
    };
    let micromodulus = 9.0 * 2e11 / (PI * horizon.powi(3));
    let factor = |i: usize| if stiff[i] { stiffness } else { 1.0 };
    let pair = |i: usize, j: usize, _: [f64; 3]| 0.5 * micromodulus * (factor(i) + factor(j));
    let operator = BondForce::<LinearBond, 2>::with_pair_stiffness(
        cloud.clone(),
        bonds,
        &pair,
        breaking,
        DamageMeasure::default(),
    )
    .unwrap();
    let mut system = system(&cloud, operator, 8000.0);
    let mut state = State::at_rest(2 * cloud.len());
    let held = PrescribedMotion::new(
        "clamp".into(),
        points(&cloud, |x, _, _| !(0.02..0.13).contains(&x)),
        MotionKind::Displacement,
        [Some(0.0), Some(0.0), None],
        TimeFunction::Constant,
        &state.u,
        cloud.len(),
    )
    .unwrap();
    system.add_motion(held).unwrap();
    for (k, v) in state.v.iter_mut().enumerate() {
        *v = ((k * k) as f64).sin();
    }
    let fine = points(&cloud, |x, _, _| (x - 0.075).abs() < 0.035);
    (system, state, fine, 1.0)
}

/// A free nonlinear plate of 800 points with a random initial state.
pub fn free_plate() -> Problem {
    let spacing = 0.01;
    let cloud = boxed([0.0; 3], &[0.4, 0.2], spacing, spacing);
    let material = material(
        7850.0,
        200e9,
        3.015 * spacing,
        VolumeCorrection::None,
        Fracture::Unbreakable,
    );
    let stress = StressState::PlaneStress;
    let system = system(
        &cloud,
        listed::<BondStretch, 2>(&cloud, &material, stress, None, &[]),
        7850.0,
    );
    let mut state = State::at_rest(2 * cloud.len());
    let n = cloud.len();
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        state.v[i] = 10.0 * (PI * x / 0.4).cos();
        state.v[n + i] = 10.0 * (PI * y / 0.2).cos() + 5.0;
    }
    let fine = points(&cloud, |x, y, _| {
        (x - 0.2).abs() < 0.1 && (y - 0.1).abs() < 0.04
    });
    (system, state, fine, 0.0)
}

/// A bar with a smooth pulse at one end, by a load or a prescribed motion.
pub fn pushed_bar(kind: Option<MotionKind>) -> Problem {
    let cloud = boxed([0.0; 3], &[0.5], 0.005, 1e-4);
    let material = material(
        7850.0,
        210e9,
        0.015,
        VolumeCorrection::None,
        Fracture::Unbreakable,
    );
    let stress = StressState::Uniaxial;
    let mut system = system(
        &cloud,
        listed::<BondStretch, 1>(&cloud, &material, stress, None, &[]),
        7850.0,
    );
    let state = State::at_rest(cloud.len());
    let function = TimeFunction::Pulse {
        start: -1e-6,
        duration: 8e-5,
    };
    let end = points(&cloud, |x, _, _| x < 0.015);
    match kind {
        None => system
            .add_load(Load::new(end, [1e10, 0.0, 0.0], function))
            .unwrap(),
        Some(kind) => {
            let amplitude = match kind {
                MotionKind::Displacement => 1e-3,
                MotionKind::Velocity => 30.0,
            };
            let motion = PrescribedMotion::new(
                "end".into(),
                end,
                kind,
                [Some(amplitude), None, None],
                function,
                &state.u,
                cloud.len(),
            )
            .unwrap();
            system.add_motion(motion).unwrap();
        }
    }
    let fine = points(&cloud, |x, _, _| x < 0.1);
    (system, state, fine, 6e-5)
}

/// The problem with the given number of steps of the given ω dt.
pub fn steps_of(problem: Problem, omega_dt: f64, steps: u64) -> Problem {
    let (system, state, fine, _) = problem;
    let omega = highest_frequency(&system, &state.u).unwrap().estimate;
    (system, state, fine, steps as f64 * omega_dt / omega)
}
