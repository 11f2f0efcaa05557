//! Implicit schemes: starting from rest, and interrupts within a step.

use std::cell::Cell;
use std::sync::Arc;

use crate::common::{boxed, listed, material, points, system};
use pericles::boundary::{ALWAYS, Load, MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::VolumeCorrection;
use pericles::material::{BondStretch, Fracture, StressState};
use pericles::space::PointCloud;
use pericles::time::{
    AdaptiveRungeKutta, DiscreteGradient, Implicit, ImplicitRule, InnerSolver, Integrator, Newmark,
    NewmarkOptions, Relaxation, RelaxationOptions, State, VelocityVerlet, highest_frequency,
};
use pericles::{Archive, Checkpointed, Control, Interrupt, Outcome, Simulation, System};

const DX: f64 = 1e-3;
const YOUNG: f64 = 72e9;
const DENSITY: f64 = 2440.0;

/// A nonlinear plate of 20 × 10 cells.
fn plate(fracture: Fracture) -> (Arc<PointCloud>, System) {
    let cloud = boxed([0.0; 3], &[0.02, 0.01], DX, 1e-3);
    let glass = material(
        DENSITY,
        YOUNG,
        3.0 * DX,
        VolumeCorrection::Extended,
        fracture,
    );
    let force = listed::<BondStretch, 2>(&cloud, &glass, StressState::PlaneStress, None, &[]);
    let body = system(&cloud, force, DENSITY);
    (cloud, body)
}

/// Action on a plate initially at rest.
#[derive(Debug, Clone, Copy)]
pub enum Action {
    /// A traction that grows from zero.
    Ramp,
    /// A traction that starts after some steps.
    Late,
    /// A prescribed motion.
    Support,
}

pub fn loaded(action: Action) -> System {
    let (cloud, mut body) = plate(Fracture::Unbreakable);
    let right = points(&cloud, |x, _, _| x > 0.02 - 3.0 * DX);
    let pull =
        |function| Load::traction(&cloud, right.clone(), [1e6, 0.0, 0.0], 1e-5, function).unwrap();
    let ramp = TimeFunction::Ramp {
        start: 0.0,
        duration: 3e-6,
    };
    match action {
        Action::Ramp => body.add_load(pull(ramp)).unwrap(),
        Action::Late => body
            .add_load(Load {
                window: [0.55e-6, ALWAYS[1]],
                ..pull(TimeFunction::Constant)
            })
            .unwrap(),
        Action::Support => {
            let still = vec![0.0; 2 * cloud.len()];
            let motion = PrescribedMotion::new(
                "right".into(),
                right,
                MotionKind::Velocity,
                [Some(1.0), None, None],
                ramp,
                &still,
                cloud.len(),
            )
            .unwrap();
            body.add_motion(motion).unwrap();
        }
    }
    body
}

pub type MakeScheme = dyn Fn(&System) -> Box<dyn Integrator>;

pub fn rule(rule: ImplicitRule) -> Box<MakeScheme> {
    Box::new(move |system| Box::new(Implicit::new(rule, system).unwrap()))
}

pub fn discrete_gradient() -> Box<MakeScheme> {
    Box::new(|system| Box::new(DiscreteGradient::new(1e-10, system).unwrap()))
}

pub fn newmark(solver: InnerSolver) -> Box<MakeScheme> {
    Box::new(move |system| {
        let options = NewmarkOptions {
            solver,
            ..NewmarkOptions::default()
        };
        Box::new(Newmark::new(options, system).unwrap())
    })
}

pub fn from_rest(body: System, scheme: &MakeScheme, dt: f64, steps: u64) -> Simulation {
    let scheme = scheme(&body);
    let state = State::at_rest(body.dimension() * body.points());
    Simulation::new(body, scheme, state, dt, steps).unwrap()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let norm = |x: &mut dyn Iterator<Item = f64>| x.map(|x| x * x).sum::<f64>().sqrt();
    norm(&mut a.iter().zip(b).map(|(a, b)| a - b)) / norm(&mut b.iter().copied())
}

#[test]
fn implicit_schemes_start_from_rest_and_agree_with_the_explicit_scheme() {
    const END: f64 = 5e-6;
    for action in [Action::Ramp, Action::Late, Action::Support] {
        let mut exact = from_rest(
            loaded(action),
            &|_| Box::new(VelocityVerlet),
            END / 500.0,
            500,
        );
        exact.run(|_| Control::Continue).unwrap();
        let schemes = [
            rule(ImplicitRule::Midpoint),
            rule(ImplicitRule::Trapezoidal),
            newmark(InnerSolver::NewtonKrylov),
            discrete_gradient(),
        ];
        for scheme in schemes {
            let mut run = from_rest(loaded(action), &*scheme, END / 50.0, 50);
            let name = run.integrator().name();
            let ended = run.run(|_| Control::Continue);
            assert!(ended.is_ok(), "{name}, {action:?}: {}", ended.unwrap_err());
            let error = distance(&run.state().u, &exact.state().u);
            assert!(error < 0.02, "{name}, {action:?}: {error}");
            let energies = run.snapshot().energies();
            let balance = energies.balance() / energies.work;
            assert!(balance.abs() < 0.02, "{name}, {action:?}: {balance}");
        }
    }
}

#[test]
fn prestressed_body_at_rest_remains_at_rest() {
    for which in [ImplicitRule::Midpoint, ImplicitRule::Trapezoidal] {
        let cloud = boxed([0.0; 3], &[0.02], DX, 1e-6);
        let steel = material(
            DENSITY,
            YOUNG,
            3.0 * DX,
            VolumeCorrection::Extended,
            Fracture::Unbreakable,
        );
        let force = listed::<BondStretch, 1>(&cloud, &steel, StressState::Uniaxial, None, &[]);
        let mut body = system(&cloud, force, DENSITY);
        let mut state = State::at_rest(cloud.len());
        for i in 0..cloud.len() {
            state.u[i] = 1e-3 * cloud.point(i)[0];
        }
        let ends = points(&cloud, |x, _, _| !(3.0 * DX..=0.02 - 3.0 * DX).contains(&x));
        let hold = PrescribedMotion::new(
            "ends".into(),
            ends,
            MotionKind::Velocity,
            [Some(0.0), None, None],
            TimeFunction::Constant,
            &state.u,
            cloud.len(),
        )
        .unwrap();
        body.add_motion(hold).unwrap();
        let before = state.u.clone();
        let scheme = rule(which)(&body);
        // Fifty times the explicit limit, where rounding is amplified most.
        let dt = 50.0
            * highest_frequency(&body, &before)
                .unwrap()
                .stable_step(2.0, 1.0);
        let mut run = Simulation::new(body, scheme, state, dt, 5).unwrap();
        run.run(|_| Control::Continue).unwrap();
        assert!(distance(&run.state().u, &before) < 1e-12, "{which:?}");
    }
}

/// Everything that a run saves.
fn saved(run: &Simulation) -> Archive {
    let mut archive = Archive::default();
    run.save(&mut archive);
    archive
}

/// A plate in slow tension until it breaks.
pub fn torn() -> System {
    let (cloud, mut body) = plate(Fracture::CriticalStretch(1e-3));
    let still = vec![0.0; 2 * cloud.len()];
    for (name, from, to, far) in [("left", 0.0, 3.0 * DX, 0.0), ("right", 0.017, 0.02, 2e-5)] {
        let motion = PrescribedMotion::new(
            name.into(),
            points(&cloud, |x, _, _| (from..to).contains(&x)),
            MotionKind::Displacement,
            [Some(far), None, None],
            TimeFunction::Ramp {
                start: 0.0,
                duration: 1.0,
            },
            &still,
            cloud.len(),
        )
        .unwrap();
        body.add_motion(motion).unwrap();
    }
    body
}

/// Interrupts a run at some polls of its inner iterations, repeatedly. Each interrupted run must be as after the
/// last complete step, and the final state must equal the state of an uninterrupted run.
fn interrupted_is_undone(make: &dyn Fn() -> Simulation, every: u64) {
    let mut whole = make();
    whole.run(|_| Control::Continue).unwrap();
    let mut run = make();
    let name = run.integrator().name();
    let (polls, armed, stops) = (Cell::new(0), Cell::new(true), Cell::new(0));
    let mut last = saved(&run);
    loop {
        polls.set(0);
        let asked = || {
            polls.set(polls.get() + 1);
            armed.get() && polls.get() >= every
        };
        let interrupt = Interrupt::when(&asked);
        let mut after = Vec::new();
        let outcome = run
            .run_interruptible(interrupt, |run| {
                after.push(saved(run));
                armed.set(true);
                Control::Continue
            })
            .unwrap();
        last = after.pop().unwrap_or(last);
        if outcome == Outcome::Finished {
            break;
        }
        stops.set(stops.get() + 1);
        assert!(
            saved(&run) == last,
            "{name}: the interrupted step changed the run"
        );
        // One step without interrupts.
        armed.set(false);
    }
    assert!(stops.get() > 0, "{name} was never interrupted");
    assert!(
        saved(&run) == saved(&whole),
        "{name}: different final state"
    );
}

#[test]
fn interrupted_steps_are_undone() {
    let schemes: [(Box<MakeScheme>, u64); 6] = [
        (rule(ImplicitRule::Midpoint), 5),
        (rule(ImplicitRule::Trapezoidal), 7),
        (discrete_gradient(), 9),
        (newmark(InnerSolver::FixedPoint), 2),
        (newmark(InnerSolver::Anderson { depth: 3 }), 2),
        (newmark(InnerSolver::NewtonKrylov), 4),
    ];
    for (scheme, every) in &schemes {
        let make = || from_rest(loaded(Action::Ramp), &**scheme, 4e-8, 12);
        interrupted_is_undone(&make, *every);
    }
    let adaptive: Box<MakeScheme> =
        Box::new(|system| Box::new(AdaptiveRungeKutta::new(1e-6, system).unwrap()));
    interrupted_is_undone(&|| from_rest(loaded(Action::Ramp), &*adaptive, 1e-6, 4), 4);
}

#[test]
fn interrupted_load_steps_restore_broken_bonds() {
    let relaxation: Box<MakeScheme> =
        Box::new(|system| Box::new(Relaxation::new(RelaxationOptions::default(), system).unwrap()));
    let make = || from_rest(torn(), &*relaxation, 0.125, 8);
    let mut whole = make();
    whole.run(|_| Control::Continue).unwrap();
    let broken = whole.system().operator().broken_bonds();
    assert!(broken > 0);
    // In the last step, in which bonds break, well after its first equilibrium.
    interrupted_is_undone(&make, 1500);
    interrupted_is_undone(&make, 200);
}
